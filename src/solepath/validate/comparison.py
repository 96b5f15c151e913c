"""Compares the events of a session with the truth of an emulated walk."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from attrs import frozen

from ..emulate.wearers.truth import FootTruth, Truth
from ..events import FootFlat, HeelOff, HeelStrike, ToeOff
from ..types import Foot
from .alignment import position_errors
from .foot_run import FootRun
from .matching import Errors, Matching, match, pairs

STRIDE_TOLERANCE = 0.4
"""Largest time between the ends of a true stride and a found one that match, s: below half the shortest stride."""
WHOLE_WALK = ((-1e12, 1e12),)
"""Window of time that contains every walk, s, so that every found event is counted."""


@frozen
class FootComparison:
    """The comparison of the strides and events of one foot in one walk with the truth."""

    foot: Foot
    strides_true: int
    """Number of true strides."""
    strides_found: int
    """Number of true strides that were found."""
    strides_invented: int
    """Number of found strides that match no true one."""
    length_errors: Errors
    """Relative error of each stride length, found minus true (0.01 is 1 %)."""
    events: dict[str, Matching]
    """Matched events by kind: heel_strike, foot_flat, heel_off, toe_off."""
    end_error: float | None
    """Horizontal distance of the last position from the true one, m, after alignment over the first two metres.

    None for a foot without a track or with fewer than two true strides."""


def compare(truth: Truth, feet: Mapping[Foot, FootRun]) -> list[FootComparison]:
    """Return the comparison of each foot with the truth."""
    return [_compare(truth.feet[foot], run) for foot, run in feet.items()]


def _compare(truth: FootTruth, run: FootRun) -> FootComparison:
    matched = pairs([s.t_end for s in truth.strides], [s.t_end for s in run.strides], STRIDE_TOLERANCE)
    errors = [run.strides[j].length / truth.strides[i].length - 1.0 for i, j in matched if truth.strides[i].length > 0]
    return FootComparison(
        foot=truth.foot,
        strides_true=len(truth.strides),
        strides_found=len(matched),
        strides_invented=len(run.strides) - len(matched),
        length_errors=Errors(tuple(errors)),
        events={
            "heel_strike": match(truth.heel_strikes, run.times[HeelStrike], windows=WHOLE_WALK),
            "foot_flat": match(truth.foot_flats, run.times[FootFlat], windows=WHOLE_WALK),
            "heel_off": match(truth.heel_offs, run.times[HeelOff], windows=WHOLE_WALK),
            "toe_off": match(truth.toe_offs, run.times[ToeOff], windows=WHOLE_WALK),
        },
        end_error=_end_error(truth, run),
    )


def _end_error(truth: FootTruth, run: FootRun) -> float | None:
    if len(truth.strides) < 2 or not len(run.t):
        return None
    t_stances = np.array([truth.strides[0].t_start, *(stride.t_end for stride in truth.strides), run.t[-1]])
    true_positions = truth.pose(t_stances).position[:, :2]
    return float(position_errors(t_stances, true_positions, run.t, run.positions)[-1])
