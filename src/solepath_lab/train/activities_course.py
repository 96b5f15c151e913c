"""Learns for `Activities` how activities follow each other: the chances of each change, and the shift of its time.

`Activities` detects a change in the block of half a second in which the samples fit the new activity better. People
label the same change by other signs (the foot on the first stair, the doors of the elevator). The time shift of a
change is the median of labelled minus detected time (see `shifts`). A course is the activities of a recording.

Numbers without a source were chosen by hand; no sweep of them is recorded."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise
from statistics import median

from attrs import frozen

from solepath.body.activity.chain import Chances, Shifts
from solepath.body.activity.elevator_evidence import BlockForce
from solepath.body.activity.foot_blocks import BLOCK_DURATION, BlockFeatures
from solepath.body.activity.hypotheses import NO_EVIDENCE, BlockEvidence, Hypotheses
from solepath.body.activity.motion import MotionModel, motion_votes
from solepath.body.activity.reconcile import GAITS
from solepath.types import Activity, Foot

from .activities_fit import CLASSES
from .hugadb import SPAN_GAP, Span

FootEvidence = tuple[BlockFeatures, BlockForce | None]
"""Features of a foot in a block, and the foot's vertical forces, in which an elevator ride can be detected."""

DEFAULT_CHANCES: Chances = (
    (0.959, 0.03, 1e-3, 5e-3, 5e-3),
    (0.03, 0.936, 4e-3, 0.015, 0.015),
    (0.01, 0.03, 0.956, 2e-3, 2e-3),
    (0.02, 0.05, 2e-3, 0.926, 2e-3),
    (0.02, 0.05, 2e-3, 2e-3, 0.926),
)
"""Chances before anything is learnt: standing lasts 12 s on average, and most flights end on level ground."""
DEFAULT_WEIGHT = 0.5
"""Weight of `DEFAULT_CHANCES` in a chance; the rest is the observed chance, which may not hold for other wearers."""
MATCHING_TIME = 4.0
"""Largest time between a detected change and the labelled one that it matches, s."""
MIN_CHANGES = 8
"""Smallest number of changes from which a time shift is learnt."""
SHIFT_RESOLUTION = 0.05
"""Resolution of a time shift, s."""


@frozen(eq=False)
class LabelledCourse:
    """A recording that is divided into blocks, with the evidence of each block and the true activities."""

    t_start: float
    """Start of block 0, s."""
    evidence: Mapping[int, Mapping[Foot, FootEvidence]]
    """Evidence by the number of the block and by foot."""
    activities: tuple[Span, ...]
    by_hand: bool = True
    """True when people labelled the activities, False when the emulator did."""


def changes(activities: Sequence[Span]) -> list[tuple[float, Activity, Activity]]:
    """Return the time (s), the activity before and the activity after of each change of activity."""
    return [
        (after[0], before[2], after[2]) for before, after in pairwise(activities) if after[0] - before[1] < SPAN_GAP
    ]


def chances(courses: Sequence[LabelledCourse]) -> Chances:
    """Return the probability of each change from one block to the next."""
    counts = [[1e-6 * chance for chance in row] for row in DEFAULT_CHANCES]
    for course in courses:
        for t_start, end, activity in course.activities:
            counts[CLASSES[activity]][CLASSES[activity]] += (end - t_start) / BLOCK_DURATION
        for _, before, after in changes(course.activities):
            counts[CLASSES[before]][CLASSES[after]] += 1.0
    return tuple(
        [
            tuple(
                [
                    round(DEFAULT_WEIGHT * a + (1.0 - DEFAULT_WEIGHT) * b / sum(row), 5)
                    for a, b in zip(supposed, row, strict=True)
                ]
            )
            for supposed, row in zip(DEFAULT_CHANCES, counts, strict=True)
        ]
    )


def shifts(courses: Sequence[LabelledCourse], model: MotionModel) -> Shifts:
    """Return the time by which each change is labelled later than it is detected, s.

    Changes labelled by people and emulated changes have a median each, if there are at least MIN_CHANGES of them. The
    shift is that of people between two gaits, because the emulator divides the stride between them in another way, and
    the mean of both between others."""
    delays: dict[tuple[Activity, Activity], dict[bool, list[float]]] = {}
    for course in courses:
        detected = changes(report_spans(course, model))
        for time, before, after in changes(course.activities):
            near = [time - t for t, a, b in detected if a is before and b is after and abs(time - t) < MATCHING_TIME]
            if near:
                kind = delays.setdefault((before, after), {})
                kind.setdefault(course.by_hand, []).append(min(near, key=abs))
    shifts = []
    for before in Activity:
        for after in Activity:
            kinds = {
                kind: times for kind, times in delays.get((before, after), {}).items() if len(times) >= MIN_CHANGES
            }
            if True in kinds and before in GAITS and after in GAITS:
                kinds.pop(False, None)
            medians = [median(times) for times in kinds.values()]
            if medians:
                n_units = round(sum(medians) / len(medians) / SHIFT_RESOLUTION)
                shifts.append((before, after, round(SHIFT_RESOLUTION * n_units, 2)))
    return tuple(shifts)


def report_spans(course: LabelledCourse, model: MotionModel) -> list[Span]:
    """Return the spans that `Activities` with this model reports for the recording."""
    hypotheses = Hypotheses()
    starts: list[tuple[float, Activity]] = []
    last = max(course.evidence, default=-1)
    for index in range(last + 1):
        feet = course.evidence.get(index, {})
        evidence = [feet.get(foot) for foot in Foot]
        t = course.t_start + index * BLOCK_DURATION
        hypotheses.update(
            BlockEvidence(
                t=t,
                motion_scores=motion_votes(model, [None if one is None else one[0] for one in evidence]),
                forces=tuple([None if one is None else one[1] for one in evidence]),
                pressure_scores=NO_EVIDENCE,
                before=None,
                after=None,
            ),
            model.chain,
        )
        starts += [(segment.t, segment.activity) for segment, _, _ in hypotheses.settle(t if index < last else 1e9)]
    ends = [*[t for t, _ in starts[1:]], course.t_start + (last + 1) * BLOCK_DURATION]
    return [(t, end, activity) for (t, activity), end in zip(starts, ends, strict=True)]
