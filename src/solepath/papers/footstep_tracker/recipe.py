"""The recipes of Liu et al. 2015."""

from __future__ import annotations

from ...body.height.altitude import Altitude
from ...recipes import Recipe, usual_parts
from .activity.two_second_windows import TwoSecondWindows
from .critical_cues import CriticalCues
from .footsteps import Footsteps
from .projection import Projection, ProjectionSettings
from .snake import SnakeGame
from .static_zones import StaticZones

FOOTSTEP_TRACKER = Recipe(
    "footstep-tracker",
    StaticZones(),
    Projection(),
    CriticalCues(),
    parts=usual_parts(Footsteps(), altitude=Altitude()),
    place=SnakeGame(),
)
"""Liu et al. 2015: strides between static zones, projected onto the ground; turns; a floor-plan game.

Beyond the paper, strides have a rise, and the activities are those of `recipes.DEFAULT`. The wearer's height is that of
elevators and air pressure; stairs count in it only where there is a barometer."""

FOOTSTEP_TRACKER_PRINTED = Recipe(
    "footstep-tracker-printed",
    StaticZones(),
    Projection(ProjectionSettings(as_printed=True)),
    CriticalCues(),
    parts=usual_parts(Footsteps(), TwoSecondWindows()),
    place=SnakeGame(),
)
"""The same with the equations as they are printed, and the activities of the paper's tree and hidden Markov model."""
