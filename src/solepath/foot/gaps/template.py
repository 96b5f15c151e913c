"""Stride template of one foot: the last stride without a gap. It fills gaps (gap.py).

Walking is periodic: the same part of two neighbouring strides of one wearer differs by some per cent, whereas a
straight line over half a second of a swing gives an attitude that is wrong by a right angle. The end of a stride with a
gap is repaired on the same assumption: the stride is about as long as the template, and goes straight on (straight.py).

The numbers were chosen by hand and not swept."""

from __future__ import annotations

from math import hypot
from typing import NamedTuple

from ...types import Quat, Vec3
from ...types.attrs import ROW_SIZE, define, field
from ...types.vector import ZERO, single, sub, turned
from .moment import MOMENT, RecordedStride, correction_distance, limit_length
from .straight import StraightOn, correction_share


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

    last_stride: RecordedStride | None = field(default=None, init=False)
    """Last stride without a gap; None before any."""
    age: int = field(default=1000, init=False)
    """Number of strides since `last_stride`."""
    moments: bytes = field(default=b"", init=False, metadata={ROW_SIZE: MOMENT.size})
    """Moments of the current stride, as `MOMENT` packs them."""
    first_position: Vec3 = field(default=ZERO, init=False)
    """Position at the first of `moments`, navigation frame, m; the positions in `moments` are relative to it."""
    stance_duration: float = field(default=0.0, init=False)
    """Time from foot-flat to heel-off of the last stance without a gap, s."""
    t_flat: float | None = field(default=None, init=False)
    """Time of the last foot-flat, s; None before the first stride."""
    t_heel_off: float | None = field(default=None, init=False)
    """Time of heel-off, s; None while the foot stands."""
    t_next_moment: float = field(default=0.0, init=False)
    """Time at which the next moment is stored, s."""
    infilled: float = field(default=0.0, init=False)
    """Duration of infill in the motion since heel-off, s."""
    bridged: bool = field(default=False, init=False)
    """A gap in this stride was bridged by a straight line."""
    t_last_flat: float | None = field(default=None, init=False)
    """End of the last stride, s; a gap does not clear it."""
    longest_stride: float = field(default=0.0, init=False)
    """Length of the longest recent stride without a gap, m."""
    straight_on: StraightOn = field(factory=StraightOn, init=False)

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

    def mark_bridged(self) -> None:
        """Mark that a gap was bridged by a straight line."""
        self.bridged = True

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
            x, y, z = turned(displacement, 0.5 * yaw)
            if self.last_stride is not None:
                dx, dy, dz = sub(turned(self.last_stride.displacement, middle_heading + 0.5 * yaw), (x, y, z))
                k = correction_share(
                    dx * dx + dy * dy + dz * dz, GAP_POSITION_SIGMA * gap_share, STRIDE_POSITION_SIGMA, 3.0, 2
                )
                x, y, z = x + k * dx, y + k * dy, z + k * dz
            repair = StrideRepair(yaw, (x, y, z))
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
                self.moments, single(toe_off - self.t_heel_off), single(t_heel_strike - self.t_heel_off), displacement
            )
            self.age = 0
