"""Toe-out angle from a walk of known length (Liu et al. 2015, IEEE MASS, section IV.C and figure 10).

The wearer walks straight ahead for s metres. The steps along the foot's own direction, the double integral of a_f, come
to s_f, and since the foot points phi beside its way, phi = arccos(s / s_f).

An arc cosine is insensitive at small angles: 7 degrees of toe-out make s_f longer than s by 0.7 %, and an accelerometer
errs by more. Where s_f is shorter than s there is no such angle, and none is learnt of that foot."""

from __future__ import annotations

from collections.abc import Iterable
from math import acos, isfinite

from ...calibration import Calibration, CalibrationError
from ...events import StrideTaken
from ...session import Session
from ...types import Foot, Packet, Sample
from ...types.attrs import frozen
from .recipe import FOOTSTEP_TRACKER

FEWEST_STRIDES = 5
"""Fewest strides of a foot that give an angle."""
LARGEST_ANGLE = 1.0
"""Largest angle between a foot and its way, rad (protocol/calibration.md)."""


@frozen
class ToeOut:
    """The toe-out angle of one foot.

    `along`: s_f, m. `angle`: phi, rad, outwards; None where s_f is shorter than the walk."""

    foot: Foot
    steps: int
    along: float
    angle: float | None


def toe_out(items: Iterable[Packet | Sample], distance: float) -> list[ToeOut]:
    """Return the toe-out of each foot with samples, from a straight walk of `distance` m.

    CalibrationError when there are too few steps, or an angle that no foot has; ValueError for a distance that is not
    positive and finite."""
    if not (isfinite(distance) and distance > 0.0):
        raise ValueError(f"distance is {distance}")
    session = Session(FOOTSTEP_TRACKER)
    lengths: dict[Foot, list[float]] = {}
    for item in items:
        for event in session.feed(item):
            if isinstance(event, StrideTaken):
                lengths.setdefault(event.foot, []).append(event.length)
    found: list[ToeOut] = []
    for foot in [foot for foot in Foot if len(lengths.get(foot, ())) >= FEWEST_STRIDES]:
        along = sum(lengths[foot])
        angle = acos(distance / along) if along >= distance else None
        if angle is not None and angle > LARGEST_ANGLE:
            what = f"the steps of the {foot.value} foot come to {along:.1f} m of {distance:g} m"
            raise CalibrationError(f"{what}: is that the length of the walk?")
        found.append(ToeOut(foot, len(lengths[foot]), along, angle))
    if not found:
        most = max([len(one) for one in lengths.values()], default=0)
        raise CalibrationError(f"{most} steps of a foot in this recording; {FEWEST_STRIDES} are wanted")
    return found


def toe_out_calibration(found: Iterable[ToeOut]) -> Calibration:
    """Return a calibration with the angles that were found, and nothing else."""
    return Calibration(toe_out={one.foot: one.angle for one in found if one.angle is not None})
