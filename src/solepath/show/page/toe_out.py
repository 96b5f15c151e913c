"""Holds what a page shows of a walk that calibrates toe-out, while `solepath calibrate toe-out --live` measures it."""

from __future__ import annotations

from typing import Any

from attrs import define, frozen

from ...types import Foot
from .messages import rounded


@frozen
class ShownFoot:
    """The toe-out of one foot so far."""

    foot: Foot
    strides: int = 0
    along: float = 0.0
    """Sum of the stride lengths along the foot's long axis, m."""
    angle: float | None = None
    """Toe-out angle, rad, outwards positive; None while it is not known."""
    sigma: float | None = None
    """Error of the angle, rad; None while there is no angle."""
    learnt: bool = False
    """True if the angle is large enough against its error to be used."""
    why: str = ""
    """Reason why nothing is learnt of this foot so far; empty when something is."""

    def frame(self) -> dict[str, Any]:
        """Return one item of "feet" of the member "toe_out" of a frame."""
        return {
            "foot": self.foot.value,
            "strides": self.strides,
            "along": rounded(self.along),
            "angle": rounded(self.angle),
            "sigma": rounded(self.sigma),
            "learnt": self.learnt,
            "why": self.why,
        }


@define
class ShownToeOut:
    """A straight walk, and what the person who walks is to do; the one who measures writes it."""

    task: str = ""
    """Next thing to do, as a sentence."""
    distance: float | None = None
    """Length of the walk, m; None when it is not known."""
    feet: tuple[ShownFoot, ...] = ()

    def frame(self) -> dict[str, Any]:
        """Return the member "toe_out" of a frame."""
        feet = [foot.frame() for foot in self.feet]
        return {"task": self.task, "distance": rounded(self.distance), "feet": feet}
