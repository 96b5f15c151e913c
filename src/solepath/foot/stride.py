"""Record of one stride from foot-flat to foot-flat, and uncertainty of the path so far."""

from __future__ import annotations

from math import hypot

from ..events import StrideFeatures, StrideTaken
from ..types import Foot, Quat, Vec3
from ..types.attrs import define, field
from ..types.vector import IDENTITY, SPLIT, ZERO, heading_turned, single, sub
from .world import World

MOST_COP_POINTS = 32
"""Largest number of centre-of-pressure points that are stored of a stride."""
MOST_PITCHES = 32
"""Number of samples whose pitch is stored; a toe-off or heel-strike is dated back by fewer samples."""


LONGEST_SWING = 3.0
"""Longest swing of a single stride, s."""
FASTEST_STRIDE = 10.0
"""Largest mean speed of a stride that is possible, m/s; nobody runs faster."""


@define
class PathCovariance:
    """The covariance of position and heading at the end of a chain of stretches, by the rule of dead reckoning.

    Let a stretch have the displacement d (m) and the covariance C, and let its heading at the start have the standard
    deviation s (rad). Its end then has the error of C, and that of s times d turned by 90 degrees. Memory is O(1)
    however long the path is."""

    position: tuple[float, float, float, float, float, float] = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    """Covariance of the position: xx, xy, xz, yy, yz, zz, m^2."""
    yaw: float = 0.0
    """Variance of the heading, rad^2."""
    position_yaw: tuple[float, float] = (0.0, 0.0)
    """Covariance of position x and y with yaw, m rad."""

    def extend(self, displacement: Vec3, stretch: tuple[float, ...]) -> PathCovariance:
        """Return the path with one more stretch, given by displacement (m) and covariance (`Corrector.anchor`)."""
        dx, dy, _ = displacement
        px, py = -dy, dx
        sxx, sxy, sxz, syy, syz, szz, yaw = stretch
        xx, xy, xz, y2, yz, zz = self.position
        mx, my = self.position_yaw
        v = self.yaw
        return PathCovariance(
            (
                xx + sxx + 2.0 * mx * px + v * px * px,
                xy + sxy + mx * py + my * px + v * px * py,
                xz + sxz,
                y2 + syy + 2.0 * my * py + v * py * py,
                yz + syz,
                zz + szz,
            ),
            v + yaw,
            (mx + v * px, my + v * py),
        )


FIRST_MOTION = 0.8
"""Time from heel-off to the next foot-flat, s, that counts as usual before the first stride."""
MERGED_RATIO = 1.8
"""Ratio of that time to the wearer's usual one from which on two strides have merged because a stance was missed.

Two swings and a stance take more than twice that time. On recordings without damage 99 % of the ratios are below 1.6.
"""
MOTION_GAIN, LEAST_MOTION_RATIO, LARGEST_MOTION_RATIO = 0.2, 0.5, 1.3
"""Weight of the newest time in the usual one, and the limits of its ratio to the usual one in the average."""
SHORTEST_STRIDE, LEAST_STRIDE_TURN = 0.06, 0.35
"""Smallest displacement, m, and smallest turn, rad, of a stride; one of the two is enough."""


@define
class StrideBuilder:
    """Collects the data of one foot's stride."""

    foot: Foot
    number: int = field(default=0, init=False)
    """Number of the last stride, counted from 1."""
    t_start: float | None = field(default=None, init=False)
    """Time of the foot-flat that starts the stride, s; None before any."""
    start: Vec3 = field(default=ZERO, init=False)
    """Position at the start, navigation frame, m."""
    attitude: Quat = field(default=IDENTITY, init=False)
    """Attitude at the start, sensor to navigation frame."""
    t_toe_off: float | None = field(default=None, init=False)
    """Time of toe-off, s; None before it."""
    t_heel_strike: float | None = field(default=None, init=False)
    """Time of heel-strike, s; None before it."""
    degraded: bool = field(default=False, init=False)
    """Samples of the stride are missing or saturated, or a defect spoils them."""
    degraded_until: float | None = field(default=None, init=False)
    """Time up to which samples cannot be trusted, s; None at first."""
    peak_height: float = field(default=0.0, init=False)
    """Largest height of the sensor in the stride, navigation frame, m."""
    peak_speed: float = field(default=0.0, init=False)
    """Largest speed of the sensor in the stride, m/s."""
    t_heel_off: float | None = field(default=None, init=False)
    """Time of heel-off, s; None before it."""
    usual_motion: float = field(default=FIRST_MOTION, init=False)
    """Usual time from heel-off to the next foot-flat of this wearer, s."""
    pitch: float = field(default=0.0, init=False)
    """Integral of the sagittal rate since the start, toe down positive, rad."""
    pitch_low: float = field(default=0.0, init=False)
    """Smallest pitch of the stride, rad."""
    pitch_high: float = field(default=0.0, init=False)
    """Largest pitch of the stride, rad."""
    pitches: list[float] = field(factory=lambda: [0.0] * MOST_PITCHES, init=False)
    """Ring buffer of the newest pitches, rad, rounded by `single`."""
    next_pitch: int = field(default=0, init=False)
    """Index of the oldest pitch in `pitches`, which the next one replaces."""
    t_pitch: float = field(default=0.0, init=False)
    """Time of the newest pitch, s."""
    toe_off_pitch: float | None = field(default=None, init=False)
    """Pitch at toe-off, toe down positive, rad; None if unknown."""
    heel_strike_pitch: float | None = field(default=None, init=False)
    """Pitch at heel-strike, toe down positive, rad; None if unknown."""
    load_sum: float = field(default=0.0, init=False)
    """Sum of the total load over the samples on the ground."""
    load_count: int = field(default=0, init=False)
    """Number of samples in `load_sum`."""
    cop: list[tuple[float, float]] = field(factory=list, init=False)
    """Points of the centre of pressure, foot frame, m."""
    cop_interval: int = field(default=1, init=False)
    """Number of samples for each stored point of the centre of pressure."""
    cop_skipped: int = field(default=0, init=False)
    """Number of samples since the last stored point of the centre of pressure."""

    def start_stride(self, t: float, position: Vec3, attitude: Quat) -> None:
        """Start a stride at a foot-flat; position (m) and attitude are in the navigation frame."""
        self.t_start = t
        self.start = position
        self.attitude = attitude
        self.t_heel_off = self.t_toe_off = self.t_heel_strike = None
        self.toe_off_pitch = self.heel_strike_pitch = None
        # the foot-flat may be dated back into a gap; the rest of the gap then degrades the new stride
        self.degraded = self.degraded_until is not None and t < self.degraded_until
        self.peak_height = position[2]
        self.peak_speed = self.pitch = self.pitch_low = self.pitch_high = 0.0
        self.load_sum = 0.0
        self.load_count = 0
        self.cop = []
        self.cop_interval = 1
        self.cop_skipped = 0

    def mark_degraded(self, until: float | None) -> None:
        """Mark that samples up to `until`, s, cannot be trusted; None if times restart."""
        self.degraded = True
        if until is None or self.degraded_until is None or until > self.degraded_until:
            self.degraded_until = until

    def add_motion(self, t: float, dt: float, height: float, speed: float, sagittal: float) -> None:
        """Add one sample: height in m, speed in m/s, sagittal rate in rad/s (0 while its axis is unknown)."""
        if height > self.peak_height:
            self.peak_height = height
        if speed > self.peak_speed:
            self.peak_speed = speed
        pitch = self.pitch = self.pitch + sagittal * dt
        self.t_pitch = t
        high = SPLIT * pitch  # rounded as by `single`
        self.pitches[self.next_pitch] = high - (high - pitch)
        self.next_pitch = (self.next_pitch + 1) % MOST_PITCHES
        if pitch < self.pitch_low:
            self.pitch_low = pitch
        elif pitch > self.pitch_high:
            self.pitch_high = pitch

    def add_toe_off(self, t: float, interval: float) -> None:
        """Set the toe-off at `t`, s; `interval` is the usual interval between samples, s."""
        self.t_toe_off = t
        self.toe_off_pitch = self._pitch_at(t, interval)

    def add_heel_strike(self, t: float, interval: float) -> None:
        """Set the heel-strike at `t`, s; `interval` is the usual interval between samples, s."""
        self.t_heel_strike = t
        self.heel_strike_pitch = self._pitch_at(t, interval)

    def _pitch_at(self, t: float, interval: float) -> float | None:
        """Return the pitch at `t`, interpolated between two samples, rad.

        The result is None if a gap hides these samples, or if the sagittal axis is not yet known."""
        if t > self.t_pitch or self.pitches[self.next_pitch - 2] == 0.0:
            return None
        samples_back = (self.t_pitch - t) / interval if interval > 0.0 else 0.0
        samples_back = min(max(samples_back, 0.0), MOST_PITCHES - 2.0)
        k = int(samples_back)
        later, earlier = self.pitches[self.next_pitch - 1 - k], self.pitches[self.next_pitch - 2 - k]
        return later + (samples_back - k) * (earlier - later)

    def add_load(self, total: float, cop: tuple[float, float] | None) -> None:
        """Add one sample of a foot on the ground: total load, and centre of pressure, foot frame, m.

        At most MOST_COP_POINTS points are stored, at equal intervals. When there are more, every second one is dropped.
        """
        self.load_sum += total
        self.load_count += 1
        if cop is None:
            return
        self.cop_skipped += 1
        if self.cop_skipped < self.cop_interval:
            return
        self.cop_skipped = 0
        x, y = cop
        self.cop.append((single(x), single(y)))
        if len(self.cop) > MOST_COP_POINTS:
            self.cop = self.cop[::2]
            self.cop_interval *= 2

    def finish(
        self,
        t: float,
        known_at: float,
        position: Vec3,
        attitude: Quat,
        stretch: tuple[float, ...],
        world: World,
        *,
        error_index: float | None = None,
        rise: float | None = None,
    ) -> StrideTaken | None:
        """Return the stride that ends at this foot-flat; None if the foot has made none.

        `position` (m), `attitude` and `stretch` (`Corrector.anchor`) are in the navigation frame."""
        if self.t_start is None or self.t_toe_off is None or max(self.t_start, self.t_toe_off) > t:
            return None  # no stride, or a restart of times has cut it in two
        displacement = world.rotate_vector(sub(position, self.start))
        length, dz = hypot(displacement[0], displacement[1]), displacement[2]
        turn = heading_turned(self.attitude, attitude)
        if hypot(length, dz) < SHORTEST_STRIDE and abs(turn) < LEAST_STRIDE_TURN:
            return None
        self.number += 1
        merged = self._has_merged(t)
        return StrideTaken(
            t=t,
            known_at=known_at,
            foot=self.foot,
            number=self.number,
            t_start=self.t_start,
            t_end=t,
            displacement=displacement,
            position=world.rotate_vector(position),
            length=length,
            heading_change=turn,
            height_change=dz,
            covariance=world.rotate_covariance(stretch[:6]),
            t_toe_off=self.t_toe_off,
            t_heel_strike=self.t_heel_strike,
            degraded=self.degraded
            or merged
            or t - self.t_toe_off > LONGEST_SWING
            or length > FASTEST_STRIDE * (t - self.t_start),
            features=StrideFeatures(
                clearance=self.peak_height - max(position[2], self.start[2]),
                peak_speed=self.peak_speed,
                swing_pitch=self.pitch_high - self.pitch_low,
                toe_off_angle=self.toe_off_pitch,
                # the reference is the sole at the foot-flat that ends the stride
                heel_strike_angle=None if self.heel_strike_pitch is None else self.pitch - self.heel_strike_pitch,
                contact_load=self.load_sum / self.load_count if self.load_count else None,
                cop=tuple(self.cop),
                error_index=error_index,
                rise=rise,
            ),
        )

    def _has_merged(self, t: float) -> bool:
        """Return whether the stride that ends at `t`, s, covers two strides, and learn the usual time of one."""
        usual = self.usual_motion
        motion = usual if self.t_heel_off is None else t - self.t_heel_off
        if motion > MERGED_RATIO * usual:
            return True
        if not self.degraded:
            limited = min(max(motion, LEAST_MOTION_RATIO * usual), LARGEST_MOTION_RATIO * usual)
            self.usual_motion += MOTION_GAIN * (limited - usual)
        return False
