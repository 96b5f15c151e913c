"""Clinical outcomes of a session's events: walking bouts, mobility outcomes, walk tests, variability, references.

    from solepath.show.outcomes import mobility_outcomes, walking_bouts
    bouts = walking_bouts(events)
    outcomes = mobility_outcomes(bouts)

`events` is any list of events that holds GaitCycleMeasured and, for distances, StrideTaken. The rules and limits are
those of Mobilise-D, but the strides come from foot-worn sensors: these are not outcomes of the validated pipeline of a
sensor at the lower back. No session and no page imports this package."""

from __future__ import annotations

from .bouts import WalkingBout, walking_bouts
from .mobility import LIMITS, MobilityOutcomes, implausible, mobility_outcomes
from .references import Person, Reference, Sex, six_minute_reference, up_and_go_reference, walking_speed_reference
from .spread import IntervalEstimate, asymmetry, variability
from .walk_tests import SixMinuteWalk, TimedUpAndGo, six_minute_walk, timed_up_and_go

__all__ = [
    "LIMITS",
    "IntervalEstimate",
    "MobilityOutcomes",
    "Person",
    "Reference",
    "Sex",
    "SixMinuteWalk",
    "TimedUpAndGo",
    "WalkingBout",
    "asymmetry",
    "implausible",
    "mobility_outcomes",
    "six_minute_reference",
    "six_minute_walk",
    "timed_up_and_go",
    "up_and_go_reference",
    "variability",
    "walking_bouts",
    "walking_speed_reference",
]
