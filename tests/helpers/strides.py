"""Strides as events made by hand, and a check of the strides that a walker plans."""

from __future__ import annotations

from math import hypot
from typing import Any

from solepath.emulate.wearers.walker import Walker
from solepath.events import StrideFeatures, StrideTaken
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
