"""The recipes of Chen et al. 2019."""

from __future__ import annotations

from ...foot.navigate.dedrift import LinearDedrift
from ...foot.pressure.insole import InsoleLoads
from ...foot.settings import InsoleSettings
from ...recipes import Recipe, usual_parts
from ...types.attrs import evolve
from .cop_cues import CopCues
from .fusion import DoubleFoot
from .known_velocity import KnownVelocity
from .soft_swing import SoftSwing

BOARD_SHARE = 0.44
"""Place of the circuit board between an insole's two areas, from the heel's end, as a share of its length.

The paper has 12.5 cm of 28.5 cm."""

KUPT = Recipe(
    "kupt",
    KnownVelocity(),
    SoftSwing(),
    CopCues(),
    InsoleLoads(InsoleSettings(heel_end=BOARD_SHARE, forefoot_start=BOARD_SHARE)),
    needs_pressure=True,
)
"""Velocity known from heel-strike to toe-off, without the fusion of both feet."""

KUPT_DFPC = evolve(KUPT, name="kupt-dfpc", parts=usual_parts(DoubleFoot()))
"""Chen et al. 2019: `KUPT`, with the strides of both feet calibrating each other."""

ZUPT = evolve(KUPT, name="zupt", corrector=LinearDedrift())
"""Chen et al.'s baseline: `KUPT` without rolling velocities, so the velocity is known only while the foot stands."""
