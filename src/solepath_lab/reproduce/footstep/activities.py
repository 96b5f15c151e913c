"""Activities of two-second windows (fig. 13 a), and the direction on stairs by air pressure or by the slope of strides.

The direction is one for each whole stretch that the printed tree and hidden Markov model take for stairs, whichever of
the two they report in it. It is that of the height by air pressure, fitted over the stretch, or that of the sum of the
strides' rises. So these rows show what either evidence decides alone; our activities use both."""

from __future__ import annotations

import numpy as np

from solepath.body.altitude import height_of
from solepath.events import ActivityChanged, Event
from solepath.papers.footstep_tracker.recipe import FOOTSTEP_TRACKER, FOOTSTEP_TRACKER_PRINTED
from solepath.recording.decoded import decode_recording
from solepath.types import Activity, Packet, Site
from solepath.walk.timeline import Timeline

from ...evaluate.activity import score_windows
from ...measures.confusion import ActivityScore
from ...train.emulated import draw_route
from ..tables import Values, WalkResults
from ..walks import final_strides, run_session
from .wearers import WearerJob, without_barometer

CLASSES = (
    Activity.STANDING, Activity.WALKING, Activity.STAIRS_UP, Activity.STAIRS_DOWN, Activity.ELEVATOR_UP,
    Activity.ELEVATOR_DOWN,
)  # fmt: skip
"""Activities of fig. 13 (a)."""
STAIRS = (Activity.STAIRS_UP, Activity.STAIRS_DOWN)
VARIANTS = ("ours", "no barometer", "printed", "printed + air pressure", "printed + slope")
"""Ours with and without air pressure, the printed ones, and these with another direction on stairs."""


def score_activities(job: WearerJob) -> WalkResults:
    """Return the rows of one wearer on a route with stairs, elevators and corridors; STANDARD has all variants.

    They are the shares of the windows that are right, %, of all and of those of an activity."""
    route, wearer = draw_route(job.seed)
    walk = job.walk(route, wearer=wearer)
    true, until = walk.truth.activities, walk.truth.duration
    ours = run_session(FOOTSTEP_TRACKER, walk.packets)
    timelines = {"ours": _timeline(ours)}
    if job.is_standard:
        printed = _timeline(run_session(FOOTSTEP_TRACKER_PRINTED, walk.packets))
        stretches = stair_stretches(printed, until)
        heights = _heights(walk.packets)
        rises = [(one.t_end, one.height_change) for one in final_strides(ours)]
        timelines |= {
            "no barometer": _timeline(run_session(FOOTSTEP_TRACKER, without_barometer(walk.packets))),
            "printed": printed,
            "printed + air pressure": _redirected(
                printed, until, [(s, e, fitted_climb(heights, s, e)) for s, e in stretches]
            ),
            "printed + slope": _redirected(
                printed, until, [(s, e, sum([rise for t, rise in rises if s <= t <= e])) for s, e in stretches]
            ),
        }
    values = Values()
    for variant, timeline in timelines.items():
        score, title = score_windows(true, timeline), variant_title(variant)
        values[f"activities{title} %"] = (100.0 * (score.accuracy or 0.0),)
        values |= {f"{activity.value}{title} %": class_share(score, activity) for activity in CLASSES}
    return WalkResults(values)


def variant_title(variant: str) -> str:
    """Return how a variant is named within a row."""
    return "" if variant == "ours" else f", {variant}"


def class_share(score: ActivityScore, activity: Activity) -> tuple[float, ...]:
    """Return the share of windows of an activity that are right, %; nothing for a walk without the activity."""
    reported = score.reported_for(activity)
    return (100.0 * reported[activity] / reported.total(),) if reported else ()


def _timeline(events: list[Event]) -> Timeline:
    timeline = Timeline()
    for event in events:
        if isinstance(event, ActivityChanged):
            timeline.add(event)
    return timeline


def stair_stretches(timeline: Timeline, until: float) -> list[tuple[float, float]]:
    """Return the start and end, s, of each stretch of stairs in either direction without another activity in it."""
    stretches: list[tuple[float, float]] = []
    for start, end, activity in timeline.spans(until):
        if activity in STAIRS:
            joins = bool(stretches) and stretches[-1][1] == start
            stretches[-1:] = [(stretches[-1][0], end)] if joins else [*stretches[-1:], (start, end)]
    return stretches


def _heights(packets: tuple[Packet, ...]) -> dict[Site, list[tuple[float, float]]]:
    """Return the times, s, and heights by air pressure, m, of each barometer."""
    heights: dict[Site, list[tuple[float, float]]] = {}
    for sample in decode_recording(packets).samples:
        height = None if sample.air_pressure is None else height_of(sample.air_pressure)
        if height is not None:
            heights.setdefault(sample.site, []).append((sample.t, height))
    return heights


def fitted_climb(heights: dict[Site, list[tuple[float, float]]], start: float, end: float) -> float:
    """Return the slope of a line through the heights from `start` to `end`, s, m/s; 0 with too few of them.

    Each barometer has an offset of its own, so its mean is subtracted."""
    times, values = [], []
    for of in heights.values():
        inside = [(t, height) for t, height in of if start <= t <= end]
        if inside:
            middle, mean = np.mean(inside, axis=0)
            times += [t - middle for t, _ in inside]
            values += [height - mean for _, height in inside]
    spread = float(np.dot(times, times))
    return float(np.dot(times, values)) / spread if spread > 0.0 else 0.0


def _redirected(timeline: Timeline, until: float, climbs: list[tuple[float, float, float]]) -> Timeline:
    """Return the timeline with one direction in each stretch (start, end, climb); a climb of 0 changes nothing."""
    changed = Timeline()
    for start, end, activity in timeline.spans(until):
        climb = next((climb for s, e, climb in climbs if s <= start and end <= e), 0.0)
        if activity in STAIRS and climb != 0.0:
            activity = Activity.STAIRS_UP if climb > 0.0 else Activity.STAIRS_DOWN
        changed.add(ActivityChanged(t=start, known_at=start, activity=activity, probability=None))
    return changed
