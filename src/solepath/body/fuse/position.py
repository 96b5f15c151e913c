"""Where the wearer is, of both feet.

While both feet are heard that is their mean. A foot that falls silent would hold the mean back by half of the way, so
it is left out; the other goes on from where the mean was, for the feet's tracks may have drifted apart. What an absent
foot did is not known when it comes back, nor which way it turned: it stays out until both have taken `STRIDES` strides
together, and is then turned and set beside the other. A foot that is first heard while the other walks is set beside it
as well. Without absence nothing is turned or set.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import atan2, cos, hypot, sin
from typing import ClassVar, Final

from ...foot.view import FootPose, FootView
from ...types import Foot, Site, Vec3
from ...types.attrs import define, field
from ...types.vector import ZERO, sub, turned
from ..part import PartOutput, Position, TrackPart

LEFT: Final = Foot.LEFT
"""Looked up once: a word of an enum costs as much as five multiplications."""

ABSENT = 1.0
"""A foot that was last heard this long before the other is absent, s."""
STRIDES = 3
"""So many strides of both feet say how a foot that came back stands to the other."""
LEAST_WAY = 1.0
"""and must lead this far, m."""


@define
class PlacedTrack:
    """How one foot's own track lies among both: turned by `turn` rad and then moved by `offset` m."""

    t: float | None = None
    """Its newest sample with acc and gyro, s."""
    began: float | None = None
    """The first one, s."""
    alone: float = 0.0
    """The other foot was heard for this long since then, s."""
    here: Vec3 = ZERO
    """Where its own track had it then, m."""
    turn: float = 0.0
    offset: Vec3 = ZERO
    variance: tuple[float, float] | None = None
    """Of its own track after its newest step, horizontal (an axis) and vertical, m^2; None before any step."""
    spread: tuple[float, float] = (0.0, 0.0)
    """What setting it beside the other has added to that, m^2."""
    beside: Vec3 | None = None
    """The left foot less the right one after this one's newest step, m; a mean over both feet's steps has the stride
    between them no more."""
    waits: bool = False
    """It has come back, and is not set beside the other yet."""

    @property
    def absent(self) -> bool:
        """Long not heard while the other was."""
        return self.alone >= ABSENT

    def place(self, own: Vec3) -> Vec3:
        """A place on its own track, among both feet, m."""
        x, y, z = own
        if self.turn:
            c, s = cos(self.turn), sin(self.turn)
            x, y = c * x - s * y, s * x + c * y
        dx, dy, dz = self.offset
        return (x + dx, y + dy, z + dz)

    def correct(self, at: Vec3, yaw: float, dx: float, dy: float) -> None:
        """Turn its track by `yaw` rad about the place `at` on it, m, and move it by (dx, dy) m, among both feet."""
        x, y, _ = at
        ox, oy, oz = self.offset
        c, s = cos(self.turn), sin(self.turn)
        before_x, before_y = c * x - s * y + ox, s * x + c * y + oy
        self.turn += yaw
        c, s = cos(self.turn), sin(self.turn)
        self.offset = (ox + before_x + dx - (c * x - s * y + ox), oy + before_y + dy - (s * x + c * y + oy), oz)

    def undone(self, place: Vec3) -> Vec3:
        """Where its own track has a place among both feet, m."""
        x, y, z = place
        dx, dy, dz = self.offset
        c, s = cos(-self.turn), sin(-self.turn)
        return (c * (x - dx) - s * (y - dy), s * (x - dx) + c * (y - dy), z - dz)


@define
class MeanOfFeet(TrackPart):
    """The mean of the feet that are heard, each in the world frame of its own first heading.

    Of feet that were set beside one another the covariance is that of the one which was heard all along: the errors
    that they had by then are the same.
    """

    needs_samples: ClassVar[bool] = True

    left: PlacedTrack = field(factory=PlacedTrack, init=False)
    right: PlacedTrack = field(factory=PlacedTrack, init=False)
    newest: Foot | None = field(default=None, init=False)
    """The foot that was set beside the other last."""
    steps: list[tuple[bool, Vec3, Vec3]] = field(factory=list, init=False)
    """While a foot waits, after the newest steps of both: whether the left one took it, where the waiting foot's own
    track has it, and where the other is."""

    def feed(self, view: FootView) -> Sequence[PartOutput]:
        """Nothing follows, but it is seen who is absent and who has come back."""
        t, is_left = view.t, view.foot is LEFT
        if view.sample.acc is None or view.sample.gyro is None:
            return ()
        this, other = (self.left, self.right) if is_left else (self.right, self.left)
        back = False
        if this.t is None:
            this.began = t
            # at the start they stand side by side; a foot that comes while the other walks does not
            back = other.began is not None and t - other.began >= ABSENT and other.variance is not None
        elif t - this.t >= ABSENT:
            back = this.absent
        elif t > this.t and other.t is not None:
            other.alone += t - this.t
        here = view.position
        if view.north is not None:
            (c, s), (x, y, z) = view.north, here
            here = (c * x - s * y, s * x + c * y, z)
        this.t, this.alone, this.here = t, 0.0, here
        if back:
            self._came_back(this, other)
        covariance = view.after.covariance
        if covariance is not None:  # there was a stride
            xx, _, _, yy, _, zz = covariance
            this.variance = (0.5 * (xx + yy), zz)
            if other.t is not None and other.alone < ABSENT:
                self._stepped(is_left, this)
        return ()

    def reset(self, site: Site) -> None:
        """Times of the foot restart, and it is as if it were heard for the first time."""
        if site.foot is not None:
            placed = self._placed(site.foot)
            placed.t, placed.alone = None, 0.0

    def position(self, feet: Mapping[Foot, FootPose]) -> Position | None:
        """None before any sample."""
        known = list(feet.values())
        if not known:
            return None
        heard = self._heard(known)
        k = 1.0 / len(heard)
        places = [self._place(foot) for foot in heard]
        x, y, z = (sum([place[axis] for place in places]) * k for axis in range(3))
        if len(heard) == 1:
            dx, dy, dz = self._lean(heard[0].foot)
            x, y, z = x + dx, y + dy, z + dz
        elif self.newest is not None:
            heard = [foot for foot in heard if foot.foot is not self.newest]
            k = 1.0 / len(heard)
        covariances = [foot.covariance for foot in heard]
        xx, xy, xz, yy, yz, zz = (sum([c[i] for c in covariances]) * k * k for i in range(6))
        if len(heard) == 1:
            across, up = self._placed(heard[0].foot).spread
            xx, yy, zz = xx + across, yy + across, zz + up
        t = max([foot.t for foot in known])
        return Position(t, (x, y, z), (xx, xy, xz, yy, yz, zz))

    def _heard(self, known: list[FootPose]) -> list[FootPose]:
        """Of two feet those that have a track, are not absent and do not wait; never none."""
        moving = [foot for foot in known if foot.moved_at is not None]
        if len(moving) < 2:
            return moving or known
        newest = max([foot.moved_at for foot in moving if foot.moved_at is not None])
        # by both: samples of one foot may be fed long after the other's of the same time
        there = [
            foot
            for foot in moving
            if not (self._placed(foot.foot).absent and foot.moved_at is not None and newest - foot.moved_at >= ABSENT)
        ]
        return [foot for foot in there if not self._placed(foot.foot).waits] or there or moving

    def _placed(self, foot: Foot) -> PlacedTrack:
        return self.left if foot is LEFT else self.right

    def _place(self, foot: FootPose) -> Vec3:
        return self._placed(foot.foot).place(foot.position)

    def _lean(self, foot: Foot) -> Vec3:
        """From this foot alone to the mean of both, as they lay to one another when they last walked together, m."""
        one, two = self.left.beside, self.right.beside
        if one is None or two is None:
            return ZERO
        k = -0.25 if foot is LEFT else 0.25
        return (k * (one[0] + two[0]), k * (one[1] + two[1]), k * (one[2] + two[2]))

    def _came_back(self, this: PlacedTrack, other: PlacedTrack) -> None:
        """It waits. Should the other fall silent meanwhile, it goes on from where that one is now."""
        lx, ly, lz = self._lean(LEFT if other is self.left else Foot.RIGHT)
        x, y, z = other.offset
        other.offset = (x + lx, y + ly, z + lz)
        self.left.beside = self.right.beside = None
        this.offset = sub(other.place(other.here), turned(this.here, this.turn))
        self._doubt(this, other)
        this.waits, other.waits = True, False
        self.steps = []

    def _stepped(self, is_left: bool, this: PlacedTrack) -> None:
        """A foot has taken a step, and both are heard."""
        left, right = self.left, self.right
        if not left.waits and not right.waits:
            this.beside = sub(left.place(left.here), right.place(right.here))
            return
        waiting, other = (left, right) if left.waits else (right, left)
        self.steps = [*self.steps[-2 * STRIDES - 1 :], (is_left, waiting.here, other.place(other.here))]
        lefts = [(own, beside) for was_left, own, beside in self.steps if was_left]
        rights = [(own, beside) for was_left, own, beside in self.steps if not was_left]
        if len(lefts) <= STRIDES or len(rights) <= STRIDES:
            return
        own_x, own_y, _ = _way(lefts[0][0], lefts[-1][0], rights[0][0], rights[-1][0])
        x, y, _ = _way(lefts[0][1], lefts[-1][1], rights[0][1], rights[-1][1])
        if min(hypot(own_x, own_y), hypot(x, y)) < LEAST_WAY:
            return
        waiting.turn = atan2(own_x * y - own_y * x, own_x * x + own_y * y)
        stood = _mean([turned(own, waiting.turn) for own, _ in (*lefts, *rights)])
        waiting.offset = sub(_mean([beside for _, beside in (*lefts, *rights)]), stood)
        self._doubt(waiting, other)
        waiting.waits = False
        self.newest = LEFT if waiting is left else Foot.RIGHT
        self.steps = []

    @staticmethod
    def _doubt(this: PlacedTrack, other: PlacedTrack) -> None:
        """What its place is uncertain by from now on: as the other's is."""
        across, up = other.variance or (0.0, 0.0)
        own_across, own_up = this.variance or (0.0, 0.0)
        more, higher = other.spread
        this.spread = (max(0.0, across + more - own_across), max(0.0, up + higher - own_up))


def _way(begin: Vec3, end: Vec3, other_begin: Vec3, other_end: Vec3) -> Vec3:
    """The mean of two ways, m."""
    return _mean([sub(end, begin), sub(other_end, other_begin)])


def _mean(vectors: list[Vec3]) -> Vec3:
    k = 1.0 / len(vectors)
    x, y, z = (sum([v[axis] for v in vectors]) * k for axis in range(3))
    return (x, y, z)
