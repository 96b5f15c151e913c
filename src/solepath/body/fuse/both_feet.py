"""Position of the wearer from the tracks of two feet that belong to one body.

The world frame starts between the feet, x along the wearer's first heading: the mean of the directions in which the
feet set out. At each stride the foot that swung is compared with the one that stood (error_filter.py): it stood beside
the middle of the stride, to the side by the walking width, which is learnt. In a bend of `turn` rad the chord of a
stride L m long lies L turn / 8 inside the path. Feet that are further apart than legs spread are pulled together in any
case.

In the first metres this aligns the two tracks, whatever way the first strides led (walking_direction.py), and changes
neither. From then on corrections are returned to the feet, each at its own foot-flat (`Shift`): both feet keep the
heading that they agree on, live and in their later strides. A stride stays as it was reported.

While the feet are held together their mean does not shrink as they drift apart, and neither is better than the other:
each has received its share by its variance. A foot that falls silent and comes back is treated as by `MeanOfFeet`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import atan2, cos, hypot, sin

from ...events import StrideTaken
from ...foot.view import FootPose, FootView
from ...types import Foot, Site, Vec3
from ...types.attrs import define, field, frozen
from ...types.vector import ZERO, sub
from ..part import PartOutput, Position, Shift
from .corridor import Corridor
from .error_filter import HEADING, RATE, STATES, WIDTH, Term, TrackErrorFilter, X, Y
from .position import MeanOfFeet
from .walking_direction import DirectedStride, TrackDivergence, WalkingDirection, align_tracks

LARGEST_VALUE = 1e6
"""Largest coordinate of a track, m, and largest variance of a stride, m^2, that are used."""
LONGEST_PHASE = 1.0
"""Longest stance or swing time that counts as walking, s: the usual drift rate is that of a wearer who walks."""
FOOTPRINT_VARIANCE = 1e-4
"""Variance of the place of a footprint, m^2."""
ALIGNMENT_ERROR = (0.15, 0.05)
"""Standard deviations of the place, m, and the heading, rad, of a returned foot that is aligned with the other."""
STANDING_WIDTH, WALKING_WIDTH = 0.18, 0.12
"""First lateral distance of the feet, standing and walking, m."""
LATERAL_ERROR, LONGITUDINAL_ERROR = 0.045, 0.15
"""Standard deviations of a foot's landing place, m: to the side, and along the middle of the other's stride."""
TURN_ERROR = 0.12
"""Increase of both deviations in a turn, m for every metre and radian."""
SHORTEST_STRIDE, LARGEST_TURN, LARGEST_DEVIATION = 0.5, 0.8, 0.6
"""Least length, m, largest turn, rad, and largest deviation from the foot's direction, rad, of a stride that counts."""
GATE = 16.0
"""Innovation gate: limit of the normalised squared innovation of a measurement."""
LONGEST_STRIDE = 2.5
"""Longest stride that is plausible, m; the excess of a longer one inflates the covariance."""
PLACEMENT_DISTANCE = 5.0
"""Distance after which the tracks are aligned, and corrections go to the feet, m."""


@frozen
class BothFeetSettings:
    """The settings of `BothFeet`."""

    straight_corridors: bool = False
    """Flag: a path that seems straight is taken as straight (corridor.py)."""
    feedback: bool = True
    """Flag: corrections are returned to the feet."""
    reach: float = 1.5
    """Largest distance between the feet, m."""


@define
class BothFeet(MeanOfFeet):
    """The mean of two feet whose headings and places correct each other.

    Latency: none. The information of a stride about the other foot is used at once in `position`; the other foot's
    track follows at its own next foot-flat. A foot that cannot be shifted keeps its track."""

    settings: BothFeetSettings = BothFeetSettings()
    errors: TrackErrorFilter = field(factory=TrackErrorFilter, init=False)
    corridor: Corridor = field(factory=Corridor, init=False)
    started: bool = field(default=False, init=False)
    """Flag: both feet have given samples."""
    distance: float = field(default=0.0, init=False)
    """Distance walked, m, up to `PLACEMENT_DISTANCE`."""
    width: float = field(default=0.0, init=False)
    """Walking width, m."""
    strides: list[DirectedStride | None] = field(factory=lambda: [None, None], init=False)
    """Newest stride of the left and the right foot."""
    divergence: TrackDivergence = field(factory=TrackDivergence, init=False)
    directions: list[WalkingDirection] = field(factory=lambda: [WalkingDirection(), WalkingDirection()], init=False)
    placements: list[tuple[float, Vec3]] = field(factory=lambda: [(0.0, ZERO), (0.0, ZERO)], init=False)
    """Turn, rad, and offset, m, at which the tracks were aligned; later corrections go to the feet themselves."""

    def feed(self, view: FootView) -> Sequence[PartOutput]:
        """Add one sample of a foot, as `MeanOfFeet` does, and at a stride return the foot's correction."""
        was_unplaced = self.left.unplaced or self.right.unplaced
        MeanOfFeet.feed(self, view)
        if not self.started:
            if self.left.t is None or self.right.t is None:
                return ()
            self._start()
        if not view.events or self.left.unplaced or self.right.unplaced:
            return ()
        if was_unplaced:
            self.errors.align(0 if self.placed_last is Foot.LEFT else 1, *ALIGNMENT_ERROR)
            self._keep_placements()
        outputs: list[PartOutput] = []
        for event in view.events:
            if isinstance(event, StrideTaken):
                outputs += self._add_stride(event, view.after.takes_shifts)
        return outputs

    def reset(self, site: Site) -> None:
        """Reset a foot as `MeanOfFeet` does, and discard its newest stride."""
        MeanOfFeet.reset(self, site)
        if site.foot is not None:
            self.strides[0 if site.foot is Foot.LEFT else 1] = None
            self.corridor.reset()

    def position(self, feet: Mapping[Foot, FootPose]) -> Position | None:
        """Return the wearer's position, with the mean's covariance at the newest stride; None before any sample."""
        found = MeanOfFeet.position(self, feet)
        left, right = self.left, self.right
        if found is None or not self.started or left.unplaced or right.unplaced or left.absent or right.absent:
            return found
        xx, xy, yy = self.errors.mean_covariance()
        # the covariance of heights with places that were corrected here is not known: it is left out
        return Position(found.t, found.position, (xx, xy, 0.0, yy, 0.0, found.covariance[5]))

    def _start(self) -> None:
        self.started = True
        self.width = WALKING_WIDTH
        self.errors.start()
        if not self.left.unplaced and not self.right.unplaced:
            for placed, k in ((self.left, 0.5), (self.right, -0.5)):
                x, y, z = placed.offset
                placed.offset = (x, y + k * STANDING_WIDTH, z)
        self._keep_placements()

    def _keep_placements(self) -> None:
        self.placements = [(placed.turn, placed.offset) for placed in (self.left, self.right)]

    def _add_stride(self, taken: StrideTaken, takes_shifts: bool) -> Sequence[PartOutput]:
        index = 0 if taken.foot is Foot.LEFT else 1
        this = self.left if index == 0 else self.right
        numbers = (*taken.position, *taken.displacement, *taken.covariance)
        if not all([abs(v) < LARGEST_VALUE for v in numbers]) or self.errors.diverged:
            self._restart()
            return ()
        own = taken.position
        c, s = cos(this.turn), sin(this.turn)
        x, y, _ = taken.displacement
        dx, dy = c * x - s * y, s * x + c * y
        t_toe_off = taken.t_start if taken.t_toe_off is None else taken.t_toe_off
        swing = max(0.0, min(taken.t_end - t_toe_off, LONGEST_PHASE))
        stance = max(0.0, min(t_toe_off - taken.t_start, LONGEST_PHASE))
        # apply the usual drift of its heading to heading and place
        rate = self.errors.rates[index]
        middle = rate * (stance + 0.5 * swing)
        this.correct(own, rate * (stance + swing), -middle * dy, middle * dx)
        x, y, _ = this.place(own)
        xx, xy, _, yy, _, _ = taken.covariance
        cc, ss, cs = c * c, s * s, c * s
        variance = (
            cc * xx - 2.0 * cs * xy + ss * yy + FOOTPRINT_VARIANCE,
            cs * (xx - yy) + (cc - ss) * xy,
            ss * xx + 2.0 * cs * xy + cc * yy + FOOTPRINT_VARIANCE,
        )
        excess = max(0.0, taken.length - LONGEST_STRIDE)
        self.errors.propagate(index, stance, swing, (x, y), (dx, dy), variance, taken.degraded or excess > 0.0)
        if excess > 0.0:
            self.errors.inflate(index, excess)
        self.distance = min(PLACEMENT_DISTANCE, self.distance + 0.5 * taken.length)
        x, y, _ = taken.displacement
        straight = hypot(x, y) > SHORTEST_STRIDE and abs(taken.heading_change) < LARGEST_TURN and not taken.degraded
        self.strides[index] = DirectedStride(taken.t_end, own, atan2(y, x) if straight else None)
        if self.distance >= PLACEMENT_DISTANCE or not self._realign(index, taken):
            self._compare_feet(index, taken, dx, dy, stance, swing)
            if self.settings.straight_corridors:
                x, y, z = this.place(own)
                self._hold_corridor(index, taken, (x - dx, y - dy, z), (x, y, z))
        return self._shift_foot(index, taken.foot, takes_shifts)

    def _realign(self, index: int, taken: StrideTaken) -> bool:
        """Align the tracks of both feet again within the first metres if they diverge; return whether that was done."""
        this, beside = self.strides[index], self.strides[1 - index]
        if this is None or beside is None or not taken.t_start < beside.t_end < taken.t_end:
            return False
        own, other, side = (self.left, self.right, 1.0) if index == 0 else (self.right, self.left, -1.0)
        angle = self.divergence.update(this, own.turn, beside, other.turn, side)
        if angle is None:
            return False
        align_tracks(own, this, other, beside, angle, 0.5 * taken.length, side * WALKING_WIDTH)
        self.errors.start()
        self.corridor.end()
        self.distance, self.directions = 0.0, [WalkingDirection(), WalkingDirection()]
        self._keep_placements()
        return True

    def _compare_feet(self, index: int, taken: StrideTaken, dx: float, dy: float, stance: float, swing: float) -> None:
        """Compare the stride (dx, dy) of this foot, m, with the place where the other foot stood."""
        this, other = (self.left, self.right) if index == 0 else (self.right, self.left)
        turn, length = taken.heading_change, hypot(dx, dy)
        off = self.directions[index].deviation(atan2(dy, dx), turn) if length > SHORTEST_STRIDE else 0.0
        beside = self.strides[1 - index]
        if beside is None or other.absent:
            return
        this_x, this_y = index * STATES + X, index * STATES + Y
        other_x, other_y = (1 - index) * STATES + X, (1 - index) * STATES + Y
        ex, ey, _ = this.place(taken.position)
        if (
            taken.t_start < beside.t_end < taken.t_end
            and length > SHORTEST_STRIDE
            and abs(turn) < LARGEST_TURN
            and abs(off) < LARGEST_DEVIATION
            and not taken.degraded
        ):
            # n: to the left of the stride's direction u; m: from its middle to the foot that stood
            ux, uy = dx / length, dy / length
            nx, ny = -uy, ux
            qx, qy, _ = other.place(beside.end)
            mx, my = qx - (ex - 0.5 * dx), qy - (ey - 0.5 * dy)
            ahead, left = ux * mx + uy * my, nx * mx + ny * my
            side = 1.0 if index == 1 else -1.0
            more = TURN_ERROR * turn * length
            heading, rate = index * STATES + HEADING, index * STATES + RATE
            others = (1 - index) * STATES + HEADING
            # u and the middle follow the heading in mid-swing, psi - r T_swing / 2, and the turn is wrong by r T
            arm = 0.5 * length - ahead
            terms: list[Term] = [
                (other_x, nx), (other_y, ny), (this_x, -nx), (this_y, -ny), (heading, arm), (others, -arm),
                (rate, length * (stance + swing) / 8.0 - 0.5 * swing * arm), (WIDTH, -side),
            ]  # fmt: skip
            expected = side * self.width - length * turn / 8.0
            self._apply(self.errors.correct(terms, expected - left, LATERAL_ERROR**2 + more * more, GATE))
            terms = [
                (other_x, ux), (other_y, uy), (this_x, -ux), (this_y, -uy), (heading, left), (others, -left),
                (rate, -0.5 * swing * left),
            ]  # fmt: skip
            self._apply(self.errors.correct(terms, -ahead, LONGITUDINAL_ERROR**2 + more * more, GATE))
            ex, ey, _ = this.place(taken.position)
        qx, qy, _ = other.place(other.newest_place)
        apart = hypot(qx - ex, qy - ey)
        if apart > self.settings.reach:
            # a foot that moved far without a stride has lost its track, and the other must not follow
            wx, wy, _ = sub(other.newest_place, beside.end)
            self.errors.inflate(1 - index, max(0.0, hypot(wx, wy) - LONGEST_STRIDE))
            if beside.t_end < taken.t_start:  # no foot stands that long: its own strides were not found
                self.errors.inflate(1 - index, taken.length)
            nx, ny = (qx - ex) / apart, (qy - ey) / apart
            terms = [(other_x, nx), (other_y, ny), (this_x, -nx), (this_y, -ny)]
            self._apply(self.errors.correct(terms, self.settings.reach - apart, LONGITUDINAL_ERROR**2, 1e12))

    def _apply(self, found: list[float] | None) -> None:
        """Take the errors that were found out of both tracks."""
        if found is None:
            return
        self.width += found[WIDTH]
        cx, cy = self.errors.centre
        for index, placed in ((0, self.left), (1, self.right)):
            stride, first = self.strides[index], index * STATES
            at = placed.newest_place if stride is None else stride.end
            x, y, _ = placed.place(at)
            yaw = found[first + HEADING]
            placed.correct(at, yaw, found[first + X] - yaw * (y - cy), found[first + Y] + yaw * (x - cx))

    def _hold_corridor(self, index: int, taken: StrideTaken, start: Vec3, end: Vec3) -> None:
        """Correct the heading towards a straight path, as far as the corridor filter allows."""
        held = self.corridor.add_stride(index, taken.t_end, start, end, taken.heading_change)
        if held is None:
            return
        yaw, rate = held
        found = [0.0] * (WIDTH + 1)
        found[HEADING] = found[STATES + HEADING] = yaw
        self._apply(found)
        self.errors.correct_mean_rate(rate, self.corridor.drift[2])

    def _shift_foot(self, index: int, foot: Foot, takes_shifts: bool) -> Sequence[PartOutput]:
        """Return the correction of the foot that was found since the tracks were aligned."""
        this = self.left if index == 0 else self.right
        stride = self.strides[index]
        if stride is not None and self.distance < PLACEMENT_DISTANCE:
            self.placements[index] = (this.turn, this.offset)
        elif stride is not None and self.settings.feedback and takes_shifts:
            place, yaw = this.place(stride.end), this.turn
            this.turn, this.offset = self.placements[index]
            own = this.to_own(place)
            by = sub(own, stride.end)
            (x, y, z), (dx, dy, dz) = this.newest_place, by
            stride.end, this.newest_place = own, (x + dx, y + dy, z + dz)
            return [Shift(foot, yaw - this.turn, by)]
        return ()

    def _restart(self) -> None:
        """Restart the error filter: nothing useful is known of how the tracks lie to one another."""
        self.errors.start()
        self.strides = [None, None]
        self.corridor.end()
        (self.left.turn, self.left.offset), (self.right.turn, self.right.offset) = self.placements
