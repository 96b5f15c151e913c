"""Places of both feet, each seen from the other: P_L and P_R, V_change, and the first heading (walking-modes).

After Gong et al. 2023 (Sensors 23, 5417), equations (1) to (3). P_L and P_R are the ends of the chain of seven
attitudes (limbs.py) while it knows them, else the feet's own inertial tracks, set apart as they stood at the start. A
foot that was silent for a while continues beside the other when it sends samples again (`MeanOfFeet`).

The chain has the ends of the feet, a touchdown is a place below an ankle; `FootPlace.reach` lies between them."""

from __future__ import annotations

from math import atan2, cos, hypot, pi, sin

from ...body.fuse.position import MeanOfFeet, PlacedTrack
from ...foot.view import FootView
from ...types import OTHER, Foot, Vec3
from ...types.attrs import define, field
from ...types.vector import ZERO, sub
from .limbs.limbs import LowerLimbs
from .mode import LEAST_STEP_LENGTH
from .settings import ModesSettings
from .touchdown import displace, v_change

FIRST_DISTANCE = 1.5
"""Distance of the middle between the feet from the start at which the first heading is final, m."""


@define
class FootPlace:
    """The place of one foot."""

    place: Vec3 = ZERO
    """Place of the last touchdown, world, m: the ground below the ankle (by the chain) or the sensor (by its track)."""
    offset: Vec3 = ZERO
    """Vector from its track to its place, m."""
    reach: tuple[float, float] = (0.0, 0.0)
    """Vector from below its ankle to its end when it came down, world, m."""
    track: Vec3 = ZERO
    """Position of its own inertial track, m; for a foot that came back, moved beside the other's."""
    direction: tuple[float, float] = (1.0, 0.0)
    """Direction of walking when it last came down, of length 1."""

    @property
    def own_position(self) -> Vec3:
        """Present position by its own track alone, m."""
        return displace(self.track, self.offset)

    @property
    def moved_distance(self) -> float:
        """Distance from its last touchdown, by its own track, m."""
        x, y, _ = sub(self.own_position, self.place)
        return hypot(x, y)


@define
class FootPlaces:
    """The places of both feet and the chain between them."""

    settings: ModesSettings
    chain: LowerLimbs = field(init=False)
    sides: dict[Foot, FootPlace] = field(init=False)
    heading_settled: bool = field(init=False)
    """Flag: the first heading is final."""
    tracks: MeanOfFeet = field(factory=MeanOfFeet, init=False)
    """Part that sets a foot that was silent for a while beside the other."""

    def __attrs_post_init__(self) -> None:
        settings = self.settings
        self.chain = LowerLimbs(settings)
        self.heading_settled = settings.heading is not None
        self.sides = {}
        for foot, sign in ((Foot.LEFT, 0.5), (Foot.RIGHT, -0.5)):
            place = (0.0, sign * settings.feet_distance, 0.0)
            self.sides[foot] = FootPlace(place, place, (settings.limbs.foot, 0.0))

    def add_view(self, view: FootView) -> None:
        """Add a sample of a foot: the position of its own track."""
        left, right = self.tracks.left, self.tracks.right
        left_offset, right_offset, were_unplaced = left.offset, right.offset, (left.unplaced, right.unplaced)
        self.tracks.feed(view)
        if left.offset is not left_offset:
            self._move_track(Foot.LEFT, left, left_offset, were_unplaced[0])
        if right.offset is not right_offset:
            self._move_track(Foot.RIGHT, right, right_offset, were_unplaced[1])
        if view.levelled:
            placed = left if view.foot is Foot.LEFT else right
            self.sides[view.foot].track = placed.place(placed.newest_place)

    def _move_track(self, foot: Foot, placed_track: PlacedTrack, offset: Vec3, was_unplaced: bool) -> None:
        """Move the track of a foot that now lies elsewhere among both than with `offset` before."""
        side, other = self.sides[foot], self.sides[OTHER[foot]]
        if was_unplaced and not placed_track.unplaced:  # known there again: as far apart as they stood
            side.track = placed_track.place(placed_track.newest_place)
            x, y = self._side_offset(foot, other)
            side.offset = displace(other.offset, (x, y, 0.0))
            side.place = side.own_position
        else:  # the foot itself has not moved
            shift = sub(placed_track.offset, offset)
            side.offset, side.track = sub(side.offset, shift), displace(side.track, shift)

    def _side_offset(self, foot: Foot, other: FootPlace) -> tuple[float, float]:
        """Return the vector from the other foot to this one when they stand side by side, m.

        They face the way that the other last went."""
        c, s = other.direction
        k = self.settings.feet_distance if foot is Foot.LEFT else -self.settings.feet_distance
        return -s * k, c * k

    def is_lost(self, foot: Foot, t: float) -> bool:
        """Return whether the foot is absent, or neither its track among both nor the chain is known."""
        placed = self.tracks.left if foot is Foot.LEFT else self.tracks.right
        return (placed.absent or placed.unplaced) and not self.chain.is_current(t)

    def middle(self, foot: Foot) -> Vec3:
        """Return the middle between the feet by this foot's own track alone, m."""
        side = self.sides[foot]
        x, y, _ = side.own_position
        dx, dy = self._side_offset(OTHER[foot], side)
        return (x + 0.5 * dx, y + 0.5 * dy, side.track[2])

    def locate(self, foot: Foot, t: float) -> tuple[Vec3, bool]:
        """Return the ground below `foot`, seen from the other foot by (1) to (3), and whether the chain was used.

        The own track is used where the other foot, by its track, has moved since it came down, and is no reference."""
        chained, reference = self.chain.is_current(t), self.sides[OTHER[foot]]
        if not chained and reference.moved_distance > LEAST_STEP_LENGTH:
            x, y, _ = self.sides[foot].own_position
            return (x, y, self.sides[foot].track[2]), False
        left, right = (self.chain.end(one, t) if chained else side.own_position for one, side in self.sides.items())
        x, y, _ = displace(reference.place, v_change(left, right, OTHER[foot]))
        if chained:
            reach = self._reach(foot, t)
            x += reference.reach[0] - reach[0]
            y += reference.reach[1] - reach[1]
        return (x, y, self.sides[foot].track[2]), chained

    def walking_direction(self, t: float) -> tuple[float, float]:
        """Return the common direction of both feet, world, of length 1."""
        (lx, ly), (rx, ry) = self.chain.forward(Foot.LEFT, t), self.chain.forward(Foot.RIGHT, t)
        x, y = lx + rx, ly + ry
        length = hypot(x, y)
        return (x / length, y / length) if length > LEAST_STEP_LENGTH else (lx, ly)

    def swing_foot(self, foot: Foot) -> Foot:
        """Return the foot whose own track has gone further: a method may take the wrong foot for it."""
        other = OTHER[foot]
        (x, y, _), (u, v, _) = self.sides[foot].track, self.sides[other].track
        return other if hypot(u, v) > hypot(x, y) + LEAST_STEP_LENGTH else foot

    def set_down(self, foot: Foot, place: Vec3, chained: bool, t: float) -> None:
        """Set the touchdown of the foot at `place`, by the chain or not, at `t` s."""
        side = self.sides[foot]
        side.place = place
        if chained:
            side.reach = self._reach(foot, t)
        side.offset = sub(side.place, side.track)
        self._turn_world(chained)

    def _reach(self, foot: Foot, t: float) -> tuple[float, float]:
        x, y = self.chain.forward(foot, t)
        return self.settings.limbs.foot * x, self.settings.limbs.foot * y

    def _turn_world(self, chained: bool) -> None:
        """Turn the world so that x lies along the way so far, until the wearer has gone `FIRST_DISTANCE`.

        One footfall may lie half a foot's width further left or right. The tracks' world has its x along the first
        heading."""
        if self.heading_settled:
            return
        left, right = self.sides.values()
        x, y = left.place[0] + right.place[0], left.place[1] + right.place[1]
        if hypot(x, y) < LEAST_STEP_LENGTH:
            return
        self.heading_settled = hypot(x, y) > 2.0 * FIRST_DISTANCE
        if not chained or self.chain.facing is None:
            return
        turn = atan2(y, x)
        self.chain.turn = (self.chain.turn + turn + pi) % (2.0 * pi) - pi
        c, s = cos(turn), -sin(turn)
        for side in self.sides.values():
            (px, py, pz), (rx, ry), (dx, dy) = side.place, side.reach, side.direction
            side.place = (c * px - s * py, s * px + c * py, pz)
            side.offset = displace(side.offset, sub(side.place, (px, py, pz)))
            side.reach = (c * rx - s * ry, s * rx + c * ry)
            side.direction = (c * dx - s * dy, s * dx + c * dy)
