"""Stride template of one foot: the last stride without a gap. It fills gaps (gap.py).

Walking is periodic: the same part of two neighbouring strides of one wearer differs by some per cent, whereas a
straight line over half a second of a swing gives an attitude that is wrong by a right angle. The end of a stride with a
gap is repaired on the same assumption: it is about as long as the template, and goes straight on (`StraightOn`).

The numbers were chosen by hand and not swept."""

from __future__ import annotations

from math import exp, hypot, pi
from struct import Struct
from typing import NamedTuple

from ..types import Quat, Vec3
from ..types.attrs import ROW_SIZE, define, field, frozen
from ..types.vector import ZERO, add, dot, normalise, sub, to_float32, turned

MOMENT = Struct("<15f")
"""Stored form of a moment: all numbers of `StrideMoment` in order, rounded to float32.

The relative rounding error is below 1e-6, whereas strides differ by some per cent. A stride of 40 moments takes 2.4 kB;
as tuples of floats it took 20 kB."""


@frozen
class StrideMoment:
    """One moment of a stride, in the navigation frame; `rate` is in the sensor frame."""

    since: float
    """Time since heel-off, s."""
    attitude: Quat
    """Attitude, sensor to navigation frame."""
    velocity: Vec3
    """Velocity, navigation frame, m/s."""
    position: Vec3
    """Position, navigation frame, m; only differences within a stride have a meaning."""
    rate: Vec3
    """Angular rate, sensor frame, rad/s."""
    force: float
    """Norm of the specific force, m/s^2."""


@define
class RecordedStride:
    """A stride without gaps."""

    moments: bytes = field(metadata={ROW_SIZE: MOMENT.size})
    """Moments from heel-off to just before foot-flat, in order, as `MOMENT` packs them; at least one."""
    toe_off: float
    """Time from heel-off to toe-off, s."""
    heel_strike: float
    """Time from heel-off to heel-strike, s."""
    displacement: Vec3
    """Displacement from foot-flat to foot-flat, m; x along the mean of both headings."""

    @property
    def duration(self) -> float:
        """Time from heel-off to the last moment, s."""
        since: float = MOMENT.unpack_from(self.moments, len(self.moments) - MOMENT.size)[0]
        return since


def unpack_moments(packed: bytes) -> list[StrideMoment]:
    """Return stored moments, in order."""
    return [
        StrideMoment(t, (qw, qx, qy, qz), (vx, vy, vz), (px, py, pz), (rx, ry, rz), force)
        for t, qw, qx, qy, qz, vx, vy, vz, px, py, pz, rx, ry, rz, force in MOMENT.iter_unpack(packed)
    ]


def interpolate_stride(moments: list[StrideMoment], since: float) -> StrideMoment:
    """Return the interpolated moment at `since` s after heel-off; outside the stride the first or the last moment.

    An infill asks for it once, for the moment before the gap."""
    before = moments[0]
    for moment in moments:
        if moment.since >= since:
            if moment is before:
                return moment
            k = (since - before.since) / (moment.since - before.since)
            return StrideMoment(
                since,
                normalise(_mix_attitudes(before.attitude, moment.attitude, k)),
                add(before.velocity, sub(moment.velocity, before.velocity), k),
                add(before.position, sub(moment.position, before.position), k),
                add(before.rate, sub(moment.rate, before.rate), k),
                before.force + k * (moment.force - before.force),
            )
        before = moment
    return before


def correction_distance(packed: bytes) -> float:
    """Return the distance by which zero-velocity updates have moved the foot in a stride of these moments, m.

    It is the length of the difference between displacement and integral of the velocity."""
    rows = list(MOMENT.iter_unpack(packed))
    first, last = rows[0], rows[-1]
    before, ax, ay, az = first[0], *first[5:8]
    x, y, z = sub(last[8:11], first[8:11])
    for t, _, _, _, _, bx, by, bz, *_ in rows:
        k = 0.5 * (t - before)
        x, y, z = x - k * (ax + bx), y - k * (ay + by), z - k * (az + bz)
        before, ax, ay, az = t, bx, by, bz
    return hypot(x, y, z)


def limit_length(v: Vec3, longest: float) -> Vec3:
    """Return a vector of the same direction that is at most `longest` long."""
    v_length = hypot(*v)
    return (
        v if v_length <= longest else (v[0] * longest / v_length, v[1] * longest / v_length, v[2] * longest / v_length)
    )


def _mix_attitudes(p: Quat, q: Quat, k: float) -> Quat:
    """Return the linear mean of two attitudes, with the weight k of `q`; the caller makes its length 1."""
    (a, b, c, d), (w, x, y, z) = p, q
    if a * w + b * x + c * y + d * z < 0.0:
        w, x, y, z = -w, -x, -y, -z
    return (a + k * (w - a), b + k * (x - b), c + k * (y - c), d + k * (z - d))


STRAIGHT_SHARE = 0.8
"""Prior probability that a stride goes straight on; otherwise it may have any heading."""
FOOTFALL_SIGMA = 0.025
"""Standard deviation of a footfall's heading from the mean heading in straight walking, rad."""
HEADING_MEMORY = 0.3
"""Weight of the newest footfall in the mean heading, 0 to 1."""
NEW_HEADING_TURN, SAMPLED_NEW_HEADING_TURN = 0.12, 0.0625
"""Smallest turn that starts a new mean heading, rad: for a stride with a gap, and without one."""
GAP_TURN_SIGMA = 0.08
"""Standard deviation of the heading after 0.3 s of infill, rad."""


@define
class StraightOn:
    """The mean heading of the footfalls, and the difference of the newest footfall from it.

    Wearers walk straight on most of the time. If a foot comes down after a gap with about the heading that it had
    before, the gap has caused the difference, which is removed ("heuristic drift elimination": Borenstein, Ojeda,
    Kwanmuang, J. Navigation 62, 2009). However many gaps there are, the error of the heading then stays as small as the
    difference between one footfall and the next. A wearer who turns causes a larger difference, which is kept. Angles
    are positive to the left."""

    yaw: float = 0.0
    """Heading of the newest footfall relative to the first, rad."""
    heading: float = 0.0
    """Heading of the newest footfall relative to the mean heading, rad."""
    footfalls: int = 0
    """Number of footfalls in the mean heading, counted up to 3, from which on it is used."""

    def repair(self, turn: float, gap_share: float, sparse_interval: float) -> float:
        """Return the most likely correction of a stride's turn, rad.

        `turn`, rad, is measured from foot-flat to foot-flat. `gap_share`, 0 to 1, is the duration of infill in units of
        0.3 s. `sparse_interval`, s, is the interval between samples if a swing has few of them, else 0."""
        if self.footfalls < 3:
            return 0.0
        difference = self.heading + turn
        # the error of a straight line between two samples grows with the square of the time
        heading_sigma = GAP_TURN_SIGMA * min(2.0, gap_share + 200.0 * sparse_interval * sparse_interval)
        return -difference * correction_share(difference * difference, heading_sigma, FOOTFALL_SIGMA, pi, 1)

    def add_footfall(self, turn: float, repair: float, gap_share: float, sparse_interval: float) -> None:
        """Add a foot-flat after a stride with this `turn`, which was corrected by `repair`, rad.

        `gap_share` and `sparse_interval` are the same as in the method `repair`."""
        difference = self.heading + turn + repair
        self.yaw = (self.yaw + (turn + repair) + pi) % (2.0 * pi) - pi
        # a stride without a gap that differs by more than footfalls do is a turn, which may go on in the next stride
        new_heading_turn = NEW_HEADING_TURN if gap_share > 0.0 or sparse_interval > 0.0 else SAMPLED_NEW_HEADING_TURN
        if abs(difference) > new_heading_turn * (1.0 + sparse_interval / 0.1):
            self.heading, self.footfalls = 0.0, 1
        else:
            self.heading = difference * (1.0 - HEADING_MEMORY)
            self.footfalls = min(self.footfalls + 1, 3)


def correction_share(square: float, gap_sigma: float, sigma: float, possible_range: float, dimensions: int) -> float:
    """Return the share of a difference from the usual value that is to be removed, 0 to 1.

    It is the gain of a Kalman update, times the probability that the motion was as usual. Otherwise any value within
    `possible_range` is equally likely. `square` is the square of the difference. `gap_sigma` is the standard deviation
    that the gap causes and `sigma` that of usual motion, all in one unit."""
    variance = gap_sigma * gap_sigma + sigma * sigma
    likelihood = STRAIGHT_SHARE * exp(-0.5 * square / variance) / float((2.0 * pi * variance) ** (0.5 * dimensions))
    return likelihood / (likelihood + (1.0 - STRAIGHT_SHARE) / possible_range) * gap_sigma * gap_sigma / variance


class StrideRepair(NamedTuple):
    """The most likely end of a stride with a gap."""

    turn: float
    """Angle to add to the heading, rad, positive to the left."""
    displacement: Vec3
    """Displacement from foot-flat to foot-flat, navigation frame, m."""


MOMENT_INTERVAL = 0.032
"""Interval between the stored moments, s."""
FEWEST_MOMENTS, MOST_MOMENTS = 4, 40
"""Smallest and largest number of moments of a template."""
GAP_POSITION_SIGMA, STRIDE_POSITION_SIGMA = 0.15, 0.06
"""Standard deviations of a stride's end, m: after 0.3 s of infill, and between two strides of one wearer."""
LONGEST_DENSE_INTERVAL = 0.03
"""Longest interval between samples that needs no repair of the strides, s."""
LARGEST_TEMPLATE_TURN, LARGEST_TEMPLATE_AGE = 0.2, 20
"""Largest turn of a template, rad, and its age in strides from which on a new one may turn by any angle."""
LARGEST_CORRECTION = 0.4
"""Largest distance by which zero-velocity updates may have moved the foot in a template, m."""
LARGEST_LENGTH_RATIO, LARGEST_RISE = 1.2, 0.4
"""Limits of a stride with a gap: length as a multiple of the longest recent stride; rise or fall, m, of two stairs."""


@define
class StrideTemplate:
    """The last stride without a gap, from heel-off to foot-flat, and the heading of the footfalls.

    At most MOST_MOMENTS are stored of each, the template and the current stride. Between two stored moments a sample
    costs one comparison."""

    last_stride: RecordedStride | None = None
    """Last stride without a gap; None before any."""
    age: int = 1000
    """Number of strides since `last_stride`."""
    moments: bytes = field(default=b"", metadata={ROW_SIZE: MOMENT.size})
    """Moments of the current stride, as `MOMENT` packs them."""
    first_position: Vec3 = ZERO
    """Position at the first of `moments`, navigation frame, m; the positions in `moments` are relative to it."""
    stance_duration: float = 0.0
    """Time from foot-flat to heel-off of the last stance without a gap, s."""
    t_flat: float | None = None
    """Time of the last foot-flat, s; None before the first stride."""
    t_heel_off: float | None = None
    """Time of heel-off, s; None while the foot stands."""
    t_next_moment: float = 0.0
    """Time at which the next moment is stored, s."""
    infilled: float = 0.0
    """Duration of infill in the motion since heel-off, s."""
    bridged: bool = False
    """A gap in this stride was bridged by a straight line."""
    t_last_flat: float | None = None
    """End of the last stride, s; a gap does not clear it."""
    longest_stride: float = 0.0
    """Length of the longest recent stride without a gap, m."""
    straight_on: StraightOn = field(factory=StraightOn)

    def start_stride(self, t: float) -> None:
        """Start to store a stride at heel-off."""
        if self.t_flat is not None and self.infilled == 0.0:
            self.stance_duration = t - self.t_flat
        self.t_heel_off = self.t_next_moment = t
        self.moments = b""

    def add_infill(self, t_heel_off: float, duration: float) -> None:
        """Set the heel-off at `t_heel_off`, s, and add `duration` s of infill."""
        self.infilled += duration
        self.t_heel_off = self.t_next_moment = t_heel_off

    def reset(self) -> None:
        """Discard the current stride, because the state of the foot is unknown."""
        self.t_heel_off = self.t_flat = None
        self.moments = b""
        self.straight_on.footfalls = 0

    def add_moment(self, t: float, attitude: Quat, velocity: Vec3, position: Vec3, acc: Vec3, gyro: Vec3) -> None:
        """Add a moment of a moving foot; call it when `t_next_moment` has come."""
        if self.t_heel_off is None:
            return
        self.t_next_moment = t + MOMENT_INTERVAL
        if self.infilled > 0.0:
            return
        if not self.moments:
            self.first_position = position
        elif len(self.moments) >= MOST_MOMENTS * MOMENT.size:
            self.moments = b""
            self.t_heel_off = None
            return
        try:
            x, y, z = position
            ox, oy, oz = self.first_position
            values = (t - self.t_heel_off, *attitude, *velocity, x - ox, y - oy, z - oz, *gyro, hypot(*acc))
            self.moments += MOMENT.pack(*values)  # OverflowError beyond 3e38: not a stride
        except OverflowError:
            self.moments = b""
            self.t_heel_off = None

    def end_stride(
        self,
        t: float,
        toe_off: float | None,
        heel_strike: float | None,
        turn: float,
        displacement: Vec3,
        interval: float,
    ) -> StrideRepair | None:
        """End a stride at foot-flat; return its repair, or None.

        `toe_off` and `heel_strike` are times, s; None if there was none. `turn` (rad) and `displacement` (m, navigation
        frame) are measured from foot-flat to foot-flat. `interval`, s, is the usual interval between samples: if it is
        long, every stride is treated as if it had a gap. The repair moves the end of the stride towards that of the
        template, as far as this is likely."""
        straight_on = self.straight_on
        middle_heading = straight_on.yaw + 0.5 * turn
        self._learn(t, toe_off, heel_strike, turn, turned(displacement, -middle_heading))
        infilled, self.infilled = self.infilled, 0.0
        bridged, self.bridged = self.bridged, False
        duration = None if self.t_last_flat is None else t - self.t_last_flat
        self.t_last_flat = t
        self.moments = b""
        self.t_heel_off = None
        self.t_flat = t
        sparse_interval = interval if interval > LONGEST_DENSE_INTERVAL else 0.0
        gap_share = min(1.0, infilled / 0.3)
        yaw, repair = 0.0, None
        if toe_off is not None and infilled + sparse_interval > 0.0:
            yaw = straight_on.repair(turn, gap_share, sparse_interval)
            way = turned(displacement, 0.5 * yaw)
            if self.last_stride is not None:
                d = sub(turned(self.last_stride.displacement, middle_heading + 0.5 * yaw), way)
                way = add(
                    way, d, correction_share(dot(d, d), GAP_POSITION_SIGMA * gap_share, STRIDE_POSITION_SIGMA, 3.0, 2)
                )
            repair = StrideRepair(yaw, way)
        if toe_off is not None and duration is not None and (infilled > 0.0 or bridged):
            repair = self._bounded(StrideRepair(0.0, displacement) if repair is None else repair, duration)
        straight_on.add_footfall(turn, yaw, gap_share, sparse_interval)
        return repair

    def _bounded(self, repair: StrideRepair, duration: float) -> StrideRepair:
        """Return the repair within what is possible for a stride of `duration` s."""
        if self.last_stride is None:
            return repair
        # a gap without infill may hide the foot-flat between two strides, which then count as one
        k = max(1.0, min(2.0, duration / (self.last_stride.duration + self.stance_duration)))
        x, y, z = repair.displacement
        x, y, _ = limit_length((x, y, 0.0), k * LARGEST_LENGTH_RATIO * self.longest_stride)
        return StrideRepair(repair.turn, (x, y, max(-k * LARGEST_RISE, min(z, k * LARGEST_RISE))))

    def _learn(
        self, t: float, toe_off: float | None, heel_strike: float | None, turn: float, displacement: Vec3
    ) -> None:
        """Make the stride that ends at `t`, s, the template if it has no gap.

        `displacement` has its x axis along the mean of both headings, m."""
        self.age = min(self.age + 1, 1000)
        if self.t_heel_off is None or toe_off is None or self.infilled > 0.0 or self.bridged:
            return
        if len(self.moments) < FEWEST_MOMENTS * MOMENT.size:
            return
        if correction_distance(self.moments) > LARGEST_CORRECTION:
            return
        self.longest_stride = max(0.95 * self.longest_stride, hypot(displacement[0], displacement[1]))
        # a stride round a corner is no template, unless the template is old
        if abs(turn) < LARGEST_TEMPLATE_TURN or self.age > LARGEST_TEMPLATE_AGE:
            t_heel_strike = t if heel_strike is None else heel_strike
            # rounded like the moments, because these times may be equal to that of a moment
            self.last_stride = RecordedStride(
                self.moments,
                to_float32(toe_off - self.t_heel_off),
                to_float32(t_heel_strike - self.t_heel_off),
                displacement,
            )
            self.age = 0
