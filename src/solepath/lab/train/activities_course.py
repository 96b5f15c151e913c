"""What `Activities` learns of how activities follow each other: the chances of a change, and when it is dated.

A change is seen in the half second whose window looks more like the new activity. The people who labelled it dated it
by other signs (the foot on the first tread, the doors of the lift), so the median of the difference is learnt.
"""

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

Said = tuple[list[float], BlockForce | None]
"""Features of a foot in a block, and what a lift would be felt in."""

WORTH = 0.5
"""`DEFAULT_CHANCES` counts so much beside what was seen: chances must hold of others than these wearers too."""
NEAR = 4.0
"""A change that was seen further, s, from one that was labelled is another."""
FEWEST = 8
"""Of fewer changes nothing is learnt."""
FINEST = 0.05
"""s."""


@frozen(eq=False)
class LabelledCourse:
    """A recording in blocks from `begin` s on, what each foot said of each, and what was done."""

    begin: float
    seen: Mapping[int, Mapping[Foot, Said]]
    done: tuple[Span, ...]
    by_hand: bool = True
    """People dated it, and not an emulator."""


def changes(done: Sequence[Span]) -> list[tuple[float, Activity, Activity]]:
    """When, from what, to what."""
    return [(after[0], before[2], after[2]) for before, after in pairwise(done) if after[0] - before[1] < APART]


def chances(courses: Sequence[LabelledCourse]) -> Chances:
    """Of each change within a block."""
    counts = [[1e-6 * chance for chance in row] for row in DEFAULT_CHANCES]
    for course in courses:
        for begin, end, activity in course.done:
            counts[CLASSES[activity]][CLASSES[activity]] += (end - begin) / BLOCK
        for _, before, after in changes(course.done):
            counts[CLASSES[before]][CLASSES[after]] += 1.0
    return tuple(
        [
            tuple([round(WORTH * a + (1.0 - WORTH) * b / sum(row), 5) for a, b in zip(supposed, row, strict=True)])
            for supposed, row in zip(DEFAULT_CHANCES, counts, strict=True)
        ]
    )


def shifts(courses: Sequence[LabelledCourse], model: MotionModel) -> Shifts:
    """How much later than seen each change is dated: the median of those dated by hand and that of the emulated ones,
    the mean of both where there are enough of either."""
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
    """What the part makes of it, as spans."""
    courses = Hypotheses()
    begun: list[tuple[float, Activity]] = []
    last = max(course.seen, default=-1)
    for index in range(last + 1):
        feet = course.seen.get(index, {})
        said = [feet.get(foot) for foot in Foot]
        t = course.begin + index * BLOCK
        courses.update(
            BlockEvidence(
                t=t,
                motions=motion_votes(model, [None if one is None else one[0] for one in said]),
                forces=tuple([None if one is None else one[1] for one in said]),
                climbs=NO_EVIDENCE,
                before=None,
                after=None,
            ),
            model.chain,
        )
        begun += [(segment.t, segment.activity) for segment, _, _ in courses.settle(t if index < last else 1e9)]
    ends = [*[t for t, _ in begun[1:]], course.begin + (last + 1) * BLOCK]
    return [(t, end, activity) for (t, activity), end in zip(begun, ends, strict=True)]
