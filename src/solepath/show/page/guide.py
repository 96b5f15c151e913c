"""Holds what a page shows of a calibration through which a person is led: the postures of a shoe, or a walk.

The one who measures writes it."""

from __future__ import annotations

from attrs import define, frozen

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


@define
class ShownToeOut:
    """A straight walk, while `solepath calibrate toe-out --live` measures it; member "toe_out" of a frame."""

    task: str = ""
    """Next thing to do, as a sentence."""
    distance: float | None = None
    """Length of the walk, m; None when it is not known."""
    feet: tuple[ShownFoot, ...] = ()


Guide = ShownPosture | ShownToeOut
"""Guide of a person through the postures of a shoe, or through a walk that calibrates toe-out."""
