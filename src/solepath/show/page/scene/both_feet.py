"""Computes the members of a frame that are of both feet together: support, last touchdown, body, last fused stride."""

from __future__ import annotations

from typing import Any

from ....events import StrideFused, TouchedDown
from ....foot.phase import SUPPORT
from ....types import Foot
from ....walk.walk import Walk
from ..body import LiveBody, body_frame
from ..messages import rounded, rounded_all
from .feet import FootScene


def both_feet_frame(feet: dict[Foot, FootScene], walk: Walk, body: LiveBody | None) -> dict[str, Any]:
    """Return the members "support", "touchdown", "body" and "fused" of a frame; `body` has the legs between events."""
    left, right = feet[Foot.LEFT].phase, feet[Foot.RIGHT].phase
    down = walk.touchdown
    legs = None if body is None else body.frame(walk.now)
    return {
        "support": None if left is None or right is None else SUPPORT[left][right].value,
        "touchdown": _touchdown_frame(down),
        "body": legs if legs is not None or down is None or down.legs is None else body_frame(down.t, down.legs),
        "fused": _fused_frame(walk.fused),
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
