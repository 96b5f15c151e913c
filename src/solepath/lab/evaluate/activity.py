"""Scores of activities: what the events told of labelled time, against the labels. Scorers are as datasets.py says.

A session has told its last word about a time when it is over; so what counts is what was not replaced.
"""

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
STAIRS = (Activity.STAIRS_UP, Activity.STAIRS_DOWN)
EVERY = 0.02
"""Spans are sampled so often, s."""


def compared(t: Sequence[float], true: Sequence[Activity | None], timeline: Timeline) -> ActivityScore:
    """Every labelled sample against what was told of its time; those without a label are left out."""
    labelled = [(at, activity) for at, activity in zip(t, true, strict=True) if activity is not None]
    return ActivityScore(Counter([(activity, timeline.at(at)) for at, activity in labelled]))


def rides(true: Sequence[Span], found: Sequence[LiftRidden]) -> ActivityScore:
    """Labelled rides against those told. A ride is found by one in its direction that it shares at least half of the
    shorter one's time with; each counts once. Those that find none were invented."""
    labelled = [(begin, end, LIFTS[activity]) for begin, end, activity in true if activity in LIFTS]
    left = list(found)
    n_found = 0
    for begin, end, up in labelled:
        for ride in left:
            shared = min(end, ride.t) - max(begin, ride.t_start)
            if ride.up is up and shared >= 0.5 * min(end - begin, ride.t - ride.t_start):
                left.remove(ride)
                n_found += 1
                break
    return ActivityScore(rides_true=len(labelled), rides_found=n_found, rides_invented=len(left))


def windows(true: Sequence[Span], timeline: Timeline, length: float = 2.0) -> ActivityScore:
    """The same of the windows of `length` s that lie within one activity, side by side from its beginning: what was
    told of a window's middle is its label. Liu et al. 2015 score windows of one activity (section V.C)."""
    middles = [
        (begin + (k + 0.5) * length, activity)
        for begin, end, activity in true
        for k in range(int((end - begin + 1e-9) // length))
    ]
    return compared([at for at, _ in middles], [activity for _, activity in middles], timeline)


def score_labelled(path: Path, meta: Meta, how: RunSettings) -> Scored:
    """The label that the experimenter pressed at each sample."""
    went = run(path, how, poses=False)
    t, true = labels(path)
    score = compared(t, true, went.said.timeline) + rides(spans(t, true), went.said.rides)
    number = fold_of(int(meta["subject"]))
    wearers = ", ".join(map(str, sorted(FOLDS[number])))
    return scored(path, went, activity=score, groups=("all", f"of wearers {wearers}"))


UP, LEVEL = Activity.STAIRS_UP, Activity.WALKING
CLIMBED: dict[str, tuple[Span, ...]] = {
    "stair_up": ((6.4, 12.7, UP), (15.2, 20.6, UP)),
    "spiralStairs": ((7.0, 36.6, UP), (38.0, 44.0, LEVEL)),
    "walk_4x10m_ic": ((4.6, 37.0, LEVEL),),
    "straightLine": ((8.5, 24.0, LEVEL),),
    "long_walk": ((12.5, 55.0, LEVEL),),
}
"""When the wearer was surely on stairs, and surely walking on the level. Nobody labelled these recordings: each is of
one kind by its description, and where it has stairs and level parts they were told apart by the strides: two steps of
stairs are 0.3 m high and 0.65 m long (one, on the spiral: 0.2 m and 0.3 m), level strides longer and without any rise.
Strides at the edges, of which one foot is on the level, are left out."""


def score_stairs(path: Path, meta: Meta, how: RunSettings) -> Scored:
    """How much of the time on stairs is called stairs, and how much of the time on the level."""
    went = run(path, how, poses=False)
    t: list[float] = []
    true: list[Activity | None] = []
    for begin, end, activity in CLIMBED[path.stem]:
        times = [begin + k * EVERY for k in range(int((end - begin) / EVERY))]
        t += times
        true += [activity] * len(times)
    score = compared(t, true, went.said.timeline)
    return scored(path, went, figures=stairs_figures(score))


def stairs_figures(score: ActivityScore) -> Figures:
    """Shares of labelled time: of stairs that were called stairs, in the right direction, and of level walking."""
    stairs = score.reported_for(Activity.STAIRS_UP)
    level = score.reported_for(Activity.WALKING)
    on, off = sum(stairs.values()), sum(level.values())
    return {
        "stairs_called": sum(stairs.get(told, 0) for told in STAIRS) / on if on else None,
        "stairs_direction": stairs.get(Activity.STAIRS_UP, 0) / on if on else None,
        "level_called": sum(level.get(told, 0) for told in STAIRS) / off if off else None,
    }
