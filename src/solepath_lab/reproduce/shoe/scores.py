"""Scores of the strides of one session against the truth, in each state, and of the legs of a walk.

The paper's "step" is the stride of one foot. Errors are estimated minus true."""

from __future__ import annotations

from collections.abc import Sequence
from math import atan2, degrees, hypot, remainder

import numpy as np

from solepath.emulate.routes.styles import StrideKind
from solepath.emulate.wearers.truth import TrueStride, Truth
from solepath.events import StrideTaken
from solepath.papers.shoe_sensing.steepness import angle_per_metre, steepness
from solepath.types import Foot
from solepath.validate.alignment import ALIGNMENT_LENGTH

from ..tables import PUBLISHED, Values, mean
from ..walks import MATCHING_TIME, matched

TWO_RISERS = 0.25
"""Height change that only a stride over two risers of 0.16 m exceeds, m."""
LEAST_LEVEL_LENGTH = 0.3
"""Length above which a stride on the level is no part of a turn on the spot, m."""
DIVISOR: float = PUBLISHED["shoe-sensing"]["table-2-divisor"]
"""Number by which table 2 divides."""
DIRECTIONS = {"upstairs": 1, "downstairs": -1}
"""Steepness (papers/shoe_sensing/steepness.py) by state; 0 for the others."""

Scores = Values
"""Figures of one session by name: one value for each stride, leg or walk.

"STATE, steps %": F1 of the strides of a state; "STATE, state %": share of the strides found whose state is right;
"STATE, angle deg/m": angle per metre (papers/shoe_sensing/steepness.py), positive upwards; "STATE, length m" and
"STATE, height m": sizes of errors; "STATE, table 2 %": mean error over the mean length (upstairs: height), over the
number by which table 2 divides."""


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


def score_strides(strides: Sequence[StrideTaken], truth: Truth, foot: Foot) -> Scores:
    """Return the figures of the strides of a foot by state, for the states that the walk has.

    A reported stride without a match counts to the state of the true stride in which it ends."""
    true = truth.strides(foot)
    states = states_of(truth, foot)
    matches = matched(strides, true)
    used = {id(stride) for stride, _ in matches}
    extra = [stride for stride in strides if id(stride) not in used]
    result: Scores = {}
    for state in dict.fromkeys([state for state in states if state is not None]):
        expected = [one for one, of in zip(true, states, strict=True) if of == state]
        numbers = {one.number for one in expected}
        counted = [(stride, one) for stride, one in matches if one.number in numbers]
        invented = sum([any(one.t_start < stride.t < one.t_end for one in expected) for stride in extra])
        reported = len(counted) + 0.5 * (len(expected) - len(counted) + invented)
        ours = [(stride.length, stride.height_change) for stride, _ in counted]
        true_pairs = [(one.length, one.displacement[2]) for _, one in counted]
        off = np.abs(np.subtract(ours, true_pairs)).reshape(-1, 2)
        column = 1 if state == "upstairs" else 0
        sizes = np.abs(np.reshape(true_pairs, (-1, 2)))[:, column]
        right = [100.0 * (steepness(*one) == DIRECTIONS.get(state, 0)) for one in ours]
        result |= {
            f"{state}, steps %": (100.0 * len(counted) / max(1.0, reported),),
            f"{state}, state %": (mean(right),),
            f"{state}, angle deg/m": tuple([degrees(angle_per_metre(*one)) for one in ours]),
            f"{state}, length m": tuple(off[:, 0].tolist()),
            f"{state}, height m": tuple(off[:, 1].tolist()),
            f"{state}, table 2 %": (100.0 * float(off[:, column].mean() / sizes.mean()) / DIVISOR,) if ours else (),
        }
    return result


def score_legs(strides: Sequence[StrideTaken], truth: Truth, foot: Foot) -> Scores:
    """Return the figures of all legs: strides on the level between turns on the spot.

    "leg m" and "leg off m": distance from its start to its end, and the size of its error; "course deg": size of the
    direction error of each matched stride, after alignment over its leg's first two metres."""
    legs: list[list[TrueStride]] = [[]]
    for one, state in zip(truth.strides(foot), states_of(truth, foot), strict=True):
        if state is not None:
            legs[-1].append(one)
        elif legs[-1]:
            legs.append([])
    found, courses = [], []
    for leg in [leg for leg in legs if leg]:
        start, end = leg[0].t_start, leg[-1].t_end
        inside = [stride for stride in strides if start + 0.05 < stride.t_end < end + MATCHING_TIME]
        if inside:
            ours, true = (np.sum([one.displacement for one in part], axis=0) for part in (inside, leg))
            found.append([float(hypot(*way[:2])) for way in (ours, true)])
            courses += _courses(matched(inside, leg))
    return {
        "leg m": tuple([length for length, _ in found]),
        "leg off m": tuple([abs(length - true) for length, true in found]),
        "course deg": tuple([abs(course) for course in courses]),
    }


def _angle(displacement: Sequence[float]) -> float:
    return atan2(displacement[1], displacement[0])


def _wrapped(angle: float) -> float:
    return remainder(angle, 2.0 * np.pi)


def _courses(matches: Sequence[tuple[StrideTaken, TrueStride]]) -> list[float]:
    """Return the direction of each stride minus the true one, degrees; the first two metres are laid on the truth."""
    if not matches:
        return []
    errors = [_wrapped(_angle(stride.displacement) - _angle(true.displacement)) for stride, true in matches]
    travelled = np.cumsum([true.length for _, true in matches])
    count = 1 + int(np.sum(travelled < ALIGNMENT_LENGTH))
    ours, true_way = (np.sum([one[k].displacement for one in matches[:count]], axis=0) for k in (0, 1))
    aligned = _angle(ours) - _angle(true_way)
    return [degrees(_wrapped(error - aligned)) for error in errors]
