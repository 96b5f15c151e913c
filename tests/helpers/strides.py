"""Strides and gait cycles as events made by hand, and a check of the strides that a walker plans."""

from __future__ import annotations

from collections.abc import Sequence
from math import hypot
from typing import Any

import attrs

from solepath.emulate.wearers.walker import Walker
from solepath.events import GaitCycleMeasured, StrideFeatures, StrideTaken
from solepath.types import Foot, Vec3


def stride(foot: Foot, t: float, way: Vec3 = (1.2, 0.0, 0.0), **other: Any) -> StrideTaken:
    """Return a stride of this displacement, m, within the second before `t`; `other` sets further fields."""
    x, y, z = way
    fields: dict[str, Any] = {
        "known_at": t, "number": 1, "t_start": t - 1.0, "t_end": t, "displacement": way, "position": (0.0, 0.0, 0.0),
        "length": hypot(x, y), "heading_change": 0.0, "height_change": z, "covariance": (0.0,) * 6,
        "features": StrideFeatures(0.1, 4.0, 1.0),
    }  # fmt: skip
    return StrideTaken(t=t, foot=foot, **(fields | other))


def cycle(foot: Foot, start: float, time: float, length: float | None = 1.2, **other: Any) -> GaitCycleMeasured:
    """Return a steady walking cycle from `start`, s, for `time` s, `length` m long; `other` sets further fields."""
    nothing = dict.fromkeys([one.name for one in attrs.fields(GaitCycleMeasured)])
    known = {
        "t": start + time, "known_at": start + time, "final": True, "foot": foot, "number": 1, "t_start": start,
        "t_toe_off": start + 0.6 * time, "stride_time": time, "stance_time": 0.6 * time, "swing_time": 0.4 * time,
        "cadence": 120.0 / time, "stride_length": length, "speed": None if length is None else length / time,
        "degraded": False, "steady": True,
    }  # fmt: skip
    return GaitCycleMeasured(**(nothing | known | other))  # type: ignore[arg-type]


def cycles(foot: Foot, start: float, times: Sequence[float], length: float | None = 1.2) -> list[GaitCycleMeasured]:
    """Return cycles that follow each other from `start`, s, each for the next of `times`, s."""
    made: list[GaitCycleMeasured] = []
    for time in times:
        made.append(cycle(foot, made[-1].t if made else start, time, length))
    return made


def in_order(walker: Walker) -> None:
    """Check that each stride of a foot has heel-off, toe-off, heel-strike and foot-flat in this order."""
    for strides in walker.plan.strides.values():
        previous = 0.0
        for stride_ in strides:
            assert (
                previous
                < stride_.heel_off
                < stride_.toe_off
                < stride_.heel_strike
                < stride_.foot_flat
                < walker.duration
            )
            previous = stride_.foot_flat
