"""What a foot is used to doing: the last stride that was seen whole, for when nobody saw what it did (gap.py).

Walking repeats itself: of the same wearer, the same part of two neighbouring strides differs by a few per cent, where a
straight line over half a second of a swing is off by a right angle. Where the foot comes down after a gap is mended in
the same way: it goes about as far as in the last stride, and straight on (straight.py).
"""

from __future__ import annotations

from math import hypot
from typing import NamedTuple

from ...types import Quat, Vec3
from ...types.attrs import define, field
from ...types.vector import ZERO, single, sub, turned
from .moment import SINGLES, MomentRow, RecordedStride, correction_distance, limit_length
from .straight import StraightOn, share


class StrideRepair(NamedTuple):
    """What a stride with a gap in it most likely was."""

    turn: float
    """To add to the heading, rad."""
    displacement: Vec3
    """From foot-flat to foot-flat, m."""


SPACING = 0.032
"""Between the moments that are kept, s."""
FEWEST_MOMENTS, MOST_MOMENTS = 4, 40
"""Fewer moments make no stride, and more of one are not kept."""
GAP_DISTANCE, STRIDE_SIGMA = 0.15, 0.06
"""What the end of a stride errs by after a third of a second by habit, and what two strides differ by, m."""
DENSE = 0.03
"""Samples less apart than this follow a swing as it is, s."""
CORNER, OLD = 0.2, 20
"""A stride that turns further than this, rad, is not kept, unless what was kept is so many strides old."""
LARGEST_DRIFT = 0.4
"""A stride that zero velocity moved further than this when the foot came down was not followed well, m."""
ROOM, HIGHEST = 1.2, 0.4
"""A stride with a gap in it is no longer than so many times the longest that was seen lately, and no higher than two
steps of stairs, m."""


@define
class StrideTemplate:
    """The last stride that was seen whole, from the heel's rise to foot-flat, and the heading kept since.

    Costs nothing but a comparison between the moments that are kept, MOST_MOMENTS of two strides.
    """

    last: RecordedStride | None = field(default=None, init=False)
    age: int = field(default=1000, init=False)
    """Strides since `last`."""
    rows: list[MomentRow] = field(factory=list, init=False)
    """Moments of the stride under way."""
    origin: Vec3 = field(default=ZERO, init=False)
    """Where the first of them was; their positions are from here, m."""
    stance: float = field(default=0.0, init=False)
    """How long the foot was flat before it last rose, s."""
    flat_since: float | None = field(default=None, init=False)
    """When the foot was last flat, s; None before the first step."""
    t_heel_off: float | None = field(default=None, init=False)
    """When the heel rose, s; None while the foot stands."""
    due: float = field(default=0.0, init=False)
    """When the next moment is kept, s."""
    infilled: float = field(default=0.0, init=False)
    """Of the movement since the heel's rise, how long was not seen, s."""
    bridged: bool = field(default=False, init=False)
    """A gap in this stride was bridged by a straight line."""
    last_flat_at: float | None = field(default=None, init=False)
    """When the last stride ended, whatever came since, s."""
    longest: float = field(default=0.0, init=False)
    """Of the strides seen whole lately, m."""
    straight_on: StraightOn = field(factory=StraightOn, init=False)

    def start_stride(self, t: float) -> None:
        """The heel rises."""
        if self.flat_since is not None and self.infilled == 0.0:
            self.stance = t - self.flat_since
        self.t_heel_off = self.due = t
        self.rows = []

    def add_infill(self, t_heel_off: float, duration: float) -> None:
        """The heel rose at `t_heel_off`, s, and for `duration` of the stride since, s, the last one stands in."""
        self.infilled += duration
        self.t_heel_off = self.due = t_heel_off

    def mark_bridged(self) -> None:
        """A gap was bridged by a straight line."""
        self.bridged = True

    def reset(self) -> None:
        """Nobody knows what the foot does now."""
        self.t_heel_off = self.flat_since = None
        self.rows = []
        self.straight_on.footfalls = 0

    def add_moment(self, t: float, attitude: Quat, velocity: Vec3, position: Vec3, acc: Vec3, gyro: Vec3) -> None:
        """A moment of a moving foot; call when `due` has come."""
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
            row: MomentRow = SINGLES.unpack(SINGLES.pack(*values))  # OverflowError beyond 3e38: this is no stride
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
        """The foot is flat again, turned by `turn` (rad) and `displacement` (m) off since it was so last.

        `interval`, s, is the usual one between samples: where few make a swing, every stride is half gaps.
        What a gap has spoilt of that is mended by what is usual, as far as it is likely to be so this time.
        """
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
        """Within what is possible for a stride that took so long, s."""
        if self.last is None:
            return repair
        # two strides are one when a gap that was not filled hid the foot-flat between them
        k = max(1.0, min(2.0, duration / (self.last.duration + self.stance)))
        x, y, z = repair.displacement
        x, y, _ = limit_length((x, y, 0.0), k * ROOM * self.longest)
        return StrideRepair(repair.turn, (x, y, max(-k * HIGHEST, min(z, k * HIGHEST))))

    def _learn(
        self, t: float, toe_off: float | None, heel_strike: float | None, turn: float, displacement: Vec3
    ) -> None:
        """Keep the stride that ends at `t` if it was seen whole; `displacement` as in `RecordedStride`."""
        self.age = min(self.age + 1, 1000)
        if self.t_heel_off is None or toe_off is None or self.infilled > 0.0 or self.bridged:
            return
        if len(self.rows) < FEWEST_MOMENTS:
            return
        if correction_distance(self.rows) > LARGEST_DRIFT:
            return
        self.longest = max(0.95 * self.longest, hypot(displacement[0], displacement[1]))
        # a stride round a corner is no habit, unless no other comes for long
        if abs(turn) < CORNER or self.age > OLD:
            t_heel_strike = t if heel_strike is None else heel_strike
            # rounded as the moments are, at one of which they may have been
            self.last = RecordedStride(
                self.rows, single(toe_off - self.t_heel_off), single(t_heel_strike - self.t_heel_off), displacement
            )
            self.age = 0
