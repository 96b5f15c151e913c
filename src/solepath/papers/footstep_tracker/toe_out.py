"""The toe-out angle from a walk of known length (Liu et al. 2015, IEEE MASS, section IV.C and figure 10).

The wearer walks straight ahead for s metres. The steps along the foot's own direction, the double integral of a_f, come
to s_f, and since the foot points phi beside its way, phi = arccos(s / s_f).

An arc cosine says little of small angles: 7 degrees of toe-out make s_f longer than s by 0.7 %, and an accelerometer
is wrong by more. Where s_f is shorter than s there is no such angle, and none is learnt of that foot.
"""

from __future__ import annotations

from collections.abc import Iterable
from math import acos, isfinite

from ...calibration import Calibration, CalibrationError
from ...events import StrideTaken
from ...session import Session
from ...types import Foot, Packet, Sample
from ...types.attrs import frozen
from .recipe import FOOTSTEP_TRACKER

FEWEST = 5
"""Steps of a foot that tell anything."""
WIDEST = 1.0
"""No foot points further from its way, rad (protocol/calibration.md)."""


@frozen
class ToeOut:
    """Of one foot. `along`: s_f, m. `angle`: phi, rad, outwards; None where s_f is shorter than the walk."""

    foot: Foot
    steps: int
    along: float
    angle: float | None


def toe_out(items: Iterable[Packet | Sample], distance: float) -> list[ToeOut]:
    """Of each foot that was heard, from a straight walk of `distance` m. CalibrationError when there are too few steps,
    or an angle that no foot has; ValueError for a distance that is none."""
    if not (isfinite(distance) and distance > 0.0):
        raise ValueError(f"distance is {distance}")
    session = Session(FOOTSTEP_TRACKER)
    lengths: dict[Foot, list[float]] = {}
    for item in items:
        for event in session.feed(item):
            if isinstance(event, StrideTaken):
                lengths.setdefault(event.foot, []).append(event.length)
    found: list[ToeOut] = []
    for foot in [foot for foot in Foot if len(lengths.get(foot, ())) >= FEWEST]:
        along = sum(lengths[foot])
        angle = acos(distance / along) if along >= distance else None
        if angle is not None and angle > WIDEST:
            what = f"the steps of the {foot.value} foot come to {along:.1f} m of {distance:g} m"
            raise CalibrationError(f"{what}: is that the length of the walk?")
        found.append(ToeOut(foot, len(lengths[foot]), along, angle))
    if not found:
        most = max([len(one) for one in lengths.values()], default=0)
        raise CalibrationError(f"{most} steps of a foot in this recording; {FEWEST} are wanted")
    return found


def learnt(found: Iterable[ToeOut]) -> Calibration:
    """The angles that were found, and nothing else."""
    return Calibration(toe_out={one.foot: one.angle for one in found if one.angle is not None})
