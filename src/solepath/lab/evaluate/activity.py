"""Scores reported activities against labels. Scorers have the form that datasets.py describes.

A session may replace what it reported of a time until it ends. The last report of each time is scored."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from pathlib import Path

from ...events import LiftRidden
from ...show.timeline import Timeline
from ...types import Activity
from ..measures.confusion import ActivityScore
from ..measures.score import Figures, Scored
from ..train.hugadb import FOLDS, Span, fold_of, labels, spans
from .run import Meta, RunSettings, run, scored

LIFTS = {Activity.ELEVATOR_UP: True, Activity.ELEVATOR_DOWN: False}
"""True for the lift activity that goes up, False for the one that goes down."""
STAIRS = (Activity.STAIRS_UP, Activity.STAIRS_DOWN)
EVERY = 0.02
"""Interval at which spans are sampled, s."""


def score_samples(t: Sequence[float], true: Sequence[Activity | None], timeline: Timeline) -> ActivityScore:
    """Return the score of every labelled sample against the activity reported for its time.

    Samples without a label are left out."""
    labelled = [(at, activity) for at, activity in zip(t, true, strict=True) if activity is not None]
    return ActivityScore(Counter([(activity, timeline.at(at)) for at, activity in labelled]))


def score_rides(true: Sequence[Span], found: Sequence[LiftRidden]) -> ActivityScore:
    """Return the score of reported rides against labelled ones.

    A labelled ride is found by a reported one in the same direction that overlaps it by at least half of the shorter
    one's duration. Each counts once. Reported rides that find none are invented."""
    labelled = [(start, end, LIFTS[activity]) for start, end, activity in true if activity in LIFTS]
    left = list(found)
    n_found = 0
    for start, end, up in labelled:
        for ride in left:
            shared = min(end, ride.t) - max(start, ride.t_start)
            if ride.up is up and shared >= 0.5 * min(end - start, ride.t - ride.t_start):
                left.remove(ride)
                n_found += 1
                break
    return ActivityScore(rides_true=len(labelled), rides_found=n_found, rides_invented=len(left))


def score_windows(true: Sequence[Span], timeline: Timeline, length: float = 2.0) -> ActivityScore:
    """Return the score of windows of `length` s that lie within one activity, side by side from its start.

    The activity reported for the middle of a window counts. Liu et al. 2015 score windows of one activity (section
    V.C)."""
    middles = [
        (start + (k + 0.5) * length, activity)
        for start, end, activity in true
        for k in range(int((end - start + 1e-9) // length))
    ]
    return score_samples([at for at, _ in middles], [activity for _, activity in middles], timeline)


def score_labelled(path: Path, meta: Meta, settings: RunSettings) -> Scored:
    """Score against the label that the experimenter pressed at each sample."""
    result = run(path, settings, poses=False)
    t, true = labels(path)
    score = score_samples(t, true, result.gathering.timeline) + score_rides(spans(t, true), result.gathering.rides)
    number = fold_of(int(meta["subject"]))
    wearers = ", ".join(map(str, sorted(FOLDS[number])))
    return scored(path, result, activity=score, groups=("all", f"of wearers {wearers}"))


UP, LEVEL = Activity.STAIRS_UP, Activity.WALKING
CLIMBED: dict[str, tuple[Span, ...]] = {
    "stair_up": ((6.4, 12.7, UP), (15.2, 20.6, UP)),
    "spiralStairs": ((7.0, 36.6, UP), (38.0, 44.0, LEVEL)),
    "walk_4x10m_ic": ((4.6, 37.0, LEVEL),),
    "straightLine": ((8.5, 24.0, LEVEL),),
    "long_walk": ((12.5, 55.0, LEVEL),),
}
"""Spans, s, in which the wearer was certainly on stairs, and certainly walking on the level, by recording.

Nobody labelled these recordings. Each is of one kind by its description; where it has stairs and level parts, the
strides separate them. Two steps of stairs are 0.3 m high and 0.65 m long (one, on the spiral: 0.2 m and 0.3 m); level
strides are longer and do not rise. Strides at the edges, of which one foot is on the level, are left out."""


def score_stairs(path: Path, meta: Meta, settings: RunSettings) -> Scored:
    """Score the share of the time on stairs, and of the time on the level, for which stairs are reported."""
    result = run(path, settings, poses=False)
    t: list[float] = []
    true: list[Activity | None] = []
    for start, end, activity in CLIMBED[path.stem]:
        times = [start + k * EVERY for k in range(int((end - start) / EVERY))]
        t += times
        true += [activity] * len(times)
    score = score_samples(t, true, result.gathering.timeline)
    return scored(path, result, figures=stairs_figures(score))


def stairs_figures(score: ActivityScore) -> Figures:
    """Return shares of labelled time: stairs reported on stairs, with the right direction, and on the level."""
    stairs = score.reported_for(Activity.STAIRS_UP)
    level = score.reported_for(Activity.WALKING)
    on, off = sum(stairs.values()), sum(level.values())
    return {
        "stairs_called": sum(stairs.get(reported, 0) for reported in STAIRS) / on if on else None,
        "stairs_direction": stairs.get(Activity.STAIRS_UP, 0) / on if on else None,
        "level_called": sum(level.get(reported, 0) for reported in STAIRS) / off if off else None,
    }
