"""Places of both feet from P_L, P_R and the vector V_change between these (walking-modes).

After Gong et al. 2023 (Sensors 23, 5417), equations (1) to (3). P_L and P_R are the ends of the feet in the chain of
seven attitudes (limbs.py) if it is known. Otherwise they are the positions of the feet's own inertial tracks, which
start `ModesSettings.feet_distance` apart. A foot that was silent for a while is put beside the other foot after some
strides (`MeanOfFeet`).

By the chain a touchdown is the place below the ankle, from which `FootPlace.reach` points to the end of the foot.
Numbers without a source were chosen by hand."""

from __future__ import annotations

from math import atan2, hypot

from ...body.fuse.position import MeanOfFeet
from ...foot.view import FootView
from ...types import OTHER, Foot, Vec2, Vec3
from ...types.attrs import define, field, state, stateful
from ...types.vector import ZERO, add, sub, turned, wrap_angle
from .limbs.limbs import LowerLimbs
from .mode import LEAST_STEP_LENGTH
from .settings import ModesSettings
from .touchdown import displace, v_change

FIRST_DISTANCE = 1.5
"""Distance, m, from the start to the middle between the feet, from which on the first heading is final."""
LEAST_HEADING_DISTANCE = 0.075
"""Distance, m, from the start to the middle between the feet below which it shows no heading."""
CLEAR_DISTANCE = 0.15
"""Distance, m, by which one foot must be further from the start than the other for it to have stepped first."""
LEAST_DIRECTION = 0.15
"""Length of the sum of both feet's unit vectors below which they are nearly opposite and show no direction."""


@define
class FootPlace:
    """The place of one foot."""

    place: Vec3 = ZERO
    """Place of the last touchdown, world frame, m: below the ankle (by the chain) or the sensor (by the track)."""
    offset: Vec3 = ZERO
    """Vector from the foot's own track to its place at the last touchdown, world frame, m."""
    reach: Vec2 = (0.0, 0.0)
    """Vector from below the ankle to the end of the foot at the last touchdown, world frame, m."""
    track: Vec3 = ZERO
    """Position by the foot's own inertial track, world frame, m; moved beside the other foot's after a silence."""
    direction: Vec2 = (1.0, 0.0)
    """Unit vector of the direction of walking at the last touchdown, world frame."""

    @property
    def own_position(self) -> Vec3:
        """Last touchdown plus the movement of the foot's own track since then, world frame, m."""
        return add(self.track, self.offset)

    @property
    def moved_distance(self) -> float:
        """Horizontal distance from the last touchdown to `own_position`, m."""
        return hypot(*sub(self.own_position, self.place)[:2])


@stateful
class FootPlaces:
    """The places of both feet and the chain between them."""

    settings: ModesSettings = field()
    chain: LowerLimbs = field(init=False)
    """Chain of the seven segments."""
    sides: dict[Foot, FootPlace] = field(init=False)
    """Place by foot."""
    heading_settled: bool = field(init=False)
    """Flag: the first heading is final."""
    mean: MeanOfFeet = state(factory=MeanOfFeet)
    """Part that puts a foot beside the other one after a silence."""

    def __attrs_post_init__(self) -> None:
        settings = self.settings
        self.chain = LowerLimbs(settings)
        self.heading_settled = settings.heading is not None
        self.sides = {}
        for foot, sign in ((Foot.LEFT, 0.5), (Foot.RIGHT, -0.5)):
            place = (0.0, sign * settings.feet_distance, 0.0)
            self.sides[foot] = FootPlace(place, place, (settings.limbs.foot, 0.0))

    def add_view(self, view: FootView) -> None:
        """Add the position of a foot by its own track.

        When `mean` moves a track, the place of the foot stays; when it puts one beside the other after a silence, the
        feet stand abreast."""
        tracks = self.mean.tracks
        before = {foot: (track.offset, track.unplaced) for foot, track in tracks.items()}
        self.mean.add_view(view)
        for foot, track in tracks.items():
            _, was_unplaced = before[foot]
            if (track.offset, track.unplaced) != before[foot]:
                side, other = self.sides[foot], self.sides[OTHER[foot]]
                here, side.track = side.own_position, track.newest
                if was_unplaced and not track.unplaced:
                    here = side.place = add(add(other.offset, (*self._side_offset(foot, other), 0.0)), side.track)
                side.offset = sub(here, side.track)
        if view.levelled:
            self.sides[view.foot].track = tracks[view.foot].newest

    def _side_offset(self, foot: Foot, other: FootPlace) -> Vec2:
        """Return the vector from `other` to `foot`, world frame, m, when both stand abreast, facing its direction."""
        c, s = other.direction
        k = self.settings.feet_distance if foot is Foot.LEFT else -self.settings.feet_distance
        return -s * k, c * k

    def is_lost(self, foot: Foot, t: float) -> bool:
        """Return whether neither its track nor the chain gives the place of the foot at `t` s."""
        return not self.mean.tracks[foot].is_here and not self.chain.is_current(t)

    def middle(self, foot: Foot) -> Vec3:
        """Return the middle between the feet, world frame, m, if the other foot stands beside `own_position`."""
        side = self.sides[foot]
        x, y, _ = side.own_position
        dx, dy = self._side_offset(OTHER[foot], side)
        return (x + 0.5 * dx, y + 0.5 * dy, side.track[2])

    def locate(self, foot: Foot, t: float) -> tuple[Vec3, bool]:
        """Return the place of `foot`, world frame, m, from the other foot by (1) to (3), and whether the chain is used.

        If the chain is unknown and the other foot has moved since it came down, it is no reference. Then the place is
        `own_position` of this foot. The height is always that of this foot's own track."""
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

    def walking_direction(self, t: float) -> Vec2:
        """Return the unit vector of the mean direction of both feet at `t` s, world frame."""
        (lx, ly), (rx, ry) = self.chain.forward(Foot.LEFT, t), self.chain.forward(Foot.RIGHT, t)
        x, y = lx + rx, ly + ry
        length = hypot(x, y)
        return (x / length, y / length) if length > LEAST_DIRECTION else (lx, ly)

    def first_step_foot(self, foot: Foot) -> Foot:
        """Return the foot that took the first step: `foot`, unless the other is clearly further from the start."""
        (x, y, _), (u, v, _) = self.sides[foot].track, self.sides[OTHER[foot]].track
        return OTHER[foot] if hypot(u, v) > hypot(x, y) + CLEAR_DISTANCE else foot

    def set_down(self, foot: Foot, place: Vec3, chained: bool, t: float) -> None:
        """Set the touchdown of the foot at `t` s to `place`, world frame, m; `chained` if it comes from the chain."""
        side = self.sides[foot]
        side.place = place
        side.offset = sub(side.place, side.track)
        if chained:
            side.reach = self._reach(foot, t)
            self._settle_heading()

    def _settle_heading(self) -> None:
        """Turn the chain's world so that x points from the start to the wearer, until `FIRST_DISTANCE` is reached.

        A single touchdown does not suffice, because it may be several centimetres too far to the left or right."""
        left, right = self.sides.values()
        x, y, _ = add(left.place, right.place)  # twice the middle
        if self.heading_settled or self.chain.facing is None or hypot(x, y) < 2.0 * LEAST_HEADING_DISTANCE:
            return
        self.heading_settled = hypot(x, y) > 2.0 * FIRST_DISTANCE
        turn = atan2(y, x)
        self.chain.facing = wrap_angle(self.chain.facing + turn)
        for side in (left, right):
            before, side.place = side.place, turned(side.place, -turn)
            side.offset = add(side.offset, sub(side.place, before))
            (dx, dy, _), (rx, ry, _) = (turned((*of, 0.0), -turn) for of in (side.direction, side.reach))
            side.direction, side.reach = (dx, dy), (rx, ry)

    def _reach(self, foot: Foot, t: float) -> Vec2:
        x, y = self.chain.forward(foot, t)
        return self.settings.limbs.foot * x, self.settings.limbs.foot * y
