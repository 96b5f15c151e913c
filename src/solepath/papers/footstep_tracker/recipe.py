"""The recipes of Liu et al. 2015."""

from __future__ import annotations

from ...body.altitude import Altitude
from ...body.fuse.both_feet import BothFeet
from ...recipes import Recipe, usual_parts
from .activity.two_second_windows import TwoSecondWindows
from .critical_cues import CriticalCues
from .footsteps import Footsteps
from .projection import PRINTED, Projection
from .snake import PrintedSnake
from .static_zones import PRINTED_ZONES, StaticZones

FOOTSTEP_TRACKER = Recipe(
    "footstep-tracker", StaticZones(), Projection(), CriticalCues(), parts=usual_parts(BothFeet(), altitude=Altitude())
)
"""Liu et al. 2015: strides between static zones, projected onto the ground; turns; places on a floor plan.

Beyond the paper, strides are closed at rest and have a rise. What both feet, activities and floor plans are made of is
the same as in `recipes.DEFAULT`. The wearer's height is that of elevators and air pressure; stairs count in it only
where there is a barometer."""

FOOTSTEP_TRACKER_PRINTED = Recipe(
    "footstep-tracker-printed",
    StaticZones(PRINTED_ZONES),
    Projection(PRINTED),
    CriticalCues(),
    parts=usual_parts(Footsteps(), TwoSecondWindows()),
    place=PrintedSnake(),
    every_stride=True,
)
"""The same with the equations and rules as they are printed.

These are: six samples at rest, (5) and (7) from liftoff to landing, the mean of both feet by the one-metre rule, the
tree and the hidden Markov model for activities, and candidates on the plan that a wall drops."""
