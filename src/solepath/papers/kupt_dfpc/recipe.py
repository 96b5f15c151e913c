"""The recipes of Chen et al. 2019."""

from __future__ import annotations

from ...foot.navigate.dedrift import LinearDedrift
from ...foot.pressure.insole import InsoleLoads
from ...foot.settings import InsoleSettings
from ...recipes import Recipe, usual
from ...types.attrs import evolve
from .cop_cues import CopCues
from .fusion import DoubleFoot
from .known_velocity import KnownVelocity
from .swing_dedrift import SwingDedrift

BOARD_SHARE = 0.44
"""Place of the circuit board that parts an insole into two areas, as a share of its length: 12.5 of 28.5 cm."""

KUPT = Recipe(
    "kupt",
    KnownVelocity(),
    SwingDedrift(),
    CopCues(),
    InsoleLoads(InsoleSettings(heel_end=BOARD_SHARE, forefoot_start=BOARD_SHARE)),
    needs_pressure=True,
)
"""Velocity known from heel-strike to toe-off, without the fusion of both feet."""

KUPT_DFPC = evolve(KUPT, name="kupt-dfpc", parts=usual(DoubleFoot()))
"""Chen et al. 2019: `KUPT`, with both feet calibrating each other's strides."""

ZUPT = evolve(KUPT, name="zupt", corrector=LinearDedrift())
"""Chen et al.'s baseline: stationary as in `KUPT`, but with a known velocity only while stationary."""
