"""The recipes of Gong et al. 2023."""

from __future__ import annotations

from ...foot.navigate.error_state import ErrorStateFilter
from ...foot.settings import ErrorStateSettings
from ...foot.stance.cycle import Cycle
from ...recipes import Recipe, usual_parts
from ...types.attrs import evolve
from .compensation import TABLE_1
from .modes import Modes
from .settings import ModesSettings
from .touchdown import Height, NetAcceleration, PressureTouchdown

_OWN_HEIGHTS = ErrorStateFilter(ErrorStateSettings(level=False))
"""Corrector that leaves heights alone, because method I compares the heights of the feet."""

WALKING_MODES = Recipe(
    "walking-modes",
    Cycle(),
    _OWN_HEIGHTS,
    parts=usual_parts(Modes(PressureTouchdown(), ModesSettings(TABLE_1))),
    needs_pressure=True,
)
"""Method IV of Gong et al. 2023, and ours in two places: touchdowns by maximum pressure, compensated by walking mode.

The mode follows from how the feet turn (recognition.py), and the compensation is the wearer's own if there is one
(`solepath calibrate modes`). Without it, it is the paper's table 1, which holds for the paper's wearers."""

WALKING_MODES_PRINTED = evolve(
    WALKING_MODES.replace_part(
        Modes, Modes(PressureTouchdown(), ModesSettings(TABLE_1, as_printed=True)), "walking-modes-printed"
    ),
    every_stride=True,
)
"""Method IV as printed: the mode by the loaded regions of table 2, the compensation (8) by table 1, for any wearer."""

TOUCHDOWN_HEIGHT = Recipe("touchdown-height", Cycle(), _OWN_HEIGHTS, parts=usual_parts(Modes(Height())))
"""Gong et al. 2023, method I: the lower foot is the reference."""

TOUCHDOWN_ACCELERATION = Recipe(
    "touchdown-acceleration", Cycle(), _OWN_HEIGHTS, parts=usual_parts(Modes(NetAcceleration()))
)
"""Gong et al. 2023, method II: the foot with little net acceleration is the reference."""

TOUCHDOWN_PRESSURE = Recipe(
    "touchdown-pressure", Cycle(), _OWN_HEIGHTS, parts=usual_parts(Modes(PressureTouchdown())), needs_pressure=True
)
"""Gong et al. 2023, method III: touchdowns by maximum pressure."""
