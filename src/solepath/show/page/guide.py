"""A guide leads a person through a calibration, step by step, on the page: the postures of a shoe, or a walk."""

from __future__ import annotations

from typing import Any

from .posture import ShownPosture
from .toe_out import ShownToeOut

Guide = ShownPosture | ShownToeOut
"""Guide of a person through the postures of a shoe, or through a walk that calibrates toe-out."""


def guide_frame(guide: Guide | None) -> dict[str, Any]:
    """Return the members "posture" and "toe_out" of a frame, of which one at most is not None."""
    frame = None if guide is None else guide.frame()
    return {
        "posture": frame if isinstance(guide, ShownPosture) else None,
        "toe_out": frame if isinstance(guide, ShownToeOut) else None,
    }
