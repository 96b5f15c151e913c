"""Where both feet are, each seen from the other: P_L and P_R, V_change, and the first heading (walking-modes).

After Gong et al. 2023 (Sensors 23, 5417), equations (1) to (3). P_L and P_R are the ends of the chain of seven
attitudes (limbs.py) while it knows them, else the feet's own inertial tracks, set apart as they stood at the start; of
a foot that was not heard for a while, as they go on together once it is heard again (`MeanOfFeet`).

The chain has the ends of the feet, a touchdown is a place below an ankle; what lies between them is `FootPlace.reach`.
"""

from __future__ import annotations

from math import atan2, cos, hypot, pi, sin

from ...body.fuse.position import MeanOfFeet, PlacedTrack
from ...foot.view import FootView
from ...types import OTHER, Foot, Vec3
from ...types.attrs import define, field
from ...types.vector import ZERO, sub
from .limbs.limbs import LowerLimbs
from .mode import LEAST_STEP
from .settings import ModesSettings
from .touchdown import suspended, v_change

FIRST_WAY = 1.5
"""So far the middle between the feet must go to tell the first heading for good, m."""


@define
class FootPlace:
    """Where one foot is."""

    place: Vec3 = ZERO
    """Where it last came down: the ground below its ankle (by the chain) or its sensor (by its track), world, m."""
    offset: Vec3 = ZERO
    """From its track to its place, m."""
    reach: tuple[float, float] = (0.0, 0.0)
    """From below its ankle to its end when it came down, world, m."""
    track: Vec3 = ZERO
    """Its own inertial track, m; of a foot that came back, as it lies beside the other's."""
    direction: tuple[float, float] = (1.0, 0.0)
    """Of walking when it last came down, of length 1."""

    @property
    def own(self) -> Vec3:
        """Where it is now by its own track alone, m."""
        return suspended(self.track, self.offset)

    @property
    def gone(self) -> float:
        """How far it is from where it last came down, by its own track, m."""
        x, y, _ = sub(self.own, self.place)
        return hypot(x, y)


@define
class FootPlaces:
    """Both feet and the chain between them."""

    settings: ModesSettings
    chain: LowerLimbs = field(init=False)
    sides: dict[Foot, FootPlace] = field(init=False)
    headed: bool = field(init=False)
    """The first heading is settled."""
    tracks: MeanOfFeet = field(factory=MeanOfFeet, init=False)
    """Sets a foot that was not heard for a while beside the other."""

    def __attrs_post_init__(self) -> None:
        settings = self.settings
        self.chain = LowerLimbs(settings)
        self.headed = settings.heading is not None
        self.sides = {}
        for foot, sign in ((Foot.LEFT, 0.5), (Foot.RIGHT, -0.5)):
            place = (0.0, sign * settings.apart, 0.0)
            self.sides[foot] = FootPlace(place, place, (settings.limbs.foot, 0.0))

    def moved(self, view: FootView) -> None:
        """A sample of a foot: where its own track has it."""
        left, right = self.tracks.left, self.tracks.right
        was_left, was_right, waited = left.offset, right.offset, (left.unplaced, right.unplaced)
        self.tracks.feed(view)
        if left.offset is not was_left:
            self._shifted(Foot.LEFT, left, was_left, waited[0])
        if right.offset is not was_right:
            self._shifted(Foot.RIGHT, right, was_right, waited[1])
        if view.levelled:
            placed = left if view.foot is Foot.LEFT else right
            self.sides[view.foot].track = placed.place(placed.newest_place)

    def _shifted(self, foot: Foot, placed: PlacedTrack, offset: Vec3, waited: bool) -> None:
        """Its track lies elsewhere among both than with `offset` before."""
        side, other = self.sides[foot], self.sides[OTHER[foot]]
        if waited and not placed.unplaced:  # it is known there again, and they walk as far apart as they stood
            side.track = placed.place(placed.newest_place)
            x, y = self._apart(foot, other)
            side.offset = suspended(other.offset, (x, y, 0.0))
            side.place = side.own
        else:  # in itself the foot is where it was
            shift = sub(placed.offset, offset)
            side.offset, side.track = sub(side.offset, shift), suspended(side.track, shift)

    def _apart(self, foot: Foot, other: FootPlace) -> tuple[float, float]:
        """From the other foot to this one when they stand side by side, facing as the other last went, m."""
        c, s = other.direction
        k = self.settings.apart if foot is Foot.LEFT else -self.settings.apart
        return -s * k, c * k

    def unheard(self, foot: Foot, t: float) -> bool:
        """The foot is absent, or its track is not known among both yet, and the chain does not tell either."""
        placed = self.tracks.left if foot is Foot.LEFT else self.tracks.right
        return (placed.absent or placed.unplaced) and not self.chain.current(t)

    def middle(self, foot: Foot) -> Vec3:
        """The middle between the feet as this foot alone has it, by its own track, m."""
        side = self.sides[foot]
        x, y, _ = side.own
        dx, dy = self._apart(OTHER[foot], side)
        return (x + 0.5 * dx, y + 0.5 * dy, side.track[2])

    def seen(self, foot: Foot, t: float) -> tuple[Vec3, bool]:
        """Where `foot` is, seen from the other, by (1) to (3): the ground below it; and whether the chain tells it. A
        foot that by its track went on since it came down is no place to see another from: then by the own track."""
        chained, carrying = self.chain.current(t), self.sides[OTHER[foot]]
        if not chained and carrying.gone > LEAST_STEP:
            x, y, _ = self.sides[foot].own
            return (x, y, self.sides[foot].track[2]), False
        left, right = (self.chain.end(one, t) if chained else side.own for one, side in self.sides.items())
        x, y, _ = suspended(carrying.place, v_change(left, right, OTHER[foot]))
        if chained:
            reach = self._reach(foot, t)
            x += carrying.reach[0] - reach[0]
            y += carrying.reach[1] - reach[1]
        return (x, y, self.sides[foot].track[2]), chained

    def facing(self, t: float) -> tuple[float, float]:
        """Where both feet point together, world, of length 1."""
        (lx, ly), (rx, ry) = self.chain.forward(Foot.LEFT, t), self.chain.forward(Foot.RIGHT, t)
        x, y = lx + rx, ly + ry
        length = hypot(x, y)
        return (x / length, y / length) if length > LEAST_STEP else (lx, ly)

    def swung(self, foot: Foot) -> Foot:
        """The foot whose own track has gone further: a method may take the wrong one for the one that came down."""
        other = OTHER[foot]
        (x, y, _), (u, v, _) = self.sides[foot].track, self.sides[other].track
        return other if hypot(u, v) > hypot(x, y) + LEAST_STEP else foot

    def put(self, foot: Foot, place: Vec3, chained: bool, t: float) -> None:
        """The foot came down at `place`, as the chain has it or not, at `t` s."""
        side = self.sides[foot]
        side.place = place
        if chained:
            side.reach = self._reach(foot, t)
        side.offset = sub(side.place, side.track)
        self._head(chained)

    def _reach(self, foot: Foot, t: float) -> tuple[float, float]:
        x, y = self.chain.forward(foot, t)
        return self.settings.limbs.foot * x, self.settings.limbs.foot * y

    def _head(self, chained: bool) -> None:
        """x along the first heading: until the wearer has gone `FIRST_WAY`, the world is turned so that the way so far
        lies along it. One footfall is half a foot's width to the left or right of where it might have been. The tracks'
        world has its x there."""
        if self.headed:
            return
        left, right = self.sides.values()
        x, y = left.place[0] + right.place[0], left.place[1] + right.place[1]
        if hypot(x, y) < LEAST_STEP:
            return
        self.headed = hypot(x, y) > 2.0 * FIRST_WAY
        if not chained or self.chain.facing is None:
            return
        turn = atan2(y, x)
        self.chain.turn = (self.chain.turn + turn + pi) % (2.0 * pi) - pi
        c, s = cos(turn), -sin(turn)
        for side in self.sides.values():
            (px, py, pz), (rx, ry), (dx, dy) = side.place, side.reach, side.direction
            side.place = (c * px - s * py, s * px + c * py, pz)
            side.offset = suspended(side.offset, sub(side.place, (px, py, pz)))
            side.reach = (c * rx - s * ry, s * rx + c * ry)
            side.direction = (c * dx - s * dy, s * dx + c * dy)
