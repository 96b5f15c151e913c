"""The recipe of Liu et al. 2015."""

from __future__ import annotations

from ...recipes import Recipe, usual_parts
from .activity.two_second_windows import TwoSecondWindows
from .critical_cues import CriticalCues
from .footsteps import Footsteps
from .projection import Projection
from .snake import SnakeGame
from .static_zones import StaticZones

FOOTSTEP_TRACKER = Recipe(
    "footstep-tracker",
    StaticZones(),
    Projection(),
    CriticalCues(),
    parts=usual_parts(Footsteps(), TwoSecondWindows()),
    place=SnakeGame(),
)
"""Liu et al. 2015: strides between static zones, projected onto the ground; turns; activities; a floor-plan game."""
