"""Scores reported activities against labels. Scorers have the form that datasets.py describes.

A session may revise the activity of a moment until the session ends. The last report for each moment is scored."""

from __future__ import annotations

from bisect import bisect_right
from collections import Counter, deque
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path

from solepath.events import ActivityChanged, LiftRidden
from solepath.types import Activity
from solepath.walk.timeline import Timeline

from ..descriptions import KNOWN
from ..measures.confusion import DELAYS, ActivityScore
from ..measures.score import Figures, Scored
from ..train.hugadb import FOLDS, Span, fold_of, known_spans, labels, spans
from .run import Meta, RunSettings, run

ELEVATOR_IS_UP = {Activity.ELEVATOR_UP: True, Activity.ELEVATOR_DOWN: False}
"""True for the elevator ride up, False for the ride down."""
STAIRS = (Activity.STAIRS_UP, Activity.STAIRS_DOWN)
LABEL_EDGE = 1.0
"""Time from a change of the label within which hand-set labels may be wrong, s."""
SAMPLING_INTERVAL = 0.02
"""Time between the samples of a span whose activity is scored, s."""


def score_samples(t: Sequence[float], true: Sequence[Activity | None], timeline: Timeline) -> ActivityScore:
    """Return the score of the activities `true` at `t` s against the activities that were reported for these times.

    Samples without a label are left out."""
    labelled = [(time, activity) for time, activity in zip(t, true, strict=True) if activity is not None]
    return ActivityScore(Counter([(activity, timeline.at(time)) for time, activity in labelled]))


def score_inside(t: Sequence[float], true: Sequence[Activity | None], timeline: Timeline) -> ActivityScore:
    """Return the score of the samples that are more than `LABEL_EDGE` from any change of the label."""
    changes = [(a + b) / 2.0 for (a, was), (b, becomes) in pairwise(zip(t, true, strict=True)) if was is not becomes]
    checks = Counter[tuple[str, bool]]()
    for time, activity in zip(t, true, strict=True):
        k = bisect_right(changes, time)
        if activity is not None and all(abs(time - one) > LABEL_EDGE for one in changes[max(0, k - 1) : k + 1]):
            checks["right_inside", timeline.at(time) is activity] += 1
    return ActivityScore(checks=checks)


def score_delays(
    t: Sequence[float], true: Sequence[Activity | None], reports: Sequence[ActivityChanged]
) -> ActivityScore:
    """Return the scores of what was reported for each moment up to some seconds later (`DELAYS`)."""
    checks = Counter[tuple[str, bool]]()
    for check, delay in DELAYS.items():
        timeline, pending = Timeline(), deque(reports)
        for time, activity in zip(t, true, strict=True):
            while pending and pending[0].known_at <= time + delay:
                timeline.add(pending.popleft())
            if activity is not None:
                checks[check, timeline.at(time) is activity] += 1
    return ActivityScore(checks=checks)


def score_rides(true: Sequence[Span], rides: Sequence[LiftRidden]) -> ActivityScore:
    """Return the score of reported elevator rides against the labelled ones.

    A labelled ride counts as found when a reported ride in the same direction overlaps it by at least half of the
    duration of the shorter of the two. Each ride counts once. Reported rides without a labelled one are invented."""
    labelled = [(start, end, ELEVATOR_IS_UP[activity]) for start, end, activity in true if activity in ELEVATOR_IS_UP]
    unmatched = list(rides)
    n_found = 0
    for start, end, up in labelled:
        for ride in unmatched:
            overlap = min(end, ride.t) - max(start, ride.t_start)
            if ride.up is up and overlap >= 0.5 * min(end - start, ride.t - ride.t_start):
                unmatched.remove(ride)
                n_found += 1
                break
    return ActivityScore(rides_true=len(labelled), rides_found=n_found, rides_invented=len(unmatched))


def score_windows(true: Sequence[Span], timeline: Timeline, length: float = 2.0) -> ActivityScore:
    """Return the score of windows of `length` s. They lie side by side from the start of each labelled activity.

    A window is scored by the activity that is reported for its middle. Liu et al. 2015 also score only windows with a
    single activity (section V.C)."""
    middles = [
        (start + (k + 0.5) * length, activity)
        for start, end, activity in true
        for k in range(int((end - start + 1e-9) // length))
    ]
    return score_samples([time for time, _ in middles], [activity for _, activity in middles], timeline)


def score_labelled(path: Path, meta: Meta, settings: RunSettings, corrected: bool = False) -> Scored:
    """Score a recording of hugadb, whose activities the experimenter labelled by pressing keys.

    With `corrected`, labels that contradict the signal are corrected."""
    result = run(path, settings, poses=False)
    t, true = labels(path, corrected)
    score = score_samples(t, true, result.walk.timeline) + score_rides(spans(t, true), list(result.walk.rides))
    score += score_inside(t, true, result.walk.timeline)
    score += score_delays(t, true, result.walk.activities)
    wearers = ", ".join(map(str, sorted(FOLDS[fold_of(int(meta["subject"]))])))
    return Scored(path.stem, activity=score, groups=("all", f"of wearers {wearers}"))


STAIR_SPANS = known_spans(KNOWN["stairs"])
"""Spans in which the wearer was certainly on stairs or certainly walking on the level, by recording."""


def score_stairs(path: Path, meta: Meta, settings: RunSettings) -> Scored:
    """Score the shares of the time on stairs and of the time on the level for which stairs are reported."""
    result = run(path, settings, poses=False)
    t: list[float] = []
    true: list[Activity | None] = []
    for start, end, activity in STAIR_SPANS[path.stem]:
        times = [start + k * SAMPLING_INTERVAL for k in range(int((end - start) / SAMPLING_INTERVAL))]
        t += times
        true += [activity] * len(times)
    score = score_samples(t, true, result.walk.timeline)
    return Scored(path.stem, figures=stairs_figures(score))


def stairs_figures(score: ActivityScore) -> Figures:
    """Return the shares of stairs time reported as stairs and as stairs up, and of level time reported as stairs."""
    stairs, level = score.reported_for(Activity.STAIRS_UP), score.reported_for(Activity.WALKING)
    return {
        "stairs_called": sum([stairs[one] for one in STAIRS]) / stairs.total() if stairs else None,
        "stairs_direction": stairs[Activity.STAIRS_UP] / stairs.total() if stairs else None,
        "level_called": sum([level[one] for one in STAIRS]) / level.total() if level else None,
    }
