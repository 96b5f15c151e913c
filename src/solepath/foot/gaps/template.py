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
from .moment import SINGLES, MomentRow, RecordedStride, corrected, limited
from .straight import StraightOn, share


class StrideRepair(NamedTuple):
    """What a stride with a gap in it most likely was."""

    turn: float
    """To add to the heading, rad."""
    way: Vec3
    """From foot-flat to foot-flat, m."""


SPACING = 0.032
"""Between the moments that are kept, s."""
FEWEST_MOMENTS, MOST_MOMENTS = 4, 40
"""Fewer moments make no stride, and more of one are not kept."""
GAP_WAY, WAY_SIGMA = 0.15, 0.06
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
    now: list[MomentRow] = field(factory=list, init=False)
    """Moments of the stride under way."""
    origin: Vec3 = field(default=ZERO, init=False)
    """Where the first of them was; their positions are from here, m."""
    stance: float = field(default=0.0, init=False)
    """How long the foot was flat before it last rose, s."""
    stood_since: float | None = field(default=None, init=False)
    """When the foot was last flat, s; None before the first step."""
    lifted: float | None = field(default=None, init=False)
    """When the heel rose, s; None while the foot stands."""
    due: float = field(default=0.0, init=False)
    """When the next moment is kept, s."""
    guessed: float = field(default=0.0, init=False)
    """Of the movement since the heel's rise, how long was not seen, s."""
    crossed: bool = field(default=False, init=False)
    """A gap in this stride was bridged by a straight line."""
    landed: float | None = field(default=None, init=False)
    """When the last stride ended, whatever came since, s."""
    longest: float = field(default=0.0, init=False)
    """Of the strides seen whole lately, m."""
    straight_on: StraightOn = field(factory=StraightOn, init=False)

    def lift(self, t: float) -> None:
        """The heel rises."""
        if self.stood_since is not None and self.guessed == 0.0:
            self.stance = t - self.stood_since
        self.lifted = self.due = t
        self.now = []

    def guess(self, lifted: float, duration: float) -> None:
        """The heel rose at `lifted`, s, and for `duration` of the stride since, s, the last one stands in."""
        self.guessed += duration
        self.lifted = self.due = lifted

    def cross(self) -> None:
        """A gap was bridged by a straight line."""
        self.crossed = True

    def reset(self) -> None:
        """Nobody knows what the foot does now."""
        self.lifted = self.stood_since = None
        self.now = []
        self.straight_on.footfalls = 0

    def keep(self, t: float, attitude: Quat, velocity: Vec3, position: Vec3, acc: Vec3, gyro: Vec3) -> None:
        """A moment of a moving foot; call when `due` has come."""
        if self.lifted is None:
            return
        self.due = t + SPACING
        if self.guessed > 0.0:
            return
        now = self.now
        if not now:
            self.origin = position
        elif len(now) >= MOST_MOMENTS:
            self.now = []
            self.lifted = None
            return
        try:
            x, y, z = position
            ox, oy, oz = self.origin
            values = (t - self.lifted, *attitude, *velocity, x - ox, y - oy, z - oz, *gyro, hypot(*acc))
            row: MomentRow = SINGLES.unpack(SINGLES.pack(*values))  # OverflowError beyond 3e38: this is no stride
            now.append(row)
        except OverflowError:
            self.now = []
            self.lifted = None

    def flat(
        self, t: float, toe_off: float | None, heel_strike: float | None, turn: float, way: Vec3, interval: float
    ) -> StrideRepair | None:
        """The foot is flat again, turned by `turn` (rad) and `way` (m) off since it was so last.

        `interval`, s, is the usual one between samples: where few make a swing, every stride is half gaps.
        What a gap has spoilt of that is mended by what is usual, as far as it is likely to be so this time.
        """
        straight_on = self.straight_on
        middle = straight_on.yaw + 0.5 * turn
        self._learn(t, toe_off, heel_strike, turn, turned(way, -middle))
        guessed, self.guessed = self.guessed, 0.0
        crossed, self.crossed = self.crossed, False
        lasted = None if self.landed is None else t - self.landed
        self.landed = t
        self.now = []
        self.lifted = None
        self.stood_since = t
        sparse = interval if interval > DENSE else 0.0
        unsure = min(1.0, guessed / 0.3)
        yaw, repair = 0.0, None
        if toe_off is not None and guessed + sparse > 0.0:
            yaw = straight_on.repair(turn, unsure, sparse)
            x, y, z = turned(way, 0.5 * yaw)
            if self.last is not None:
                dx, dy, dz = sub(turned(self.last.way, middle + 0.5 * yaw), (x, y, z))
                k = share(dx * dx + dy * dy + dz * dz, GAP_WAY * unsure, WAY_SIGMA, 3.0, 2)
                x, y, z = x + k * dx, y + k * dy, z + k * dz
            repair = StrideRepair(yaw, (x, y, z))
        if toe_off is not None and lasted is not None and (guessed > 0.0 or crossed):
            repair = self._bounded(StrideRepair(0.0, way) if repair is None else repair, lasted)
        straight_on.footfall(turn, yaw, unsure, sparse)
        return repair

    def _bounded(self, repair: StrideRepair, lasted: float) -> StrideRepair:
        """Within what is possible for a stride that took so long, s."""
        if self.last is None:
            return repair
        # two strides are one when a gap that was not filled hid the foot-flat between them
        k = max(1.0, min(2.0, lasted / (self.last.lasted + self.stance)))
        x, y, z = repair.way
        x, y, _ = limited((x, y, 0.0), k * ROOM * self.longest)
        return StrideRepair(repair.turn, (x, y, max(-k * HIGHEST, min(z, k * HIGHEST))))

    def _learn(self, t: float, toe_off: float | None, heel_strike: float | None, turn: float, way: Vec3) -> None:
        """Keep the stride that ends at `t` if it was seen whole; `way` as in `RecordedStride`."""
        self.age = min(self.age + 1, 1000)
        if self.lifted is None or toe_off is None or self.guessed > 0.0 or self.crossed:
            return
        if len(self.now) < FEWEST_MOMENTS:
            return
        if corrected(self.now) > LARGEST_DRIFT:
            return
        self.longest = max(0.95 * self.longest, hypot(way[0], way[1]))
        # a stride round a corner is no habit, unless no other comes for long
        if abs(turn) < CORNER or self.age > OLD:
            struck = t if heel_strike is None else heel_strike
            # rounded as the moments are, at one of which they may have been
            self.last = RecordedStride(self.now, single(toe_off - self.lifted), single(struck - self.lifted), way)
            self.age = 0
