"""The recipes of Liu et al. 2015."""

from __future__ import annotations

from ...body.altitude import Altitude
from ...recipes import Recipe, usual_parts
from .activity.two_second_windows import TwoSecondWindows
from .critical_cues import CriticalCues
from .footsteps import Footsteps, FootstepsSettings
from .projection import PRINTED, Projection
from .snake import PrintedSnake, SnakeGame
from .static_zones import StaticZones, StaticZonesSettings

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
    StaticZones(StaticZonesSettings(has_loose_rule=False, knows_offset=False)),
    Projection(PRINTED),
    CriticalCues(),
    parts=usual_parts(Footsteps(FootstepsSettings(as_printed=True)), TwoSecondWindows()),
    place=PrintedSnake(),
)
"""The same with the equations and rules as they are printed.

These are: six samples at rest, (5) and (7) from liftoff to landing, the mean of both feet by the one-metre rule, the
tree and the hidden Markov model for activities, and candidates on the plan that a wall drops."""
