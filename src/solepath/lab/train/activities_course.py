"""Learns for `Activities` how activities follow each other: the chances of a change, and its time.

A change is seen in the half second whose window looks more like the new activity. The people who labelled it dated it
by other signs (the foot on the first tread, the doors of the lift), so the median of the difference is learnt."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise
from statistics import median

from attrs import frozen

from ...body.activity.chain import DEFAULT_CHANCES, Chances, Shifts
from ...body.activity.features import BLOCK
from ...body.activity.hypotheses import BlockEvidence, Hypotheses
from ...body.activity.motion import MotionModel
from ...body.activity.pressure_height import NO_EVIDENCE
from ...body.activity.ride import BlockForce
from ...body.activity.votes import motion_votes
from ...types import Activity, Foot
from .activities_net import CLASSES
from .hugadb import APART, Span

FootEvidence = tuple[list[float], BlockForce | None]
"""Features of a foot in a block, and the forces in which a lift can be detected."""

WORTH = 0.5
"""Weight of `DEFAULT_CHANCES` beside the observed chances, which must hold for other wearers too."""
NEAR = 4.0
"""Largest time between a detected change and a labelled one, s."""
FEWEST = 8
"""Smallest number of changes from which a time shift is learnt."""
FINEST = 0.05
"""Resolution of a time shift, s."""


@frozen(eq=False)
class LabelledCourse:
    """A recording in blocks from `t_start` s on, with each foot's evidence in each block, and the true activities."""

    t_start: float
    seen: Mapping[int, Mapping[Foot, FootEvidence]]
    done: tuple[Span, ...]
    by_hand: bool = True
    """True when people labelled the times, False for an emulator."""


def changes(done: Sequence[Span]) -> list[tuple[float, Activity, Activity]]:
    """Return (time, activity before, activity after) of each change."""
    return [(after[0], before[2], after[2]) for before, after in pairwise(done) if after[0] - before[1] < APART]


def chances(courses: Sequence[LabelledCourse]) -> Chances:
    """Return the chance of each change within a block."""
    counts = [[1e-6 * chance for chance in row] for row in DEFAULT_CHANCES]
    for course in courses:
        for t_start, end, activity in course.done:
            counts[CLASSES[activity]][CLASSES[activity]] += (end - t_start) / BLOCK
        for _, before, after in changes(course.done):
            counts[CLASSES[before]][CLASSES[after]] += 1.0
    return tuple(
        [
            tuple([round(WORTH * a + (1.0 - WORTH) * b / sum(row), 5) for a, b in zip(supposed, row, strict=True)])
            for supposed, row in zip(DEFAULT_CHANCES, counts, strict=True)
        ]
    )


def shifts(courses: Sequence[LabelledCourse], model: MotionModel) -> Shifts:
    """Return the time by which each change is labelled later than detected, s.

    It is the median for changes labelled by hand and that for emulated ones, or the mean of both medians where there
    are enough changes of either kind."""
    later: dict[tuple[Activity, Activity], dict[bool, list[float]]] = {}
    for course in courses:
        seen = changes(followed(course, model))
        for at, before, after in changes(course.done):
            offs = [at - t for t, a, b in seen if a is before and b is after and abs(at - t) < NEAR]
            if offs:
                kind = later.setdefault((before, after), {})
                kind.setdefault(course.by_hand, []).append(min(offs, key=abs))
    found = []
    for before in Activity:
        for after in Activity:
            enough = [median(offs) for offs in later.get((before, after), {}).values() if len(offs) >= FEWEST]
            if enough:
                found.append((before, after, round(FINEST * round(sum(enough) / len(enough) / FINEST), 2)))
    return tuple(found)


def followed(course: LabelledCourse, model: MotionModel) -> list[Span]:
    """Return the spans that the part reports for the recording."""
    courses = Hypotheses()
    starts: list[tuple[float, Activity]] = []
    last = max(course.seen, default=-1)
    for index in range(last + 1):
        feet = course.seen.get(index, {})
        evidence = [feet.get(foot) for foot in Foot]
        t = course.t_start + index * BLOCK
        courses.update(
            BlockEvidence(
                t=t,
                motions=motion_votes(model, [None if one is None else one[0] for one in evidence]),
                forces=tuple([None if one is None else one[1] for one in evidence]),
                climbs=NO_EVIDENCE,
                before=None,
                after=None,
            ),
            model.chain,
        )
        starts += [(segment.t, segment.activity) for segment, _, _ in courses.settle(t if index < last else 1e9)]
    ends = [*[t for t, _ in starts[1:]], course.t_start + (last + 1) * BLOCK]
    return [(t, end, activity) for (t, activity), end in zip(starts, ends, strict=True)]
