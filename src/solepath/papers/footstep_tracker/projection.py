"""Corrector that moves stride by stride over the ground (Liu et al. 2015, IEEE MASS, sections IV.C and IV.D).

stride_length.py has the equations for a stride's length and turn. The paper leaves these points open:

- From one rest to the next the foot moves in the direction that it has after half of the turn: the chord of an arc.
- The integrals do not hold for a stride with a gap longer than `LONGEST_GAP`. Such a stride ends where the live
  position is, minus the drift that the remaining velocity at rest implies.
- A foot that pivots on its sole may seem to be in a static zone. Then its attitude follows the gyroscope.
- The paper's track has no height. Here the rise of a stride is integrated like its length, because it distinguishes
  stairs from level ground. A stride whose rise is much likelier on level ground ends as high as it started.
- `PRINTED` has (5) and (7) and the low-pass filter of turns alone, ignores pivots, and its strides have no rise.

Numbers without a source were chosen by hand."""

from __future__ import annotations

from math import atan2, cos, fsum, hypot, inf, sin

from ...body.activity.motion import slope_evidence
from ...body.gait.turns import TurningStrideFilter
from ...calibration import Calibration
from ...foot.navigate.corrector import LONGEST_BRIDGE
from ...foot.navigate.strapdown import Strapdown
from ...foot.stance.stance import Stance
from ...types import Floats, Foot, Phase, Quat, Vec3
from ...types.attrs import evolve, field, frozen, state, stateful
from ...types.vector import (
    GRAVITY,
    IDENTITY,
    ZERO,
    add,
    from_yaw,
    heading_turned,
    multiply,
    normalise,
    rotate,
    sub,
    tipped,
)
from .closed_stride import closed_stride, vertical_turn
from .critical_times import CriticalTimes
from .segment import StrideSegment
from .stride_length import stride_length, swing_turn

LONGEST_GAP = 0.12
"""Gap in a stride from which on the integrals do not hold, s: two of the paper's intervals and some tolerance."""
LONGEST_MOTION = 2.0
"""Time without rest after which the live position is frozen until the next rest, s."""
PIVOT_RATE = 0.15
"""Rate about the vertical above which a still foot pivots on its sole, rad/s."""
RANGE_END_SHARE = 0.8
"""Least ratio of the ends of the gyroscope's range on its axes, on either side; removing the bias has shifted them."""
AXIS_SHARE = 0.95
"""Least ratio of a rate about an axis of the foot to the rate about the sensor's nearest axis, up to 15 degrees off."""
LONGEST_STRIDE, LARGEST_RISE = 3.0, 1.0
"""Length of the longest stride, m, and largest change of height in one stride, m: four treads and some tolerance."""
STRIDE_ERROR, TURN_ERROR, MOST_TURN_ERRORS = 0.1, 0.05, 1000
"""Error of a stride as a share of its length (figure 11), error of its turn, rad, and largest number of such errors."""
RISE_ERROR = 0.1
"""Standard deviation of a stride's rise, m: that of level strides of emulated wearers with a CC2541 at 20 Hz.

Errors are taken as independent of each other, which they are not quite: a sensor's own bias repeats in every stride."""
LEAST_LEVELNESS = 1.0
"""Least evidence of a stride against stairs (stride_slope.py) with which it ends as high as it started."""
LONGEST_LEVELLING = 0.1
"""Longest time by which one sample at rest advances the levelling, s."""
UNSEEN_DISTANCE = 1.0
"""Distance assumed to be walked in a gap that is not integrated, m."""


@frozen
class ProjectionSettings:
    """Settings of `Projection`."""

    phi: float = 0.0
    """Angle phi of (1) in stride_length.py, rad: the toe-out of a left foot, minus that of a right one."""
    as_printed: bool = False
    """Flag: (5) and (7) from liftoff to landing; otherwise closed_stride.py from uplift to rest, with a rise."""
    restores_clipped: bool = True
    """Flag: angles beyond the range of the gyroscope are estimated; not as printed."""


PRINTED = ProjectionSettings(as_printed=True)
"""Settings with which (5) and (7) are used as they are printed."""


@stateful
class Projection(Strapdown):
    """Corrector that moves the foot stride by stride, by the projected stride length.

    The frame is that of `Corrector`. Latency: a stride is known when the static zone that ends it is detected. Until
    then the live position and attitude are those of strapdown integration. They jump at the end of the stride."""

    settings: ProjectionSettings = field(default=ProjectionSettings())
    turning: TurningStrideFilter = state(factory=TurningStrideFilter)
    largest_saturated: float = 0.0
    """Largest rate about an axis in a sample that the device marked as saturated, rad/s; 0 before the first."""
    least_saturated: float = 0.0
    """Least rate, rad/s, of the saturated samples in which the gyroscope, not the accelerometer, was saturated."""
    rest_attitude: Quat = IDENTITY
    """Attitude at the last rest."""
    rest_position: Vec3 = ZERO
    """Position at the last rest, m."""
    moving_time: float = 0.0
    """Time since the last rest, s."""
    length: float = 0.0
    """Distance walked since the last anchor, m."""
    stride_count: int = 0
    """Number of strides since the last anchor."""

    def calibrated(self, foot: Foot, calibration: Calibration) -> Projection:
        """Return the corrector for this foot, with its toe-out angle where it is known."""
        toe_out = calibration.toe_out.get(foot)
        if toe_out is None:
            return self
        return evolve(self, settings=evolve(self.settings, phi=toe_out if foot is Foot.LEFT else -toe_out))

    def start(self, attitude: Quat, tilt_sigma: float) -> None:
        self.attitude = self.rest_attitude = attitude
        self.velocity = self.position = self.rest_position = ZERO
        self.force = self.rate = None
        self.moving_time = self.length = 0.0
        self.stride_count = 0
        self.turning.forget_corner()

    def predict(self, dt: float, acc: Vec3, gyro: Vec3, saturated: bool = False) -> None:
        before = self.position
        self.integrate(dt, acc, gyro)
        if saturated:
            rate = max(map(abs, gyro))
            self.largest_saturated = max(self.largest_saturated, rate)
            if (
                self.least_saturated < RANGE_END_SHARE * self.largest_saturated
                or RANGE_END_SHARE * self.largest_saturated <= rate < self.least_saturated
            ):
                self.least_saturated = rate
        self.moving_time += dt
        if self.moving_time > LONGEST_MOTION:
            self.velocity, self.position = ZERO, before
            return
        if self.settings.as_printed:
            self.velocity, self.position = (*self.velocity[:2], 0.0), (*self.position[:2], 0.0)

    def correct(self, t: float, stance: Stance) -> bool:
        if stance.hint is not Phase.STATIONARY:
            return False
        segment = stance.detail
        if isinstance(segment, StrideSegment):
            self._end_stride(segment)
        elif self.settings.as_printed or self._rate_about_vertical() < PIVOT_RATE:
            self.attitude = self.rest_attitude
        self.position, self.velocity = self.rest_position, ZERO
        self._level(min(self.moving_time, LONGEST_LEVELLING))
        self.rest_attitude, self.moving_time = self.attitude, 0.0
        return True

    def _end_stride(self, segment: StrideSegment) -> None:
        end = self.rest_position
        if segment.longest_gap >= LONGEST_GAP:
            end = self._dedrifted_end()
            self.turning.forget_corner()
        elif segment.times is not None:
            end = self._stride_end(segment, segment.times)
        # without critical times the foot turned on the spot or shook, so it stays in place
        self.length += hypot(*sub(end, self.rest_position)[:2])
        self.stride_count += 1
        self.attitude = multiply(from_yaw(heading_turned(self.rest_attitude, self.attitude)), self.rest_attitude)
        self.rest_position = end

    def _stride_end(self, segment: StrideSegment, times: CriticalTimes) -> Vec3:
        """Return the position at the end of a stride by the equations, m."""
        settings, rows = self.settings, segment.rows
        phi = settings.phi
        if settings.as_printed:
            length, rise = fsum(stride_length(rows, times, phi)), 0.0
            turn = self.turning.turn(swing_turn(rows, times))
        else:
            clips = settings.restores_clipped and self.least_saturated > 0.0
            end = AXIS_SHARE * self.least_saturated if clips else inf
            closed = closed_stride(rows, times, end)
            length, rise = closed.length(phi), closed.rise()
            turn = self.turning.corner_turn(vertical_turn(rows, times, closed, end))
        fx, fy, _ = rotate(self.rest_attitude, segment.forward)
        # the direction of walking lies phi to the right of the foot's long axis
        direction = atan2(fy, fx) + 0.5 * turn - phi
        self.attitude = multiply(from_yaw(turn), self.rest_attitude)
        length = min(max(length, -LONGEST_STRIDE), LONGEST_STRIDE)
        rise = min(max(rise, -LARGEST_RISE), LARGEST_RISE)
        return add(self.rest_position, (length * cos(direction), length * sin(direction), rise))

    def _dedrifted_end(self) -> Vec3:
        """Return the live position without the drift that the velocity at rest implies, m."""
        end = add(self.position, self.velocity, -0.5 * min(self.moving_time, LONGEST_MOTION))
        x, y, z = sub(end, self.rest_position)
        k = LONGEST_STRIDE / max(LONGEST_STRIDE, hypot(x, y))
        return add(self.rest_position, (k * x, k * y, min(max(z, -LARGEST_RISE), LARGEST_RISE)))

    def flat(self, start: Vec3, turn: float) -> None:
        """Keep the height of a stride whose rise speaks for level ground; the rises of a track drift otherwise."""
        x, y, rise = sub(self.position, start)
        slope = slope_evidence(hypot(x, y), rise)
        if max(slope.up, slope.down) < -LEAST_LEVELNESS:
            self.position = self.rest_position = add(start, (x, y, 0.0))

    def repair(self, yaw: float, position: Vec3) -> None:
        """Do nothing, because only strides with a gap need a repair, and `_dedrifted_end` ends those."""

    def shift(self, yaw: float, by: Vec3) -> None:
        """Turn the state by `yaw` rad about the foot, which stands, and move it by `by` m, navigation frame."""
        self.turn_about(yaw, by)
        self.rest_attitude = normalise(multiply(from_yaw(yaw), self.rest_attitude))
        self.rest_position = add(self.rest_position, by)

    def bridge(self, dt: float) -> float:
        if dt <= LONGEST_BRIDGE:
            return dt
        self.velocity = ZERO
        self.force = self.rate = None
        self.length += UNSEEN_DISTANCE
        return 0.0

    def infill(self, dt: float, attitude: Quat, velocity: Vec3, position: Vec3) -> None:
        self.attitude, self.velocity, self.position = attitude, velocity, position
        self.force = self.rate = None
        self.moving_time += dt

    def anchor(self) -> Floats:
        covariance = self.covariance()
        self.length, self.stride_count = 0.0, 0
        return covariance

    def covariance(self) -> Floats:
        variance = (STRIDE_ERROR * (self.length + hypot(*sub(self.position, self.rest_position)[:2]))) ** 2
        yaw = TURN_ERROR * TURN_ERROR * min(self.stride_count, MOST_TURN_ERRORS)
        rises = 0.0 if self.settings.as_printed else (RISE_ERROR / TURN_ERROR) ** 2 * yaw
        return (variance, 0.0, 0.0, variance, 0.0, rises, yaw)

    def _rate_about_vertical(self) -> float:
        """Return the size of the rate about the vertical, rad/s; 0 before the first sample."""
        return 0.0 if self.rate is None else abs(rotate(self.attitude, self.rate)[2])

    def _level(self, dt: float) -> None:
        """Tilt the attitude so that the specific force comes to point up, with a time constant of 1 s."""
        if self.force is None:
            return
        fx, fy, _ = self.force
        share = 0.5 * dt / GRAVITY  # `tipped` takes half angles
        self.attitude = tipped(self.attitude, share * fy, -share * fx)
