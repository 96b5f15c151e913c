"""Where the wearer is, of two feet that are one body.

The world frame begins between the feet, x along the wearer's first heading: the mean of the directions in which the
feet set out. At each step the foot that swung is compared with the one that stood (agreement.py): it stood beside the
middle of the stride, to the side by the walking width, which is learnt. In a bend of `turn` rad the chord of a stride L
m long lies L turn / 8 inside the way. Feet that are further apart than legs spread are pulled together in any case.

In the first metres this places the two tracks beside one another, whatever way the first steps led (facing.py), and
changes neither. From then on what is found is handed back to the feet, each at its own foot-flat (`Shift`): both hold
the heading that they agree on, live and in their later strides. A stride that was taken stays as it was reported.

With the feet held together their mean does not shrink as they drift apart, and neither is better than the other: each
has been given its share by how unsure it was. A foot that falls silent and comes back is treated as by `MeanOfFeet`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import atan2, cos, hypot, sin

from ...events import StrideTaken
from ...foot.view import FootPose, FootView
from ...types import Foot, Site, Vec3
from ...types.attrs import define, field, frozen
from ...types.vector import ZERO, sub
from ..part import PartOutput, Position, Shift
from .agreement import HEADING, RATE, STATES, WIDTH, Agreement, Term, X, Y
from .corridor import Corridor
from .facing import Askew, Facing, FacingStride, lay_alongside
from .position import MeanOfFeet

FARTHEST = 1e6
"""Tracks that lead further than this, m, or strides whose variance is more (m^2), are no walk."""
STOOD = 1.0
"""A heading drifts as usual while the wearer walks: of the time that a foot stood no more than this counts, s."""
UNEVEN = 1e-4
"""What a footprint differs by from a point, m^2."""
BESIDE = (0.15, 0.05)
"""How well a foot that came back is set beside the other, m and rad."""
STANDING_APART, WALKING_WIDTH = 0.18, 0.12
"""How far the feet stand from one another at first, m, and the walking width to begin with, m."""
LANDS_ASIDE, LANDS_ALONG = 0.045, 0.15
"""How far a foot comes down to the side of where it does on the average, m, and before or behind the middle of the
other's stride, m."""
IN_TURNS = 0.12
"""In a turn that much more for every metre and radian."""
SHORTEST_STRIDE, CORNER, ELSEWHERE = 0.5, 0.8, 0.6
"""A shorter stride says too little of its direction, m; nor does one in which the foot turned further, rad, or which
leads elsewhere than the foot points, rad."""
BELIEVED = 16.0
"""Largest normalised square of what is believed."""
LONGEST_STRIDE = 2.5
"""A foot that goes further in one stride is unsure by what is more, m."""
SETTLES = 5.0
"""After so many metres the feet are placed, and corrections are theirs."""


@frozen
class BothFeetSettings:
    """What `BothFeet` is set to."""

    straight_corridors: bool = False
    """Believe that who seems to walk straight does (corridor.py)."""
    feedback: bool = True
    """Hand corrections back to the feet."""
    reach: float = 1.5
    """Legs spread by this much at the most, m."""


@define
class BothFeet(MeanOfFeet):
    """The mean of two feet that hold each other's heading and place.

    Latency: none; what a step says of the other foot is known with it, and the other's track follows at its own next
    foot-flat, its place in `position` at once. A foot that cannot be shifted keeps its track.
    """

    settings: BothFeetSettings = BothFeetSettings()
    agreement: Agreement = field(factory=Agreement, init=False)
    corridor: Corridor = field(factory=Corridor, init=False)
    met: bool = field(default=False, init=False)
    """Both feet were heard of."""
    way: float = field(default=0.0, init=False)
    """Up to `SETTLES`, m."""
    width: float = field(default=0.0, init=False)
    """Walking width, m."""
    strides: list[FacingStride | None] = field(factory=lambda: [None, None], init=False)
    """Left and right."""
    askew: Askew = field(factory=Askew, init=False)
    facing: list[Facing] = field(factory=lambda: [Facing(), Facing()], init=False)
    bases: list[tuple[float, Vec3]] = field(factory=lambda: [(0.0, ZERO), (0.0, ZERO)], init=False)
    """Turn and offset at which the tracks were placed; what has come since is the feet's own to take."""

    def feed(self, view: FootView) -> Sequence[PartOutput]:
        """As for `MeanOfFeet`; at a step, what it says of both."""
        waited = self.left.waits or self.right.waits
        MeanOfFeet.feed(self, view)
        if not self.met:
            if self.left.t is None or self.right.t is None:
                return ()
            self._meet()
        if not view.events or self.left.waits or self.right.waits:
            return ()
        if waited:
            self.agreement.beside(0 if self.newest is Foot.LEFT else 1, *BESIDE)
            self._placed_anew()
        said: list[PartOutput] = []
        for event in view.events:
            if isinstance(event, StrideTaken):
                said += self._stride(event, view.after.takes_shifts)
        return said

    def reset(self, site: Site) -> None:
        """As for `MeanOfFeet`."""
        MeanOfFeet.reset(self, site)
        if site.foot is not None:
            self.strides[0 if site.foot is Foot.LEFT else 1] = None
            self.corridor.reset()

    def position(self, feet: Mapping[Foot, FootPose]) -> Position | None:
        """None before any sample. Of two feet the covariance is that of their mean at the newest step."""
        found = MeanOfFeet.position(self, feet)
        left, right = self.left, self.right
        if found is None or not self.met or left.waits or right.waits or left.absent or right.absent:
            return found
        xx, xy, yy = self.agreement.mean()
        # what heights have in common with places that were corrected here is not known: nothing is claimed of it
        return Position(found.t, found.position, (xx, xy, 0.0, yy, 0.0, found.covariance[5]))

    def _meet(self) -> None:
        self.met = True
        self.width = WALKING_WIDTH
        self.agreement.begin()
        if not self.left.waits and not self.right.waits:
            for placed, k in ((self.left, 0.5), (self.right, -0.5)):
                x, y, z = placed.offset
                placed.offset = (x, y + k * STANDING_APART, z)
        self._placed_anew()

    def _placed_anew(self) -> None:
        self.bases = [(placed.turn, placed.offset) for placed in (self.left, self.right)]

    def _stride(self, taken: StrideTaken, takes_shifts: bool) -> Sequence[PartOutput]:
        index = 0 if taken.foot is Foot.LEFT else 1
        this = self.left if index == 0 else self.right
        numbers = (*taken.position, *taken.displacement, *taken.covariance)
        if not all([abs(v) < FARTHEST for v in numbers]) or self.agreement.lost:
            self._give_up()
            return ()
        own = taken.position
        c, s = cos(this.turn), sin(this.turn)
        x, y, _ = taken.displacement
        dx, dy = c * x - s * y, s * x + c * y
        t_toe_off = taken.t_start if taken.t_toe_off is None else taken.t_toe_off
        swung = max(0.0, min(taken.t_end - t_toe_off, STOOD))
        stood = max(0.0, min(t_toe_off - taken.t_start, STOOD))
        # what its heading has drifted by as a rule, and where it has thus come to
        rate = self.agreement.rates[index]
        middle = rate * (stood + 0.5 * swung)
        this.correct(own, rate * (stood + swung), -middle * dy, middle * dx)
        x, y, _ = this.place(own)
        xx, xy, _, yy, _, _ = taken.covariance
        cc, ss, cs = c * c, s * s, c * s
        variance = (
            cc * xx - 2.0 * cs * xy + ss * yy + UNEVEN,
            cs * (xx - yy) + (cc - ss) * xy,
            ss * xx + 2.0 * cs * xy + cc * yy + UNEVEN,
        )
        wild = max(0.0, taken.length - LONGEST_STRIDE)
        self.agreement.advance(index, stood, swung, (x, y), (dx, dy), variance, taken.degraded or wild > 0.0)
        if wild > 0.0:
            self.agreement.doubt(index, wild)
        self.way = min(SETTLES, self.way + 0.5 * taken.length)
        x, y, _ = taken.displacement
        straight = hypot(x, y) > SHORTEST_STRIDE and abs(taken.heading_change) < CORNER and not taken.degraded
        self.strides[index] = FacingStride(taken.t_end, own, atan2(y, x) if straight else None)
        if self.way >= SETTLES or not self._lined_up(index, taken):
            self._compare(index, taken, dx, dy, stood, swung)
            if self.settings.straight_corridors:
                x, y, z = this.place(own)
                self._hold(index, taken, (x - dx, y - dy, z), (x, y, z))
        return self._hand_back(index, taken.foot, takes_shifts)

    def _lined_up(self, index: int, taken: StrideTaken) -> bool:
        """Whether the tracks of both feet had to be laid beside one another anew, within the first metres."""
        this, beside = self.strides[index], self.strides[1 - index]
        if this is None or beside is None or not taken.t_start < beside.t_end < taken.t_end:
            return False
        own, other, side = (self.left, self.right, 1.0) if index == 0 else (self.right, self.left, -1.0)
        angle = self.askew.between(this, own.turn, beside, other.turn, side)
        if angle is None:
            return False
        lay_alongside(own, this, other, beside, angle, 0.5 * taken.length, side * WALKING_WIDTH)
        self.agreement.begin()
        self.corridor.end()
        self.way, self.facing = 0.0, [Facing(), Facing()]
        self._placed_anew()
        return True

    def _compare(self, index: int, taken: StrideTaken, dx: float, dy: float, stood: float, swung: float) -> None:
        """This foot's stride (dx, dy) with where the other one stood."""
        this, other = (self.left, self.right) if index == 0 else (self.right, self.left)
        turn, length = taken.heading_change, hypot(dx, dy)
        off = self.facing[index].off(atan2(dy, dx), turn) if length > SHORTEST_STRIDE else 0.0
        beside = self.strides[1 - index]
        if beside is None or other.absent:
            return
        this_x, this_y = index * STATES + X, index * STATES + Y
        other_x, other_y = (1 - index) * STATES + X, (1 - index) * STATES + Y
        ex, ey, _ = this.place(taken.position)
        if (
            taken.t_start < beside.t_end < taken.t_end
            and length > SHORTEST_STRIDE
            and abs(turn) < CORNER
            and abs(off) < ELSEWHERE
            and not taken.degraded
        ):
            # n: to the left of the stride's direction u; m: from its middle to the foot that stood
            ux, uy = dx / length, dy / length
            nx, ny = -uy, ux
            qx, qy, _ = other.place(beside.end)
            mx, my = qx - (ex - 0.5 * dx), qy - (ey - 0.5 * dy)
            ahead, left = ux * mx + uy * my, nx * mx + ny * my
            side = 1.0 if index == 1 else -1.0
            more = IN_TURNS * turn * length
            heading, rate = index * STATES + HEADING, index * STATES + RATE
            others = (1 - index) * STATES + HEADING
            # u and the middle follow the heading in mid-swing, psi - r T_swing / 2, and the turn is wrong by r T
            lever = 0.5 * length - ahead
            terms: list[Term] = [
                (other_x, nx), (other_y, ny), (this_x, -nx), (this_y, -ny), (heading, lever), (others, -lever),
                (rate, length * (stood + swung) / 8.0 - 0.5 * swung * lever), (WIDTH, -side),
            ]  # fmt: skip
            expected = side * self.width - length * turn / 8.0
            self._take(self.agreement.measure(terms, expected - left, LANDS_ASIDE**2 + more * more, BELIEVED))
            terms = [
                (other_x, ux), (other_y, uy), (this_x, -ux), (this_y, -uy), (heading, left), (others, -left),
                (rate, -0.5 * swung * left),
            ]  # fmt: skip
            self._take(self.agreement.measure(terms, -ahead, LANDS_ALONG**2 + more * more, BELIEVED))
            ex, ey, _ = this.place(taken.position)
        qx, qy, _ = other.place(other.here)
        apart = hypot(qx - ex, qy - ey)
        if apart > self.settings.reach:
            # a foot that has gone far and took no step there has lost its way, and the other must not follow
            wx, wy, _ = sub(other.here, beside.end)
            self.agreement.doubt(1 - index, max(0.0, hypot(wx, wy) - LONGEST_STRIDE))
            if beside.t_end < taken.t_start:  # nor does one stand through strides of the other: its own were missed
                self.agreement.doubt(1 - index, taken.length)
            nx, ny = (qx - ex) / apart, (qy - ey) / apart
            terms = [(other_x, nx), (other_y, ny), (this_x, -nx), (this_y, -ny)]
            self._take(self.agreement.measure(terms, self.settings.reach - apart, LANDS_ALONG**2, 1e12))

    def _take(self, found: list[float] | None) -> None:
        """Take the errors that were found out of both tracks."""
        if found is None:
            return
        self.width += found[WIDTH]
        cx, cy = self.agreement.centre
        for index, placed in ((0, self.left), (1, self.right)):
            stride, first = self.strides[index], index * STATES
            at = placed.here if stride is None else stride.end
            x, y, _ = placed.place(at)
            yaw = found[first + HEADING]
            placed.correct(at, yaw, found[first + X] - yaw * (y - cy), found[first + Y] + yaw * (x - cx))

    def _hold(self, index: int, taken: StrideTaken, start: Vec3, end: Vec3) -> None:
        """The wearer walks straight on, as far as that goes."""
        held = self.corridor.stride(index, taken.t_end, start, end, taken.heading_change)
        if held is None:
            return
        yaw, rate = held
        found = [0.0] * (WIDTH + 1)
        found[HEADING] = found[STATES + HEADING] = yaw
        self._take(found)
        self.agreement.turned_alike(rate, self.corridor.drift[2])

    def _hand_back(self, index: int, foot: Foot, takes_shifts: bool) -> Sequence[PartOutput]:
        """The foot is to take what was found since the tracks were placed."""
        this = self.left if index == 0 else self.right
        stride = self.strides[index]
        if stride is not None and self.way < SETTLES:
            self.bases[index] = (this.turn, this.offset)
        elif stride is not None and self.settings.feedback and takes_shifts:
            place, yaw = this.place(stride.end), this.turn
            this.turn, this.offset = self.bases[index]
            own = this.undone(place)
            by = sub(own, stride.end)
            (x, y, z), (dx, dy, dz) = this.here, by
            stride.end, this.here = own, (x + dx, y + dy, z + dz)
            return [Shift(foot, yaw - this.turn, by)]
        return ()

    def _give_up(self) -> None:
        """Of how the tracks lie to one another nothing is known that would be of use."""
        self.agreement.begin()
        self.strides = [None, None]
        self.corridor.end()
        (self.left.turn, self.left.offset), (self.right.turn, self.right.offset) = self.bases
