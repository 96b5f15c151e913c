"""The recipes of Gong et al. 2023."""

from __future__ import annotations

from ...foot.navigate.error_state import ErrorStateFilter
from ...foot.settings import ErrorStateSettings
from ...foot.stance.cycle import Cycle
from ...recipes import Recipe, usual
from .compensation import TABLE_1
from .modes import Modes
from .settings import ModesSettings
from .touchdown import Height, NetAcceleration, PressureTouchdown

_OWN_HEIGHTS = ErrorStateFilter(ErrorStateSettings(level=False))
"""Method I goes by the height of the feet, so nothing is done about it."""

WALKING_MODES = Recipe(
    "walking-modes", Cycle(), _OWN_HEIGHTS, parts=usual(Modes(settings=ModesSettings(TABLE_1))), needs_pressure=True
)
"""Gong et al. 2023, method IV: touchdowns by maximum pressure, compensated by walking mode. It ships the paper's table
1, which holds for the paper's wearers: on emulated ones it does worse than what their own marked walks teach
(`solepath calibrate modes`)."""

TOUCHDOWN_HEIGHT = Recipe("touchdown-height", Cycle(), _OWN_HEIGHTS, parts=usual(Modes(Height())))
"""Their method I: the lower foot carries."""

TOUCHDOWN_ACCELERATION = Recipe("touchdown-acceleration", Cycle(), _OWN_HEIGHTS, parts=usual(Modes(NetAcceleration())))
"""Their method II: the foot with little net acceleration carries."""

TOUCHDOWN_PRESSURE = Recipe(
    "touchdown-pressure", Cycle(), _OWN_HEIGHTS, parts=usual(Modes(PressureTouchdown())), needs_pressure=True
)
"""Their method III: touchdowns by maximum pressure."""
