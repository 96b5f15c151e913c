"""What a session said of an emulated walk, against what really happened."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from attrs import frozen

from ...emulate.wearers.truth import FootTruth, Truth
from ...events import FootFlat, HeelOff, HeelStrike, ToeOff
from ...types import Foot
from ..evaluate.gathered import FootRun
from ..measures.matching import Errors, Matching, match, pairs
from ..measures.strides import position_errors

STEP_TOLERANCE = 0.4
"""s between the ends of a true and a found step: less than half the shortest stride."""
ALWAYS = ((-1e12, 1e12),)
"""The whole walk is labelled: whatever is found in it is judged."""


@frozen
class FootComparison:
    """One foot of one walk."""

    foot: Foot
    steps_true: int
    steps_found: int
    """True steps that were found."""
    steps_invented: int
    """Found steps that never were."""
    length_errors: Errors
    """Relative error of each stride length (0.01 is 1 %), ours less the true one."""
    events: dict[str, Matching]
    """heel_strike, foot_flat, heel_off, toe_off."""
    end_error: float | None
    """Horizontal distance in m of the last position from the true one, after aligning the first two metres."""


def compare(truth: Truth, feet: Mapping[Foot, FootRun]) -> list[FootComparison]:
    return [_compare(truth.feet[foot], run) for foot, run in feet.items()]


def _compare(truth: FootTruth, run: FootRun) -> FootComparison:
    matched = pairs([s.t_end for s in truth.steps], [s.t_end for s in run.steps], STEP_TOLERANCE)
    errors = [run.steps[j].length / truth.steps[i].length - 1.0 for i, j in matched if truth.steps[i].length > 0]
    return FootComparison(
        foot=truth.foot,
        steps_true=len(truth.steps),
        steps_found=len(matched),
        steps_invented=len(run.steps) - len(matched),
        length_errors=Errors(tuple(errors)),
        events={
            "heel_strike": match(truth.heel_strikes, run.times[HeelStrike], windows=ALWAYS),
            "foot_flat": match(truth.foot_flats, run.times[FootFlat], windows=ALWAYS),
            "heel_off": match(truth.heel_offs, run.times[HeelOff], windows=ALWAYS),
            "toe_off": match(truth.toe_offs, run.times[ToeOff], windows=ALWAYS),
        },
        end_error=_end_error(truth, run),
    )


def _end_error(truth: FootTruth, run: FootRun) -> float | None:
    if len(truth.steps) < 2 or not len(run.t):
        return None
    rests = np.array([truth.steps[0].t_start, *(step.t_end for step in truth.steps), run.t[-1]])
    places = truth.pose(rests).position[:, :2]
    return float(position_errors(rests, places, run.t, run.positions)[-1])
