"""Scores of the strides of one session against the truth, in each state, and of the legs of a walk.

The paper's "step" is the stride of one foot. Errors are estimated minus true."""

from __future__ import annotations

from collections.abc import Sequence
from math import atan2, degrees, hypot, remainder

import numpy as np
from attrs import frozen

from solepath.emulate.routes.styles import StrideKind
from solepath.emulate.wearers.truth import TrueStride, Truth
from solepath.events import StrideTaken
from solepath.papers.shoe_sensing.steepness import angle_per_metre, steepness
from solepath.types import Foot
from solepath.validate.alignment import ALIGNMENT_LENGTH
from solepath.validate.matching import pairs

MATCHING_TIME = 0.3
"""Largest time between the ends of a found stride and the true one that it matches, s."""
TWO_RISERS = 0.25
"""Height change that only a stride over two risers of 0.16 m exceeds, m."""
LEAST_LEVEL_LENGTH = 0.3
"""Length above which a stride on the level is no part of a turn on the spot, m."""
DIRECTIONS = {"upstairs": 1, "downstairs": -1}
"""Steepness (papers/shoe_sensing/steepness.py) by state; 0 for the others."""

Pair = tuple[float, float]


@frozen
class StrideErrors:
    """The comparison of the strides of one session in one state with the truth."""

    angles: tuple[float, ...]
    """Angle per metre of each matched stride (papers/shoe_sensing/steepness.py), degrees/m, positive upwards."""
    lengths: tuple[Pair, ...]
    """Error and true value of the length of each matched stride, m."""
    heights: tuple[Pair, ...]
    """Error and true value of the height change of each matched stride, m."""
    right: tuple[bool, ...]
    """True for each matched stride whose state (level, upstairs, downstairs) is right."""
    start_offsets: tuple[float, ...]
    """Start of each matched stride minus the true start, s."""
    not_found: int
    """Number of true strides without a match."""
    invented: int
    """Number of reported strides without a match."""

    @property
    def found(self) -> int:
        """Number of matched strides."""
        return len(self.lengths)

    @property
    def merged(self) -> int:
        """Number of strides that were reported as one with the stride before, whose end was not found."""
        return sum([offset < -MATCHING_TIME for offset in self.start_offsets])

    @property
    def split(self) -> int:
        """Number of strides that were reported in two pieces, of which the last counts as found."""
        return sum([offset > MATCHING_TIME for offset in self.start_offsets])

    @property
    def whole(self) -> tuple[float, ...]:
        """Length errors of the strides that are neither merged nor split, m."""
        pairs_of_stride = zip(self.lengths, self.start_offsets, strict=True)
        return tuple([error for (error, _), offset in pairs_of_stride if abs(offset) <= MATCHING_TIME])

    @property
    def right_share(self) -> float:
        """Percentage of the found strides whose state is right."""
        return 100.0 * sum(self.right) / max(1, len(self.right))

    @property
    def stride_f1(self) -> float:
        """F1 of the strides, %: 2 x found / (true + reported)."""
        return 100.0 * self.found / max(1.0, self.found + 0.5 * (self.not_found + self.invented))


def states_of(truth: Truth, foot: Foot) -> list[str | None]:
    """Return the state of each true stride of the foot; None for one that belongs to none of them.

    Those are strides of turns on the spot, and strides that lead onto or off a flight over a single riser."""
    states: list[str | None] = []
    for stride, planned in zip(truth.strides(foot), truth.plan.strides[foot], strict=True):
        rise = stride.displacement[2]
        if planned.flight is not None:
            states.append(("upstairs" if rise > 0.0 else "downstairs") if abs(rise) > TWO_RISERS else None)
        elif stride.length < LEAST_LEVEL_LENGTH:
            states.append(None)
        else:
            states.append("jogging" if planned.kind is StrideKind.RUN else "walking")
    return states


def matched(found: Sequence[StrideTaken], true: Sequence[TrueStride]) -> list[tuple[StrideTaken, TrueStride]]:
    """Return the pairs of a found and a true stride whose ends are at most MATCHING_TIME apart, one to one."""
    ends = [one.t_end for one in true], [stride.t_end for stride in found]
    return [(found[j], true[i]) for i, j in pairs(*ends, MATCHING_TIME)]


def score_strides(strides: Sequence[StrideTaken], truth: Truth, foot: Foot) -> dict[str, StrideErrors]:
    """Return the scores of the strides of a foot by state, for the states that the walk has.

    A reported stride without a match counts to the state of the true stride in which it ends."""
    true = truth.strides(foot)
    states = states_of(truth, foot)
    matches = matched(strides, true)
    used = {id(stride) for stride, _ in matches}
    extra = [stride for stride in strides if id(stride) not in used]
    result = {}
    for state in dict.fromkeys([state for state in states if state is not None]):
        expected = [one for one, of in zip(true, states, strict=True) if of == state]
        numbers = {one.number for one in expected}
        counted = [(stride, one) for stride, one in matches if one.number in numbers]
        direction = DIRECTIONS.get(state, 0)
        result[state] = StrideErrors(
            angles=tuple([degrees(angle_per_metre(stride.length, stride.height_change)) for stride, _ in counted]),
            lengths=tuple([(stride.length - one.length, one.length) for stride, one in counted]),
            heights=tuple(
                [(stride.height_change - one.displacement[2], one.displacement[2]) for stride, one in counted]
            ),
            right=tuple([steepness(stride.length, stride.height_change) == direction for stride, _ in counted]),
            start_offsets=tuple([stride.t_start - one.t_start for stride, one in counted]),
            not_found=len(expected) - len(counted),
            invented=sum([any(one.t_start < stride.t < one.t_end for one in expected) for stride in extra]),
        )
    return result


@frozen
class LegErrors:
    """The comparison of one straight leg with the truth."""

    length: Pair
    """Error and true value of the distance from its start to its end, m."""
    height: float
    """Error of the height gained, m."""
    courses: tuple[float, ...]
    """Direction error of each matched stride, degrees, after alignment over the leg's first two metres."""
    heading: float
    """Direction of the leg minus the true one, degrees, positive to the left; the first leg is aligned with it."""


def score_legs(strides: Sequence[StrideTaken], truth: Truth, foot: Foot) -> tuple[LegErrors, ...]:
    """Return the scores of all legs: strides on the level between turns on the spot."""
    legs: list[list[TrueStride]] = [[]]
    for one, state in zip(truth.strides(foot), states_of(truth, foot), strict=True):
        if state is not None:
            legs[-1].append(one)
        elif legs[-1]:
            legs.append([])
    scores: list[LegErrors] = []
    first = 0.0
    for leg in [leg for leg in legs if leg]:
        start, end = leg[0].t_start, leg[-1].t_end
        inside = [stride for stride in strides if start + 0.05 < stride.t_end < end + MATCHING_TIME]
        if not inside:
            continue
        ours, true = (np.sum([one.displacement for one in part], axis=0) for part in (inside, leg))
        heading = _angle(ours) - _angle(true)
        first = first if scores else heading
        error = float(hypot(*ours[:2]) - hypot(*true[:2]))
        scores.append(
            LegErrors(
                length=(error, float(hypot(*true[:2]))),
                height=float(ours[2] - true[2]),
                courses=_courses(matched(inside, leg)),
                heading=degrees(_wrapped(heading - first)),
            )
        )
    return tuple(scores)


def _angle(displacement: Sequence[float]) -> float:
    return atan2(displacement[1], displacement[0])


def _wrapped(angle: float) -> float:
    return remainder(angle, 2.0 * np.pi)


def _courses(matches: Sequence[tuple[StrideTaken, TrueStride]]) -> tuple[float, ...]:
    """Return the direction of each stride minus the true one, degrees; the first two metres are laid on the truth."""
    if not matches:
        return ()
    errors = [_wrapped(_angle(stride.displacement) - _angle(true.displacement)) for stride, true in matches]
    travelled = np.cumsum([true.length for _, true in matches])
    count = 1 + int(np.sum(travelled < ALIGNMENT_LENGTH))
    ours, true_way = (np.sum([one[k].displacement for one in matches[:count]], axis=0) for k in (0, 1))
    aligned = _angle(ours) - _angle(true_way)
    return tuple([degrees(_wrapped(error - aligned)) for error in errors])


def relative_error(errors: Sequence[Pair]) -> float:
    """Return the mean magnitude of the error over the mean true value, as the paper computes it; 0 for none."""
    sizes, true = (float(np.mean(np.abs(values))) for values in zip(*errors, strict=True))
    return sizes / true if true else 0.0
