"""Strides: as events made by hand, and as a walker plans them."""

from __future__ import annotations

from math import hypot
from typing import Any

from solepath.emulate.wearers.walker import Walker
from solepath.events import StrideFeatures, StrideTaken
from solepath.types import Foot, Vec3


def stride(foot: Foot, t: float, way: Vec3 = (1.2, 0.0, 0.0), **other: Any) -> StrideTaken:
    """Return a stride of this displacement, m, within the second before `t`; `other` sets further fields."""
    x, y, z = way
    known: dict[str, Any] = {
        "known_at": t, "number": 1, "t_start": t - 1.0, "t_end": t, "displacement": way, "position": (0.0, 0.0, 0.0),
        "length": hypot(x, y), "heading_change": 0.0, "height_change": z, "covariance": (0.0,) * 6,
        "features": StrideFeatures(0.1, 4.0, 1.0),
    }  # fmt: skip
    return StrideTaken(t=t, foot=foot, **(known | other))


def in_order(walker: Walker) -> None:
    """Every foot goes heel-off, toe-off, heel-strike, foot-flat over and over, until the walk ends."""
    for strides in walker.plan.strides.values():
        before = 0.0
        for one in strides:
            assert before < one.heel_off < one.toe_off < one.heel_strike < one.foot_flat < walker.duration
            before = one.foot_flat
