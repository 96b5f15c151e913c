"""The recipes of Chen et al. 2019."""

from __future__ import annotations

from ...foot.cues.touch import Touch, TouchSettings
from ...foot.navigate.dedrift import LinearDedrift
from ...foot.settings import InsoleSettings
from ...recipes import Recipe, usual_parts
from ...types.attrs import evolve
from .cop_cues import CopCues
from .fusion import DoubleFoot
from .known_velocity import KnownVelocity, KnownVelocitySettings
from .soft_swing import SoftSwing
from .swing_drift import SwingDedrift

BOARD_SHARE = 0.44
"""Place of the circuit board between an insole's two areas, from the heel's end, as a share of its length.

The paper has 12.5 cm; 28.5 cm, the length of a 10.5 US shoe, is assumed."""

SOME_LOAD = 0.005
"""Load of an area of the insole that counts as "some forces" in `KUPT_DFPC_PRINTED`, as a share of the full load.

The paper has no number. With none at all, that is with any load above the noise (1), no swing is found: some of 96
cells exceed their noise at any time. From 0.002 to 0.02 emulated walks are the same within 0.03 m in 20 m."""

KUPT = Recipe(
    "kupt",
    KnownVelocity(),
    SoftSwing(),
    CopCues(),
    InsoleSettings(heel_end=BOARD_SHARE, forefoot_start=BOARD_SHARE),
    needs_pressure=True,
)
"""Velocity known from heel-strike to toe-off, without the fusion of both feet."""

KUPT_DFPC = evolve(KUPT, name="kupt-dfpc", parts=usual_parts(DoubleFoot()))
"""Chen et al. 2019 with our additions: `KUPT`, with the strides of both feet calibrating each other.

Ours are the soft evidence of `SoftSwing` and thresholds of the load as shares of what the foot bears."""

_AIR = TouchSettings(SOME_LOAD, SOME_LOAD)

KUPT_DFPC_PRINTED = evolve(
    KUPT_DFPC,
    name="kupt-dfpc-printed",
    detector=KnownVelocity(KnownVelocitySettings(area_on=SOME_LOAD, area_off=SOME_LOAD), touch=Touch(_AIR)),
    corrector=SwingDedrift(),
    cues=CopCues(_AIR),
    every_stride=True,
)
"""Chen et al. 2019 as printed: (1) to (13), with exact rolling velocities, linear drift and weights by error index."""

ZUPT = evolve(KUPT, name="zupt", corrector=LinearDedrift())
"""Chen et al.'s baseline: `KUPT` without rolling velocities, so the velocity is known only while the foot stands."""
