"""Computes the members of a frame that are of both feet together: support, last touchdown, body, last fused stride."""

from __future__ import annotations

from math import hypot, isfinite
from typing import Any

from ....events import StrideFused, TouchedDown
from ....foot.phase import SUPPORT
from ....types import Foot
from ...observer import Observer
from ..messages import rounded, rounded_all
from .feet import FootScene


def both_feet_frame(feet: dict[Foot, FootScene], observer: Observer) -> dict[str, Any]:
    """Return the members "support", "touchdown", "body" and "fused" of a frame."""
    left, right = feet[Foot.LEFT].phase, feet[Foot.RIGHT].phase
    return {
        "support": None if left is None or right is None else SUPPORT[left][right].value,
        "touchdown": _touchdown_frame(observer.touchdown),
        "body": None if observer.touchdown is None else body_frame(observer.touchdown),
        "fused": _fused_frame(observer.fused),
    }


def _touchdown_frame(touchdown: TouchedDown | None) -> dict[str, Any] | None:
    """Return the member "touchdown": the last one of a recipe that has touchdowns, with its walking mode."""
    if touchdown is None:
        return None
    return {
        "t": rounded(touchdown.t),
        "foot": touchdown.foot.value,
        "mode": touchdown.mode.value,
        "position": rounded_all(touchdown.position),
    }


def body_frame(touchdown: TouchedDown) -> dict[str, Any] | None:
    """Return the member "body": the legs at a touchdown seen from the wearer's right; None without their sensors.

    Coordinates are ahead of the middle of the hips and above it, m. Ahead is the mean horizontal direction from the
    ankles to the ends of the feet."""
    if touchdown.legs is None:
        return None
    x = y = 0.0
    for _, _, ankle, end in touchdown.legs:
        x, y = x + end[0] - ankle[0], y + end[1] - ankle[1]
    length = hypot(x, y)
    if not (isfinite(length) and length > 0.0):
        return None
    sides = [[[(a * x + b * y) / length, up] for a, b, up in leg] for leg in touchdown.legs]
    left, right = [[rounded_all(point) for point in side] for side in sides]
    return {"t": rounded(touchdown.t), "left": left, "right": right}


def _fused_frame(fused: StrideFused | None) -> dict[str, Any] | None:
    """Return the member "fused": the last stride of a recipe that fuses strides (Chen et al. 2019, (9) to (13))."""
    if fused is None:
        return None
    return {
        "t": rounded(fused.t),
        "foot": fused.foot.value,
        "length": rounded(fused.stride_length),
        "similarity": rounded(fused.similarity),
        "error_index": rounded(fused.error_index, 4),
        "share": rounded(fused.coefficient),
        "chosen": fused.chosen.value,
        "distance": rounded(fused.distance, 2),
    }
