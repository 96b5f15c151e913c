"""Holds what a page shows of a calibration through which a person is led: the postures of a shoe.

The one who measures writes it."""

from __future__ import annotations

from attrs import define

from ...types import Foot


@define
class ShownPosture:
    """The posture of a shoe, while `solepath calibrate shoe --live` measures it; member "posture" of a frame."""

    foot: Foot
    task: str = ""
    """Next thing to do, as a sentence."""
    target: float | None = None
    """Pitch to which the heel is to be raised, rad; None while none is asked for."""
    pitch: float | None = None
    """Present pitch, rad, positive when the heel is up; None while it is not known."""
    lean: float | None = None
    """Lean to either side, rad; None if it is too small to matter."""
    still: bool = False
    """True if the shoe was still long enough for its pitch to be taken."""
