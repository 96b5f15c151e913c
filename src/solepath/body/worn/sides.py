"""Whether what comes as the left foot is the left one.

Exchanged feet are seen in one of three ways, the surest first:

1. By the layouts: the left foot's device is laid out as a right insole, and the other way round. A device that says of
   itself that it is on the right side is believed, whatever the other ways see.
2. By the roll of the foot, where there are inertial sensors. A foot lands on the outer edge of its heel: at
   heel-strike it is rolled outwards against its mean over the swing. The axes are the foot's own (up as it stands, left
   as it turns over the toes), so mounting does not matter. Whoever walks backwards leaves the ground over the heel, and
   looks exchanged by these axes; toes turn further than heels, so a step is judged only if the foot turned further
   before it left the ground than after it landed.
3. By the centre of pressure, where there are cells and no inertial sensors: towards toe-off it goes inwards, to the big
   toe. Insoles whose cells are numbered as mirror images of each other look alike when they are exchanged together with
   their layouts; this way sees nothing of that.

Both feet must agree, over eight steps each. Nothing is said of feet that hardly roll: who shuffles, or climbs, may be
told late or never. Of 93 recordings of both feet (healthy walkers and patients, a treadmill, stairs, 50 to 200 Hz) none
is taken for exchanged, and 51 are when they are; of the others all but 9 have fewer than eight steps of a foot. A
sensor frame that is left-handed on both feet (the sign of an axis lost) mirrors the motion, and a mirrored left foot
is a right one: that is told as exchanged feet, and is as wrong.
"""

from __future__ import annotations

from bisect import bisect_right
from math import hypot, sqrt

from ...events import StrideTaken, ToeOff
from ...foot.view import FootView
from ...types import Foot, Layout, Vec3
from ...types.attrs import define, field
from ...types.vector import rotate_back
from .turned import RateIntegral

UP: Vec3 = (0.0, 0.0, 1.0)
RARELY = 0.0195
"""The turn of a foot is followed at about 50 Hz, s."""
HIDDEN = 0.11
"""Over a longer gap nothing is known of it, s."""
REMEMBERED = 80
"""Instants of it: at 50 Hz at least the last 1.4 s of a step, for a push-off, a swing and the loading after it."""
PUSH_OFF = 0.3
"""The foot turns over its toes for about this long before toe-off, s,"""
TURNED = 0.25
"""and by more than this, rad."""
NEAR = 1e-4
"""Instants are known to that, s."""
FEW = 4
"""A swing with fewer instants is not judged."""
SHORTEST = 0.4
"""Nor a shorter step, m,"""
STRAIGHT = 0.35
"""nor one in which the foot turned further, rad."""
LATE = 0.05
"""The centre of pressure is looked at this often, s."""
CONTACT = 40
"""Instants of it that are remembered."""
SPAN = 24.0
"""Steps of a foot that count most in what is known of it."""
ENOUGH = 8
"""Steps of each foot before anything is said."""
ROLLED, WENT = 0.02, 0.002
"""By more than this the feet must look exchanged: roll, rad, and centre of pressure, m."""


@define
class Average:
    """Mean and variance, the last `SPAN` counting most."""

    count: int = 0
    mean: float = 0.0
    variance: float = 0.0

    def add(self, value: float) -> None:
        """One more."""
        self.count += 1
        k = 1.0 / min(float(self.count), SPAN)
        off = value - self.mean
        self.mean += k * off
        self.variance = (1.0 - k) * (self.variance + k * off * off)

    def beyond(self, limit: float, least: int) -> bool:
        """There are enough, and the mean is above the limit by twice its own error."""
        if self.count < least:
            return False
        return self.mean - 2.0 * sqrt(self.variance / min(float(self.count), SPAN)) > limit


@define
class SideSigns:
    """What speaks for one foot being the other. Positive: it does."""

    roll: Average = field(factory=Average)
    """How far it has rolled inwards at heel-strike, rad."""
    centre: Average = field(factory=Average)
    """How far outwards the centre of pressure goes before toe-off, m."""
    mirrored: bool = False
    """The layout is the other foot's."""
    told: bool = False
    """The device says that it is this foot's."""
    across: Vec3 | None = None
    """To the left, as the foot turns over its toes, sensor frame."""
    turned: RateIntegral = field(factory=RateIntegral)
    seen_at: float | None = None
    """When the centre of pressure was last looked at, s."""
    sideways: list[float] = field(factory=list)
    """Its y over this contact, m."""


@define
class Sides:
    """Evidence of both feet; none where a device says of itself on which foot it is. Costs an integral at 50 Hz, or a
    centre of pressure at 20 Hz for an insole alone."""

    left: SideSigns = field(factory=SideSigns, init=False)
    right: SideSigns = field(factory=SideSigns, init=False)

    def swapped(self, view: FootView) -> bool:
        """A foot has used a sample; True once both feet look like the other."""
        is_left = view.foot is Foot.LEFT
        side = self.left if is_left else self.right
        self.keep(side, view)
        if not view.events:
            return False
        judged = False
        for event in view.events:
            if isinstance(event, StrideTaken):
                judged = True
                _land(side, event, rotate_back(view.attitude, UP))
                side.turned.keep_newest()
            elif isinstance(event, ToeOff) and side.sideways:
                judged = True
                _leave(side, is_left)
        if not judged:
            return False
        layout = view.after.layout
        side.mirrored = layout is not None and layout.foot is not view.foot
        return self._agree()

    def keep(self, side: SideSigns, view: FootView) -> None:
        """What a sample of the foot on that side adds to the evidence."""
        if self.left.told or self.right.told:
            return
        gyro = view.sample.gyro
        if gyro is None:
            if view.moved_at is None and view.sample.pressure:
                _press(side, view.t, None if view.pressed is None else view.pressed.centre_alone)
            return
        t, turned = view.t, side.turned
        dt = HIDDEN if turned.t is None else t - turned.t
        if 0.0 <= dt < RARELY:
            return
        if 0.0 < dt < HIDDEN:
            turned.add(t, dt, gyro, REMEMBERED)
        else:
            turned.begin(t)

    def told(self, foot: Foot, layout: Layout) -> None:
        """The device on `foot` has said where its cells are, and with it whose insole it is."""
        side = self.left if foot is Foot.LEFT else self.right
        side.told = layout.foot is foot
        if side.told:
            self.forget()

    def forget(self) -> None:
        """What the feet did lately is not needed any more."""
        for side in (self.left, self.right):
            side.turned.forget()
            side.sideways = []

    def _agree(self) -> bool:
        left, right = self.left, self.right
        if left.mirrored and right.mirrored:
            return True
        if left.told or right.told:
            return False
        if left.roll.count or right.roll.count:
            return left.roll.beyond(ROLLED, ENOUGH) and right.roll.beyond(ROLLED, ENOUGH)
        return left.centre.beyond(WENT, ENOUGH) and right.centre.beyond(WENT, ENOUGH)


def _land(side: SideSigns, step: StrideTaken, up: Vec3) -> None:
    """A step is over, and the foot stands with `up` (sensor frame): how it was rolled as it landed."""
    begin, end = step.t_toe_off, step.t_heel_strike
    if begin is None or end is None or step.degraded:
        return
    if step.length < SHORTEST or abs(step.heading_change) > STRAIGHT:
        return
    turned = side.turned
    times = turned.times()
    if not times or times[0] > begin - PUSH_OFF:
        return
    off, landed = bisect_right(times, begin + NEAR), bisect_right(times, end + NEAR)
    if landed - off < FEW:
        return
    *_, pushed = turned.between(bisect_right(times, begin - PUSH_OFF + NEAR) - 1, off)
    *_, after = turned.between(landed - 1, len(times))
    if hypot(*pushed) < TURNED or hypot(*after) > hypot(*pushed):  # or backwards
        return
    k = 1.0 / hypot(*pushed)
    x, y, z = pushed
    axis = (k * x, k * y, k * z)
    if side.across is not None:
        u, v, w = side.across
        axis = (u + 0.2 * (axis[0] - u), v + 0.2 * (axis[1] - v), w + 0.2 * (axis[2] - w))
    side.across = axis
    ahead = _ahead(axis, up)
    if ahead is None:
        return
    a, b, c = ahead
    angles = [a * x + b * y + c * z for x, y, z in turned.between(off, landed)]  # right-handed: the left edge rises
    outwards = sum(angles) / len(angles) - angles[-1]
    side.roll.add(-outwards if step.foot is Foot.LEFT else outwards)


def _ahead(left: Vec3, up: Vec3) -> Vec3 | None:
    """Unit vector to the toe; None when the foot turned about the vertical rather than over its toes."""
    lx, ly, lz = left
    ux, uy, uz = up
    x, y, z = ly * uz - lz * uy, lz * ux - lx * uz, lx * uy - ly * ux
    length = hypot(x, y, z)
    return (x / length, y / length, z / length) if length > 0.5 else None


def _press(side: SideSigns, t: float, centre: tuple[float, float] | None) -> None:
    """Look at the centre of pressure of an insole without an inertial sensor."""
    if side.seen_at is not None and 0.0 <= t - side.seen_at < LATE:
        return
    side.seen_at = t
    if centre is None:
        return
    side.sideways.append(centre[1])
    if len(side.sideways) > CONTACT:
        del side.sideways[: CONTACT // 2]


def _leave(side: SideSigns, is_left: bool) -> None:
    """A contact is over: which way the centre of pressure went, from the middle of the contact to its end."""
    ys, side.sideways = side.sideways, []
    n = len(ys)
    if n < 6:
        return
    middle, last = ys[n // 3 : n - n // 3], ys[n - n // 6 :]
    left = sum(last) / len(last) - sum(middle) / len(middle)
    side.centre.add(left if is_left else -left)
