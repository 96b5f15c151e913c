"""What a foot is used to doing, for when nobody saw what it did.

Walking repeats itself: of the same wearer, the same part of two neighbouring strides differs by a few per cent, where a
straight line over half a second of a swing is off by a right angle. So the last stride that was seen whole is kept, and
a gap in a later one is filled with the same part of it. Which part that is, is told by how long the foot had been
moving before the gap and by what it does after it; what turned otherwise than then, before and after, turned otherwise
in between. Likewise people walk straight on most of the time: when a foot comes down after a gap about as it stood
before, it was the gap that turned it ("heuristic drift elimination": Borenstein, Ojeda, Kwanmuang, J. Navigation 62,
2009), and then its heading errs by what one footfall differs from the next, however many gaps there are.
"""

from __future__ import annotations

from math import exp, hypot, pi
from typing import NamedTuple

from attrs import define, field

from ..types import Quat, Vec3
from ..vector import GRAVITY, ZERO, conjugate, from_yaw, multiply, normalise, rotate, sub
from .moment import Moment, at, length, turned
from .turn import heading_turned


class Leap(NamedTuple):
    """Where the foot is after a gap, and what it went through in it."""

    attitude: Quat
    velocity: Vec3
    position: Vec3
    lifted: float
    """When the heel rose, s."""
    cleared: float | None
    """When the toe left the ground and when the heel struck it, if that had happened by now, s."""
    struck: float | None
    landed: float | None
    """When the foot was flat again, if it was, s."""


class Mended(NamedTuple):
    """What a stride with a gap in it most likely was."""

    turn: float
    """To add to the heading, rad."""
    way: Vec3
    """From foot-flat to foot-flat, m."""


STOOD = "stood"
UP = (0.0, 0.0, 1.0)


@define
class Habit:
    """The last stride that was seen whole, from the heel's rise to foot-flat, and the heading kept since.

    At most `most` moments of two strides are kept. Costs nothing but a comparison between moments, `spacing` s apart.
    """

    spacing: float = 0.032
    """Between the moments that are kept, s."""
    most: int = 40
    shortest: float = 0.06
    """Gaps shorter than this are bridged by a straight line, s."""
    reach: float = 0.12
    """So far ahead or behind of the last stride a later one may be, s; and how far it is as a rule:"""
    usual: float = 0.03
    rate_sigma: float = 1.0
    """What the same moment of two strides differs by, rad/s and m/s^2."""
    force_sigma: float = 4.0
    tilt_sigma: float = 0.1
    """The same of where up is, as a unit vector in the sensor frame, and of the speed, m/s."""
    speed_sigma: float = 0.3
    persistence: float = 0.5
    """How much of what the velocity was off before a gap it still is after it."""
    straight_sigma: float = 0.025
    """What the heading of one footfall differs by from those before, of who walks straight on, rad."""
    straight: float = 0.8
    """Share of strides that go straight on; the others turn by anything up to a right angle."""
    memory: float = 0.3
    """Weight of the newest footfall in the heading that is kept."""
    bend: float = 0.12
    """A footfall turned further than this begins another heading, rad."""
    gap_turn: float = 0.08
    """What a stride's heading errs by after a third of a second by habit, rad."""
    gap_way: float = 0.15
    """The same of where it ends, m, and what two strides differ by:"""
    way_sigma: float = 0.06
    dense: float = 0.03
    """Samples less apart than this follow a swing as it is, s."""
    corner: float = 0.2
    """A stride that turns further than this is not kept, rad, unless what was kept is `old` strides old."""
    old: int = 20
    # state
    age: int = field(default=1000, init=False)
    """Strides since `last`."""
    last: list[Moment] = field(factory=list, init=False)
    now: list[Moment] = field(factory=list, init=False)
    toe_off: float = field(default=0.0, init=False)
    """In the last whole stride, s after the heel's rise."""
    heel_strike: float = field(default=0.0, init=False)
    stance: float = field(default=0.0, init=False)
    """How long the foot was flat before it, s."""
    stood_since: float | None = field(default=None, init=False)
    """When the foot was last flat, s; None before the first step."""
    lifted: float | None = field(default=None, init=False)
    """When the heel rose, s; None while the foot stands."""
    due: float = field(default=0.0, init=False)
    """When the next moment is kept, s."""
    guessed: float = field(default=0.0, init=False)
    """Of the movement since the heel's rise, how long was not seen, s."""
    way: Vec3 = field(default=ZERO, init=False)
    """From foot-flat to foot-flat, m; x along the mean of both headings."""
    yaw: float = field(default=0.0, init=False)
    """Heading of the newest footfall against the first, rad."""
    heading: float = field(default=0.0, init=False)
    """Of the newest footfall against the heading that is kept, rad."""
    footfalls: int = field(default=0, init=False)
    """So many in this heading, up to 3."""

    def lift(self, t: float) -> None:
        """The heel rises."""
        if self.stood_since is not None and self.guessed == 0.0:
            self.stance = t - self.stood_since
        self.lifted = self.due = t
        self.now = []

    def interrupt(self) -> None:
        """Nobody knows what the foot does now."""
        self.lifted = self.stood_since = None
        self.now = []
        self.footfalls = 0

    def keep(self, t: float, attitude: Quat, velocity: Vec3, position: Vec3, acc: Vec3, gyro: Vec3) -> None:
        """A moment of a moving foot; call when `due` has come."""
        if self.lifted is None:
            return
        self.due = t + self.spacing
        if self.guessed > 0.0:
            return
        if len(self.now) >= self.most:
            self.now = []
            self.lifted = None
            return
        x, y, z = acc
        self.now.append(Moment(t - self.lifted, attitude, velocity, position, gyro, hypot(x, y, z)))

    def flat(
        self, t: float, toe_off: float | None, heel_strike: float | None, turn: float, way: Vec3, interval: float
    ) -> Mended | None:
        """The foot is flat again, turned by `turn` (rad) and `way` (m) off since it was so last.

        `interval`, s, is the usual one between samples: where few make a swing, every stride is half gaps.
        What a gap has spoilt of that is mended by what is usual, as far as it is likely to be so this time.
        """
        guessed, lifted = self.guessed, self.lifted
        middle = self.yaw + 0.5 * turn
        self.age = min(self.age + 1, 1000)
        # a stride round a corner is no habit, unless no other comes for long
        habitual = abs(turn) < self.corner or self.age > self.old
        if lifted is not None and toe_off is not None and guessed == 0.0 and len(self.now) >= 4 and habitual:
            self.last, self.age = self.now, 0
            self.toe_off = toe_off - lifted
            self.heel_strike = (heel_strike if heel_strike is not None else t) - lifted
            self.way = turned(way, -middle)
        self.now = []
        self.lifted = None
        self.stood_since = t
        self.guessed = 0.0
        off, mended = self.heading + turn, None
        between = interval if interval > self.dense else 0.0
        if guessed + between > 0.0 and toe_off is not None:
            unsure = min(1.0, guessed / 0.3)
            yaw = 0.0
            if self.footfalls >= 3:
                doubt = self.gap_turn * min(2.0, unsure + between / 0.05)
                yaw = -off * _share(off * off, doubt, self.straight_sigma, self.straight, pi, 1)
            off += yaw
            turn += yaw
            x, y, z = turned(way, 0.5 * yaw)
            dx, dy, dz = sub(turned(self.way, middle + 0.5 * yaw), (x, y, z))
            k = _share(dx * dx + dy * dy + dz * dz, self.gap_way * unsure, self.way_sigma, self.straight, 3.0, 2)
            mended = Mended(yaw, (x + k * dx, y + k * dy, z + k * dz))
        self.yaw = (self.yaw + turn + pi) % (2.0 * pi) - pi
        if abs(off) > self.bend * (1.0 + between / 0.1):
            self.heading, self.footfalls = 0.0, 1
        else:
            self.heading = off * (1.0 - self.memory)
            self.footfalls = min(self.footfalls + 1, 3)
        return mended

    # --- gaps ---

    def leap(
        self,
        a: float,
        b: float,
        acc: Vec3,
        gyro: Vec3,
        rate: Vec3 | None,
        attitude: Quat,
        velocity: Vec3,
        position: Vec3,
    ) -> Leap | str | None:
        """What the foot did from `a` to `b`, s. `acc` and `gyro` are those at `b`, `rate` that at `a`, without bias;
        the pose is that at `a`. STOOD when it stood all the time; None when there is nothing to go by."""
        last = self.last
        x, y, z = acc
        force = hypot(x, y, z)
        x, y, z = gyro
        still = (x * x + y * y + z * z) / 0.25 + (force - GRAVITY) ** 2 / 2.0
        if not last:
            return STOOD if self.lifted is None and still < 8.0 else None
        whole = last[-1].since
        if self.lifted is None:
            start, usual, most = 0.0, 2.0 * self.reach / 3.0, b - a
            # by cadence the heel rose then; who stands longer has halted
            expected = b - a if self.stood_since is None else b - self.stood_since - self.stance
            best = still + min(12.0, max(0.0, expected / usual) ** 2)
        else:
            start = a - self.lifted
            if rate is not None:
                start = self._like(rate, attitude, velocity, start)
            usual, expected, best = self.usual, start + b - a, 1e12
            most = expected + self.reach
        end: Moment | None = None
        for moment in last:
            if moment.since > most:
                break
            if self.lifted is not None and moment.since < expected - self.reach:
                continue
            x, y, z = sub(gyro, moment.rate)
            far = (x * x + y * y + z * z) / self.rate_sigma**2 + ((force - moment.force) / self.force_sigma) ** 2
            far += ((moment.since - expected) / usual) ** 2
            if far < best:
                best, end = far, moment
        if most >= whole:
            early = max(0.0, whole - expected)
            if still + (early / usual) ** 2 < best or (self.lifted is not None and expected > whole + self.reach):
                end = last[-1]
        if end is None:
            return STOOD if self.lifted is None and best < 20.0 else None
        return self._to(start, end, a, b, gyro, rate, attitude, velocity, position)

    def _like(self, rate: Vec3, attitude: Quat, velocity: Vec3, since: float) -> float:
        """The moment of the last stride, near `since` s after the heel's rise, at which the foot was most like this."""
        best, found = 1e12, since
        up, fast = rotate(conjugate(attitude), UP), length(velocity)
        for moment in self.last:
            if abs(moment.since - since) < self.reach:
                x, y, z = sub(rate, moment.rate)
                far = (x * x + y * y + z * z) / self.rate_sigma**2 + ((moment.since - since) / self.usual) ** 2
                x, y, z = sub(up, rotate(conjugate(moment.attitude), UP))
                far += (x * x + y * y + z * z) / self.tilt_sigma**2
                far += ((fast - length(moment.velocity)) / self.speed_sigma) ** 2
                if far < best:
                    best, found = far, moment.since
        return found

    def _to(
        self,
        start: float,
        end: Moment,
        a: float,
        b: float,
        gyro: Vec3,
        rate: Vec3 | None,
        attitude: Quat,
        velocity: Vec3,
        position: Vec3,
    ) -> Leap:
        first = at(self.last, start)
        landed = end is self.last[-1]
        dt = max(end.since - first.since, 1e-6)
        # tilt as it was then, for where the foot is on its way tells it better than what the last sample does; heading
        # as it is now
        yaw = heading_turned(first.attitude, attitude)
        now = multiply(from_yaw(yaw), end.attitude)
        if rate is not None:
            # what it turned otherwise than in the last stride before the gap and after it, it did in between
            before = rotate(attitude, sub(rate, first.rate))[2] if self.lifted is not None else 0.0
            after = 0.0 if landed else rotate(now, sub(gyro, end.rate))[2]
            now = multiply(from_yaw(0.5 * min(dt, b - a) * (before + after)), now)
        now = normalise(now)
        ux, uy, uz = turned(end.velocity, yaw)
        ex, ey, ez = sub(velocity, turned(first.velocity, yaw))
        k = self.persistence
        speed = ZERO if landed else (ux + k * ex, uy + k * ey, uz + k * ez)
        k *= 0.5 * dt
        px, py, pz = turned(sub(end.position, first.position), yaw)
        x, y, z = position
        here = (x + px + k * ex, y + py + k * ey, z + pz + k * ez)
        if not landed:
            lifted = b - end.since
        elif self.lifted is not None:
            lifted = min(a - start, b - end.since)
        else:
            lifted = b - end.since if self.stood_since is None else self.stood_since + self.stance
            lifted = max(a, min(lifted, b - end.since))
        self.guessed += dt
        self.lifted = self.due = lifted
        cleared = lifted + self.toe_off if end.since >= self.toe_off else None
        struck = lifted + self.heel_strike if end.since >= self.heel_strike else None
        return Leap(now, speed, here, lifted, cleared, struck, lifted + end.since if landed else None)


def _share(square: float, unsure: float, sigma: float, usual: float, room: float, dimensions: int) -> float:
    """How much of a difference to what is usual (its square is given) to take back: what a Kalman update would, times
    how likely it is that things were as usual and did not go anywhere within `room`."""
    spread = unsure * unsure + sigma * sigma
    likely = usual * exp(-0.5 * square / spread) / float((2.0 * pi * spread) ** (0.5 * dimensions))
    return likely / (likely + (1.0 - usual) / room) * unsure * unsure / spread
