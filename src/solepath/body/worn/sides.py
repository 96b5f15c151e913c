"""Detection of exchanged feet: the sensors of the left and the right foot are swapped.

There are three kinds of evidence, the surest first:

1. Layouts: the left foot's device has the layout of a right insole, and the other way round. A device that reports
itself to be on the right side is trusted, whatever the other evidence shows.

2. Roll of the foot, where there are inertial sensors. A foot lands on the outer edge of its heel: at heel-strike it is
rolled outwards against its mean over the swing. The axes are the foot's own (up as it stands, left as it turns over the
toes), so mounting does not matter. A wearer who walks backwards leaves the ground over the heel and looks exchanged by
these axes. Toes turn further than heels, so a stride counts only if the foot turned further before it left the ground
than after it landed.

3. Centre of pressure, where there are cells and no inertial sensors: towards toe-off it moves inwards, to the big toe.
Insoles whose cells are numbered as mirror images of each other look alike when they are exchanged together with their
layouts; this evidence does not show that.

Both feet must agree, over eight strides each. Nothing is reported of feet that hardly roll: a wearer who shuffles or
climbs may be detected late or never. Of 93 recordings of both feet (healthy walkers and patients, a treadmill, stairs,
50 to 200 Hz) none is reported as exchanged, and 51 are when they are exchanged; of the others all but 9 have fewer than
eight strides of a foot. A sensor frame that is left-handed on both feet (the sign of an axis is lost) mirrors the
motion, and a mirrored left foot looks like a right one: it is reported as exchanged feet, and is as wrong."""

from __future__ import annotations

from bisect import bisect_right
from math import hypot, sqrt

from ...events import StrideTaken, ToeOff
from ...foot.view import FootView
from ...types import Foot, Layout, Vec3
from ...types.attrs import define, field
from ...types.vector import rotate_back
from .rate_integral import RateIntegral

UP: Vec3 = (0.0, 0.0, 1.0)
SAMPLE_INTERVAL = 0.0195
"""Shortest interval at which the angular rate is integrated, s: about 50 Hz."""
LONGEST_GAP = 0.11
"""Longest gap between samples over which the turn of the foot is still known, s."""
MOST_INSTANTS = 80
"""Largest number of instants kept of the turn.

At 50 Hz they are at least the last 1.4 s of a stride: a push-off, a swing and the loading after it."""
PUSH_OFF = 0.3
"""Approximate time before toe-off during which the foot turns over its toes, s."""
LEAST_PUSH_OFF_TURN = 0.25
"""Least turn of the foot in the push-off of a stride that counts, rad."""
TIME_TOLERANCE = 1e-4
"""Tolerance of the times of instants, s."""
FEWEST_INSTANTS = 4
"""Least number of instants in a swing that counts."""
SHORTEST_STRIDE = 0.4
"""Length of the shortest stride that counts, m."""
LARGEST_HEADING_CHANGE = 0.35
"""Largest heading change of a stride that counts, rad."""
CENTRE_INTERVAL = 0.05
"""Shortest interval between two values of the centre of pressure, s."""
MOST_CENTRES = 40
"""Largest number of values of the centre of pressure that are kept."""
MEAN_SPAN = 24.0
"""Span of the running means, strides of one foot."""
LEAST_STRIDES = 8
"""Least number of strides of each foot before anything is reported."""
ROLL_LIMIT, CENTRE_LIMIT = 0.02, 0.002
"""Limits above which both feet look exchanged: roll, rad, and movement of the centre of pressure, m."""


@define
class Average:
    """Running mean and variance; the last `MEAN_SPAN` values count most."""

    count: int = 0
    mean: float = 0.0
    variance: float = 0.0

    def add(self, value: float) -> None:
        """Add one value."""
        self.count += 1
        k = 1.0 / min(float(self.count), MEAN_SPAN)
        off = value - self.mean
        self.mean += k * off
        self.variance = (1.0 - k) * (self.variance + k * off * off)

    def exceeds(self, limit: float, least: int) -> bool:
        """Return whether there are `least` values and the mean is above the limit by twice its standard error."""
        if self.count < least:
            return False
        return self.mean - 2.0 * sqrt(self.variance / min(float(self.count), MEAN_SPAN)) > limit


@define
class SwapEvidence:
    """Evidence that one foot is the other one; positive values speak for it."""

    roll: Average = field(factory=Average)
    """Inward roll of the foot at heel-strike against its mean over the swing, rad."""
    centre: Average = field(factory=Average)
    """Outward movement of the centre of pressure before toe-off, m."""
    mirrored: bool = False
    """Flag: the layout is the other foot's."""
    declared: bool = False
    """Flag: the device reports itself to be on this foot."""
    left_axis: Vec3 | None = None
    """Unit vector to the left, as the foot turns over its toes, sensor frame."""
    turned: RateIntegral = field(factory=RateIntegral)
    """Integral of the angular rate over the last stride."""
    centre_at: float | None = None
    """Time of the newest value of the centre of pressure, s."""
    centre_ys: list[float] = field(factory=list)
    """Values of the centre of pressure's y over this contact, m, sole frame."""


@define
class Sides:
    """Detects exchanged feet from the evidence of both; does nothing where a device reports the foot it is on.

    It costs an integral at 50 Hz, or a centre of pressure at 20 Hz for an insole alone."""

    left: SwapEvidence = field(factory=SwapEvidence, init=False)
    right: SwapEvidence = field(factory=SwapEvidence, init=False)

    def update(self, view: FootView) -> bool:
        """Add one sample of a foot and return whether both feet now look like the other one."""
        is_left = view.foot is Foot.LEFT
        side = self.left if is_left else self.right
        self.add_sample(side, view)
        if not view.events:
            return False
        evidence_changed = False
        for event in view.events:
            if isinstance(event, StrideTaken):
                evidence_changed = True
                _add_landing(side, event, rotate_back(view.attitude, UP))
                side.turned.keep_newest()
            elif isinstance(event, ToeOff) and side.centre_ys:
                evidence_changed = True
                _add_contact(side, is_left)
        if not evidence_changed:
            return False
        layout = view.after.layout
        side.mirrored = layout is not None and layout.foot is not view.foot
        return self._agree()

    def add_sample(self, side: SwapEvidence, view: FootView) -> None:
        """Add one sample of the foot on that side to the evidence."""
        if self.left.declared or self.right.declared:
            return
        gyro = view.sample.gyro
        if gyro is None:
            if view.moved_at is None and view.sample.pressure:
                _add_centre(side, view.t, None if view.pressed is None else view.pressed.centre_alone)
            return
        t, turned = view.t, side.turned
        dt = LONGEST_GAP if turned.t is None else t - turned.t
        if 0.0 <= dt < SAMPLE_INTERVAL:
            return
        if 0.0 < dt < LONGEST_GAP:
            turned.add(t, dt, gyro, MOST_INSTANTS)
        else:
            turned.restart(t)

    def set_layout(self, foot: Foot, layout: Layout) -> None:
        """Set the layout that the device on `foot` has reported, and with it the foot that it is made for."""
        side = self.left if foot is Foot.LEFT else self.right
        side.declared = layout.foot is foot
        if side.declared:
            self.reset()

    def reset(self) -> None:
        """Discard the recent motion of both feet, which is not needed any more."""
        for side in (self.left, self.right):
            side.turned.clear()
            side.centre_ys = []

    def _agree(self) -> bool:
        left, right = self.left, self.right
        if left.mirrored and right.mirrored:
            return True
        if left.declared or right.declared:
            return False
        if left.roll.count or right.roll.count:
            return left.roll.exceeds(ROLL_LIMIT, LEAST_STRIDES) and right.roll.exceeds(ROLL_LIMIT, LEAST_STRIDES)
        return left.centre.exceeds(CENTRE_LIMIT, LEAST_STRIDES) and right.centre.exceeds(CENTRE_LIMIT, LEAST_STRIDES)


def _add_landing(side: SwapEvidence, step: StrideTaken, up: Vec3) -> None:
    """Add the roll of the foot at the heel-strike of a finished stride; `up` is in the sensor frame, at foot-flat."""
    t_toe_off, t_heel_strike = step.t_toe_off, step.t_heel_strike
    if t_toe_off is None or t_heel_strike is None or step.degraded:
        return
    if step.length < SHORTEST_STRIDE or abs(step.heading_change) > LARGEST_HEADING_CHANGE:
        return
    turned = side.turned
    times = turned.times()
    if not times or times[0] > t_toe_off - PUSH_OFF:
        return
    off, landed = bisect_right(times, t_toe_off + TIME_TOLERANCE), bisect_right(times, t_heel_strike + TIME_TOLERANCE)
    if landed - off < FEWEST_INSTANTS:
        return
    *_, pushed = turned.between(bisect_right(times, t_toe_off - PUSH_OFF + TIME_TOLERANCE) - 1, off)
    *_, after = turned.between(landed - 1, len(times))
    if hypot(*pushed) < LEAST_PUSH_OFF_TURN or hypot(*after) > hypot(*pushed):  # the second: the wearer walks backwards
        return
    k = 1.0 / hypot(*pushed)
    x, y, z = pushed
    axis = (k * x, k * y, k * z)
    if side.left_axis is not None:
        u, v, w = side.left_axis
        axis = (u + 0.2 * (axis[0] - u), v + 0.2 * (axis[1] - v), w + 0.2 * (axis[2] - w))
    side.left_axis = axis
    ahead = _ahead(axis, up)
    if ahead is None:
        return
    a, b, c = ahead
    angles = [a * x + b * y + c * z for x, y, z in turned.between(off, landed)]  # right-handed: the left edge rises
    outwards = sum(angles) / len(angles) - angles[-1]
    side.roll.add(-outwards if step.foot is Foot.LEFT else outwards)


def _ahead(left: Vec3, up: Vec3) -> Vec3 | None:
    """Return the unit vector to the toe; None when the foot turned about the vertical, not over its toes."""
    lx, ly, lz = left
    ux, uy, uz = up
    x, y, z = ly * uz - lz * uy, lz * ux - lx * uz, lx * uy - ly * ux
    length = hypot(x, y, z)
    return (x / length, y / length, z / length) if length > 0.5 else None


def _add_centre(side: SwapEvidence, t: float, centre: tuple[float, float] | None) -> None:
    """Add the centre of pressure of an insole without an inertial sensor, at most every `CENTRE_INTERVAL`."""
    if side.centre_at is not None and 0.0 <= t - side.centre_at < CENTRE_INTERVAL:
        return
    side.centre_at = t
    if centre is None:
        return
    side.centre_ys.append(centre[1])
    if len(side.centre_ys) > MOST_CENTRES:
        del side.centre_ys[: MOST_CENTRES // 2]


def _add_contact(side: SwapEvidence, is_left: bool) -> None:
    """Add the sideways movement of the centre of pressure from the middle of the finished contact to its end."""
    ys, side.centre_ys = side.centre_ys, []
    n = len(ys)
    if n < 6:
        return
    middle, last = ys[n // 3 : n - n // 3], ys[n - n // 6 :]
    left = sum(last) / len(last) - sum(middle) / len(middle)
    side.centre.add(left if is_left else -left)
