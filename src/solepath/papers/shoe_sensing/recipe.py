"""The recipes of Li et al. 2016."""

from __future__ import annotations

from ...body.activity.activities import Activities
from ...recipes import Recipe, usual_parts
from ...types.attrs import evolve
from .additions import ShoeSensing
from .printed import GatedTilt
from .short_time_energy import ShortTimeEnergy, printed_energy
from .walking_state import AnglePerMetre

SHOE_SENSING = Recipe("shoe-sensing", ShortTimeEnergy(), ShoeSensing(), parts=usual_parts())
"""Li et al. 2016: short-time energy, tilt feedback in stance, height errors of level strides removed.

Beyond the paper: uncertain stances and a tilt correction for joggers, motion that the detector sees late, level strides
by height and pitch, and the activities of `recipes.DEFAULT`."""

SHOE_SENSING_PRINTED = evolve(
    SHOE_SENSING.replace_part(Activities, AnglePerMetre(), "shoe-sensing-printed"),
    detector=printed_energy(),
    corrector=GatedTilt(),
    every_stride=True,
)
"""Li et al. 2016 as printed: energy alone, the first attitude from four seconds of samples, no addition of ours.

Walking states are level, up and down, by the angle per metre of each stride."""
