"""Activities of two-second windows (fig. 13 a): ours with and without air pressure, and the printed tree and model."""

from __future__ import annotations

from solepath.events import ActivityChanged
from solepath.papers.footstep_tracker.recipe import FOOTSTEP_TRACKER, FOOTSTEP_TRACKER_PRINTED
from solepath.types import Activity
from solepath.walk.timeline import Timeline

from ...evaluate.activity import score_windows
from ...train.emulated import draw_route
from ..tables import Values, WalkResults
from ..walks import run_session
from .wearers import WearerJob, without_barometer

CLASSES = (
    Activity.STANDING, Activity.WALKING, Activity.STAIRS_UP, Activity.STAIRS_DOWN, Activity.ELEVATOR_UP,
    Activity.ELEVATOR_DOWN,
)  # fmt: skip
"""Activities of fig. 13 (a)."""
VARIANTS = ("ours", "no barometer", "printed")
"""Ours with and without air pressure, and the printed ones."""


def score_activities(job: WearerJob) -> WalkResults:
    """Return the rows of one wearer on a route with stairs, elevators and corridors; STANDARD has all variants.

    They are the shares of the windows that are right, %, of all and of those of an activity in this walk."""
    route, wearer = draw_route(job.seed)
    walk = job.walk(route, wearer=wearer)
    runs = {
        "ours": (FOOTSTEP_TRACKER, walk.packets),
        "no barometer": (FOOTSTEP_TRACKER, without_barometer(walk.packets)),
        "printed": (FOOTSTEP_TRACKER_PRINTED, walk.packets),
    }
    values = Values()
    for variant in VARIANTS if job.is_standard else VARIANTS[:1]:
        timeline = Timeline()
        for event in run_session(*runs[variant]):
            if isinstance(event, ActivityChanged):
                timeline.add(event)
        score = score_windows(walk.truth.activities, timeline)
        values[row_of_variant("activities", variant)] = (100.0 * (score.accuracy or 0.0),)
        for activity in CLASSES:
            reported = score.reported_for(activity)
            right = (100.0 * reported[activity] / reported.total(),) if reported else ()
            values[row_of_variant(activity.value, variant)] = right
    return WalkResults(values)


def row_of_variant(name: str, variant: str) -> str:
    """Return the name of a row of activities."""
    return f"{name} %" if variant == "ours" else f"{name}, {variant} %"
