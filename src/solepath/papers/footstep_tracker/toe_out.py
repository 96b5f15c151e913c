"""Toe-out angle from a walk of known length (Liu et al. 2015, IEEE MASS, section IV.C and figure 10).

The wearer walks straight ahead for s metres. s_f is the sum of the stride lengths along the foot's own long axis, the
double integral of a_f. The foot's long axis is turned by phi from the direction of walking, so phi = arccos(s / s_f).

The angle is uncertain when it is small: 7 degrees of toe-out make s_f longer than s by 0.7 %, and the error of an
accelerometer is larger. If s_f is shorter than s, no angle fits, and none is learnt for that foot."""

from __future__ import annotations

from collections.abc import Iterable
from math import acos, fsum, isfinite

from ...calibration import Calibration, CalibrationError
from ...events import StrideTaken
from ...session import Session
from ...types import Foot, Packet, Sample
from ...types.attrs import frozen
from .recipe import FOOTSTEP_TRACKER

FEWEST_STRIDES = 5
"""Fewest strides of a foot that give an angle."""
LARGEST_ANGLE = 1.0
"""Largest toe-out angle, rad (protocol/calibration.md)."""


@frozen
class ToeOut:
    """The toe-out angle of one foot."""

    foot: Foot
    strides: int
    """Number of strides."""
    along: float
    """Length s_f, m: sum of the stride lengths along the foot's long axis."""
    angle: float | None
    """Toe-out angle phi, rad, outwards positive; None when s_f is shorter than the walk."""


def toe_out(items: Iterable[Packet | Sample], distance: float) -> list[ToeOut]:
    """Return the toe-out of each foot with `FEWEST_STRIDES`, from a straight walk of `distance` m.

    Raises CalibrationError when there is no such foot or an angle is too large for a foot, ValueError when the distance
    is not positive and finite."""
    if not (isfinite(distance) and distance > 0.0):
        raise ValueError(f"distance is {distance}")
    session = Session(FOOTSTEP_TRACKER)
    lengths: dict[Foot, list[float]] = {}
    for item in items:
        for event in session.feed(item):
            if isinstance(event, StrideTaken):
                lengths.setdefault(event.foot, []).append(event.length)
    toe_outs: list[ToeOut] = []
    for foot in [foot for foot in Foot if len(lengths.get(foot, ())) >= FEWEST_STRIDES]:
        along = fsum(lengths[foot])
        angle = acos(distance / along) if along >= distance else None
        if angle is not None and angle > LARGEST_ANGLE:
            sentence = f"the strides of the {foot.value} foot come to {along:.1f} m of {distance:g} m"
            raise CalibrationError(f"{sentence}: is that the length of the walk?")
        toe_outs.append(ToeOut(foot, len(lengths[foot]), along, angle))
    if not toe_outs:
        stride_count = max([len(one) for one in lengths.values()], default=0)
        raise CalibrationError(f"{stride_count} strides of a foot in this recording; {FEWEST_STRIDES} are needed")
    return toe_outs


def toe_out_calibration(toe_outs: Iterable[ToeOut]) -> Calibration:
    """Return a calibration that contains only the known toe-out angles."""
    return Calibration(toe_out={one.foot: one.angle for one in toe_outs if one.angle is not None})
