"""Stride template of one foot: the last stride without a gap. It fills gaps (gap.py).

Walking is periodic: the same part of two neighbouring strides of one wearer differs by some per cent, whereas a
straight line over half a second of a swing is wrong by a right angle. The end of a stride with a gap is repaired in the
same way: it goes about as far as the template, and straight on (straight.py)."""

from __future__ import annotations

from math import hypot
from typing import NamedTuple

from ...types import Quat, Vec3
from ...types.attrs import define, field
from ...types.vector import ZERO, single, sub, turned
from .moment import SINGLES, MomentRow, RecordedStride, correction_distance, limit_length
from .straight import StraightOn, share


class StrideRepair(NamedTuple):
    """The most likely turn and displacement of a stride with a gap."""

    turn: float
    """Angle to add to the heading, rad."""
    displacement: Vec3
    """Displacement from foot-flat to foot-flat, m."""


SPACING = 0.032
"""Interval between the stored moments, s."""
FEWEST_MOMENTS, MOST_MOMENTS = 4, 40
"""Smallest and largest number of moments of a template."""
GAP_DISTANCE, STRIDE_SIGMA = 0.15, 0.06
"""Standard deviation of a stride's end after 0.3 s of infill, and of the difference of two strides, m."""
DENSE = 0.03
"""Longest interval between samples that follow a swing well, s."""
CORNER, OLD = 0.2, 20
"""Largest turn of a template, rad, and the number of strides after which any turn is taken."""
LARGEST_DRIFT = 0.4
"""Largest distance by which zero velocity may have moved the foot in a template, m."""
ROOM, HIGHEST = 1.2, 0.4
"""Limits of a stride with a gap: length as a multiple of the longest recent stride, and height, m.

The height is that of two stairs."""


@define
class StrideTemplate:
    """The last stride without a gap, from heel-off to foot-flat, and the heading of the footfalls.

    Between the stored moments a sample costs one comparison. MOST_MOMENTS of two strides are stored."""

    last: RecordedStride | None = field(default=None, init=False)
    """Last stride without a gap; None before any."""
    age: int = field(default=1000, init=False)
    """Number of strides since `last`."""
    rows: list[MomentRow] = field(factory=list, init=False)
    """Moments of the current stride."""
    origin: Vec3 = field(default=ZERO, init=False)
    """Position at the first of these moments, navigation frame, m; their positions are relative to it."""
    stance: float = field(default=0.0, init=False)
    """Time for which the foot was flat before the last heel-off, s."""
    flat_since: float | None = field(default=None, init=False)
    """Time of the last foot-flat, s; None before the first stride."""
    t_heel_off: float | None = field(default=None, init=False)
    """Time of heel-off, s; None while the foot stands."""
    due: float = field(default=0.0, init=False)
    """Time at which the next moment is stored, s."""
    infilled: float = field(default=0.0, init=False)
    """Duration of infill in the motion since heel-off, s."""
    bridged: bool = field(default=False, init=False)
    """A gap in this stride was bridged by a straight line."""
    last_flat_at: float | None = field(default=None, init=False)
    """End of the last stride, s; a gap does not clear it."""
    longest: float = field(default=0.0, init=False)
    """Length of the longest recent stride without a gap, m."""
    straight_on: StraightOn = field(factory=StraightOn, init=False)

    def start_stride(self, t: float) -> None:
        """Start to store a stride at heel-off."""
        if self.flat_since is not None and self.infilled == 0.0:
            self.stance = t - self.flat_since
        self.t_heel_off = self.due = t
        self.rows = []

    def add_infill(self, t_heel_off: float, duration: float) -> None:
        """Set the heel-off at `t_heel_off`, s, and add `duration` s of infill."""
        self.infilled += duration
        self.t_heel_off = self.due = t_heel_off

    def mark_bridged(self) -> None:
        """Mark that a gap was bridged by a straight line."""
        self.bridged = True

    def reset(self) -> None:
        """Discard the current stride, because the state of the foot is unknown."""
        self.t_heel_off = self.flat_since = None
        self.rows = []
        self.straight_on.footfalls = 0

    def add_moment(self, t: float, attitude: Quat, velocity: Vec3, position: Vec3, acc: Vec3, gyro: Vec3) -> None:
        """Add a moment of a moving foot; call it when `due` has come."""
        if self.t_heel_off is None:
            return
        self.due = t + SPACING
        if self.infilled > 0.0:
            return
        rows = self.rows
        if not rows:
            self.origin = position
        elif len(rows) >= MOST_MOMENTS:
            self.rows = []
            self.t_heel_off = None
            return
        try:
            x, y, z = position
            ox, oy, oz = self.origin
            values = (t - self.t_heel_off, *attitude, *velocity, x - ox, y - oy, z - oz, *gyro, hypot(*acc))
            row: MomentRow = SINGLES.unpack(SINGLES.pack(*values))  # OverflowError beyond 3e38: not a stride
            rows.append(row)
        except OverflowError:
            self.rows = []
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

        `turn` (rad) and `displacement` (m) are measured from foot-flat to foot-flat. `interval`, s, is the usual
        interval between samples: if it is long, every stride consists of gaps to one half. The repair moves the end of
        a stride with a gap towards the usual one, as far as this is likely."""
        straight_on = self.straight_on
        middle = straight_on.yaw + 0.5 * turn
        self._learn(t, toe_off, heel_strike, turn, turned(displacement, -middle))
        infilled, self.infilled = self.infilled, 0.0
        bridged, self.bridged = self.bridged, False
        duration = None if self.last_flat_at is None else t - self.last_flat_at
        self.last_flat_at = t
        self.rows = []
        self.t_heel_off = None
        self.flat_since = t
        sparse = interval if interval > DENSE else 0.0
        unsure = min(1.0, infilled / 0.3)
        yaw, repair = 0.0, None
        if toe_off is not None and infilled + sparse > 0.0:
            yaw = straight_on.repair(turn, unsure, sparse)
            x, y, z = turned(displacement, 0.5 * yaw)
            if self.last is not None:
                dx, dy, dz = sub(turned(self.last.displacement, middle + 0.5 * yaw), (x, y, z))
                k = share(dx * dx + dy * dy + dz * dz, GAP_DISTANCE * unsure, STRIDE_SIGMA, 3.0, 2)
                x, y, z = x + k * dx, y + k * dy, z + k * dz
            repair = StrideRepair(yaw, (x, y, z))
        if toe_off is not None and duration is not None and (infilled > 0.0 or bridged):
            repair = self._bounded(StrideRepair(0.0, displacement) if repair is None else repair, duration)
        straight_on.footfall(turn, yaw, unsure, sparse)
        return repair

    def _bounded(self, repair: StrideRepair, duration: float) -> StrideRepair:
        """Return the repair within what is possible for a stride of `duration` s."""
        if self.last is None:
            return repair
        # a gap without infill may hide the foot-flat between two strides, which then count as one
        k = max(1.0, min(2.0, duration / (self.last.duration + self.stance)))
        x, y, z = repair.displacement
        x, y, _ = limit_length((x, y, 0.0), k * ROOM * self.longest)
        return StrideRepair(repair.turn, (x, y, max(-k * HIGHEST, min(z, k * HIGHEST))))

    def _learn(
        self, t: float, toe_off: float | None, heel_strike: float | None, turn: float, displacement: Vec3
    ) -> None:
        """Store the stride that ends at `t` if it has no gap; `displacement` as in `RecordedStride`."""
        self.age = min(self.age + 1, 1000)
        if self.t_heel_off is None or toe_off is None or self.infilled > 0.0 or self.bridged:
            return
        if len(self.rows) < FEWEST_MOMENTS:
            return
        if correction_distance(self.rows) > LARGEST_DRIFT:
            return
        self.longest = max(0.95 * self.longest, hypot(displacement[0], displacement[1]))
        # a stride round a corner is not a template, unless no other stride comes for long
        if abs(turn) < CORNER or self.age > OLD:
            t_heel_strike = t if heel_strike is None else heel_strike
            # rounded like the moments, because these times may be equal to that of a moment
            self.last = RecordedStride(
                self.rows, single(toe_off - self.t_heel_off), single(t_heel_strike - self.t_heel_off), displacement
            )
            self.age = 0
