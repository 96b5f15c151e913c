"""Holds what a page shows of a shoe that is held in postures while `solepath calibrate shoe --live` measures it."""

from __future__ import annotations

from typing import Any

from attrs import define

from ...types import Foot
from .messages import rounded


@define
class ShownPosture:
    """The posture of a shoe, and what the person who holds it is to do; the one who measures writes it."""

    foot: Foot
    task: str = ""
    """Next thing to do, as a sentence."""
    target: float | None = None
    """Pitch to which the heel is to be raised, rad; None while none is asked for."""
    pitch: float | None = None
    """Present pitch, rad, positive when the heel is up; None while it is not known."""
    lean: float | None = None
    """Lean to either side, rad; None if it is too small to matter."""
    is_still: bool = False
    """True if the shoe was still long enough for its pitch to be taken."""

    def frame(self) -> dict[str, Any]:
        """Return the member "posture" of a frame."""
        return {
            "foot": self.foot.value,
            "task": self.task,
            "target": rounded(self.target),
            "pitch": rounded(self.pitch),
            "lean": rounded(self.lean),
            "still": self.is_still,
        }
