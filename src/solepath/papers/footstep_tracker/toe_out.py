"""Toe-out angle from a straight walk (Liu et al. 2015, IEEE MASS, section IV.C and figures 9 and 10).

As printed, the wearer walks s metres, s_f is the double integral of a_f, and phi = arccos(s / s_f) (`printed_angle`).
That contradicts (1): a foot that moves along the way, with its long axis turned by phi, has a_f = a_m cos(phi). So
s_f = s cos(phi) is shorter than s, and s / s_f is no cosine. The printed angle is the error of the length: 1 % of it
gives 8 degrees, 3 % give 14. Its error is that of the length divided by tan(phi), which is more than half of any usual
toe-out, so it is never used.

Ours takes phi from the other part of (1): a_x = a_m sin(phi), so the double integrals of a_x and a_f over the walk have
the ratio tan(phi). Scale errors cancel in the ratio, and no length is needed. What remains is the spread of the strides
and the error of the long axis, which is learnt from how the heel rises (`FootAxes`)."""

from __future__ import annotations

from collections.abc import Iterable
from math import acos, atan2, cos, fsum, hypot, inf, isfinite, pi, radians, sqrt, tan

from ...calibration import Calibration, CalibrationError
from ...events import Event
from ...session import Session
from ...types import Foot, Packet, Sample, Vec3
from ...types.attrs import define, evolve, field, frozen
from .closed_stride import closed_stride, vertical_turn
from .critical_times import CriticalTimes
from .projection import AXIS_SHARE, Projection
from .recipe import FOOTSTEP_TRACKER
from .segment import StrideSegment

FEWEST_STRIDES = 5
"""Fewest strides of a foot that give an angle."""
LARGEST_ANGLE = 1.0
"""Largest toe-out angle, rad (protocol/calibration.md); a length off by more than its cosine is of another walk."""
LARGEST_TURN = 0.5
"""Largest sum of a foot's turns in a straight walk, rad (chosen by hand)."""
LENGTH_ERROR = 0.024
"""Error of s_f as a share of it: the rms error of emulated walks of 20 m with a CC2541 (seeds 7001 to 7008).

The data sheet of its accelerometer alone has 1.5 % for the scale."""
AXIS_ERROR = radians(1.4)
"""Error of the foot's long axis, rad: the rms error of the angles of emulated walks with a CC2541 in the sole.

It is 1.0 degrees in walks of 20 m at 1.2 m/s (the same seeds) and 1.8 in walks of 15 m at 1.3 m/s (seeds 1 to 4), where
the gyroscope clips more. The angles are 0.8 and 1.5 degrees too small on average."""
ERRORS = 2.0
"""Number of its errors that an angle must be larger than."""


@frozen
class ToeOut:
    """The toe-out angle of one foot."""

    foot: Foot
    strides: int
    """Number of strides."""
    along: float
    """Length s_f, m: sum of the stride lengths along the foot's long axis."""
    angle: float
    """Toe-out angle phi by the accelerations across and along the foot, rad, outwards positive."""
    sigma: float
    """Error of the angle, rad."""

    @property
    def is_known(self) -> bool:
        """Flag: the angle is twice its error or more."""
        return abs(self.angle) >= ERRORS * self.sigma


@define
class MeasuredStrides(Projection):
    """Corrector that also keeps where each stride went in the foot's own axes."""

    strides: list[Vec3] = field(factory=list, init=False)
    """For each stride the distances along the foot's long axis and to its right, m, and the turn, rad."""

    def _stride_end(self, segment: StrideSegment, times: CriticalTimes) -> Vec3:
        end = AXIS_SHARE * self.least_saturated if self.least_saturated > 0.0 else inf
        stride = closed_stride(segment.rows, times, end)
        turn = vertical_turn(segment.rows, times, stride, end)
        self.strides.append((fsum(stride.length()), stride.across(), turn))
        return Projection._stride_end(self, segment, times)


def _new_session() -> Session:
    return Session(evolve(FOOTSTEP_TRACKER, corrector=MeasuredStrides()))


@define
class ToeOutWalk:
    """A straight walk whose toe-out is measured while it goes on."""

    session: Session = field(factory=_new_session, init=False)

    def feed(self, item: Packet | Sample) -> list[Event]:
        """Add the next packet or sample, and return the events of the session."""
        return self.session.feed(item)

    def strides(self, foot: Foot) -> list[Vec3]:
        """Return the strides of a foot so far, as in `MeasuredStrides.strides`."""
        tracker = self.session.feet.get(foot)
        corrector = None if tracker is None else tracker.corrector
        return corrector.strides if isinstance(corrector, MeasuredStrides) else []

    def feet(self, distance: float | None = None) -> list[ToeOut]:
        """Return the toe-out so far of each foot with `FEWEST_STRIDES`; raise CalibrationError as `toe_out` does.

        `distance` is the length of the walk, m; None when it is not known."""
        return [of for foot in Foot if (of := self.foot(foot, distance)) is not None]

    def foot(self, foot: Foot, distance: float | None = None) -> ToeOut | None:
        """Return the toe-out so far of a foot, None with fewer strides than `FEWEST_STRIDES`; raise as `feet` does."""
        strides = self.strides(foot)
        return _of_foot(foot, strides, distance) if len(strides) >= FEWEST_STRIDES else None


def toe_out(items: Iterable[Packet | Sample], distance: float | None = None) -> list[ToeOut]:
    """Return the toe-out of each foot with `FEWEST_STRIDES`, from a straight walk; `distance` is its length, m.

    Raises CalibrationError when there is no such foot, when the walk bends or is not of this length, and when an angle
    is too large for a foot; ValueError when the distance is not positive and finite."""
    if distance is not None and not (isfinite(distance) and distance > 0.0):
        raise ValueError(f"distance is {distance}")
    walk = ToeOutWalk()
    for item in items:
        walk.feed(item)
    walk.session.finish()
    toe_outs = walk.feet(distance)
    if not toe_outs:
        stride_count = max([len(walk.strides(foot)) for foot in Foot])
        raise CalibrationError(f"{stride_count} strides of a foot in this recording; {FEWEST_STRIDES} are needed")
    return toe_outs


def _of_foot(foot: Foot, strides: list[Vec3], distance: float | None) -> ToeOut:
    along, across, turned = (fsum([stride[k] for stride in strides]) for k in range(3))
    if abs(turned) > LARGEST_TURN:
        raise CalibrationError(f"the {foot.value} foot turns by {turned:.1f} rad: is the walk straight?")
    ratio = 0.0 if distance is None or not along > 0.0 else min(along, distance) / max(along, distance)
    if distance is not None and ratio < cos(LARGEST_ANGLE):
        sentence = f"the strides of the {foot.value} foot come to {along:.1f} m of {distance:g} m"
        raise CalibrationError(f"{sentence}: is that the length of the walk?")
    outwards = 1.0 if foot is Foot.LEFT else -1.0
    angle = outwards * atan2(across, along)
    if abs(angle) > LARGEST_ANGLE:
        raise CalibrationError(f"the {foot.value} foot goes {angle:.1f} rad beside its long axis, which no foot does")
    return ToeOut(foot, len(strides), along, angle, hypot(_spread(strides, angle, outwards), AXIS_ERROR))


def _spread(strides: list[Vec3], angle: float, outwards: float) -> float:
    """Return the error of the angle by the spread of the strides, rad, each weighted by its length."""
    along = fsum([x for x, _, _ in strides])
    residuals = [outwards * y - x * tan(angle) for x, y, _ in strides]
    return sqrt(fsum([r * r for r in residuals])) / max(along, 1e-9)


def printed_angle(along: float, distance: float) -> tuple[float, float] | None:
    """Return phi = arccos(s / s_f) and its error, rad; None where s_f is shorter than s, so that no angle fits."""
    if not along > distance:
        return None
    angle = acos(distance / along)
    return angle, min(LENGTH_ERROR / tan(angle), 0.5 * pi)


def toe_out_calibration(toe_outs: Iterable[ToeOut]) -> Calibration:
    """Return a calibration with the angles that are known; feet whose angles are not keep what they had."""
    return Calibration(toe_out={one.foot: one.angle for one in toe_outs if one.is_known})
