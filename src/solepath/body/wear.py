"""Faults of wearing, for any recipe: a silent foot (no samples during a walk), and exchanged feet."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Sequence
from math import fsum, hypot, sqrt
from struct import Struct

from ..events import Defect, DefectFound, FeetSwapped, FootResumed, FootSilent, StrideTaken, ToeOff
from ..foot.view import FootView
from ..types import OTHER, Foot, Layout, PerFoot, Quat, Vec2, Vec3, per_foot
from ..types.attrs import ROW_SIZE, define, field, frozen, state, stateful
from ..types.vector import UP, ZERO, add, cross, dot, rotate_back, sub
from .part import Inputs, LayoutReported, Outputs, Part, PartOutput

# Integral of a foot's angular rate over the last second or two, which `Sides` uses.

INSTANT = Struct("<d3f")
"""Time of an instant, s, and the components of the integral, rad."""


@define
class RateIntegral:
    """The integral of the angular rate, rad, by component in the sensor frame (it is not an attitude)."""

    t: float | None = None
    """Time of the newest instant, s; None before any."""
    turn: Vec3 = ZERO
    """Integral up to the newest instant, rad."""
    instants: bytes = field(default=b"", metadata={ROW_SIZE: INSTANT.size})
    """The newest instants, oldest first, as `INSTANT` packs them."""

    def restart(self, t: float) -> None:
        """Start a new integral at `t`, s, because the turn before is not known."""
        self.t, self.turn, self.instants = t, ZERO, INSTANT.pack(t, *ZERO)

    def add(self, t: float, dt: float, gyro: Vec3) -> None:
        """Add an angular rate, rad/s, at `t`, s; `dt`, s, is the time since the newest instant.

        When there are `MAX_INSTANTS` instants, the oldest eighth is discarded."""
        (x, y, z), (u, v, w), kept = self.turn, gyro, self.instants
        self.t, self.turn = t, (x + u * dt, y + v * dt, z + w * dt)
        if len(kept) >= MAX_INSTANTS * INSTANT.size:
            kept = kept[MAX_INSTANTS // 8 * INSTANT.size :]
        self.instants = kept + INSTANT.pack(t, *self.turn)

    def turns_between(self, i: int, j: int) -> list[Vec3]:
        """Return the turn since instant `i` at each instant from `i` to before `j`, rad."""
        rows = list(INSTANT.iter_unpack(self.instants))
        return [sub((x, y, z), rows[i][1:]) for _, x, y, z in rows[i:j]]


# Detection of exchanged feet: the sensors of the left and the right foot are swapped.
#
# There are three kinds of evidence, the most reliable first:
#
# 1. Layouts: the left foot's device has the layout of a right insole, and the other way round. A device whose layout
# fits its foot is trusted, even if the other evidence contradicts it.
#
# 2. Roll of the foot, with inertial sensors. A foot lands on the outer edge of its heel, so at heel-strike it is rolled
# outwards relative to its mean over the swing. The axes are found from the motion, so mounting does not matter: up is
# the vertical at foot-flat, and left is the axis about which the foot turns over its toes. A wearer who walks backwards
# turns the foot over the heel, and these axes then make the feet look exchanged. The foot turns further over the toes
# than over the heel, so a stride counts only if the foot turned further before toe-off than after heel-strike.
#
# 3. Centre of pressure, with pressure cells and no inertial sensors. Before toe-off the centre moves inwards, to the
# big toe. This evidence fails when insoles with mirrored cell numbers are exchanged together with their layouts.
#
# Both feet must agree, over eight strides each. If a wearer shuffles or climbs, the feet hardly roll, and an exchange
# may be detected late or never. Of 93 recordings of both feet (healthy walkers and patients, a treadmill, stairs, 50 to
# 200 Hz), none is reported as exchanged. With left and right exchanged, 51 of them are reported; all but 9 of the
# others have fewer than eight strides of a foot. If the sensor frames of both feet are left-handed (an axis has the
# wrong sign), the motion is mirrored and a left foot looks like a right foot. That wrong data is also reported as
# exchanged feet.

SAMPLE_INTERVAL = 0.0195
"""Shortest interval at which the angular rate is integrated, s: about 50 Hz."""
MAX_GAP = 0.11
"""Longest gap between samples over which the angular rate is integrated, s."""
MAX_INSTANTS = 80
"""Largest number of instants of the integral that are kept.

At 50 Hz they cover at least the last 1.4 s of a stride: push-off, swing and loading."""
PUSH_OFF_TIME = 0.3
"""Approximate time before toe-off during which the foot turns over its toes, s."""
MIN_PUSH_OFF_TURN = 0.25
"""Least turn of the foot in the push-off of a stride that counts, rad."""
TIME_TOLERANCE = 1e-4
"""Tolerance in comparing the times of instants, s."""
MIN_INSTANTS = 4
"""Least number of instants in a swing that counts."""
MIN_STRIDE_LENGTH = 0.4
"""Length of the shortest stride that counts, m."""
MAX_HEADING_CHANGE = 0.35
"""Largest heading change of a stride that counts, rad."""
CENTRE_INTERVAL = 0.05
"""Shortest interval between two values of the centre of pressure, s."""
MAX_CENTRES = 40
"""Largest number of values of the centre of pressure that are kept."""
MEAN_SPAN = 24.0
"""Number of strides of one foot that the running means cover."""
MIN_STRIDES = 8
"""Least number of strides of each foot before exchanged feet are reported."""
ROLL_LIMIT, CENTRE_LIMIT = 0.02, 0.002
"""Limits of the two means in `SwapEvidence` above which the feet look exchanged: roll, rad, and centre, m."""
AXIS_WEIGHT = 0.2
"""Weight of one stride in the low-pass filter of the axis to the left."""
MIN_CENTRES = 6
"""Least number of values of the centre of pressure in a stance that counts."""


@define
class RunningAverage:
    """The running mean and variance of values; older values fade after `MEAN_SPAN` values."""

    count: int = 0
    mean: float = 0.0
    variance: float = 0.0

    def add(self, value: float) -> None:
        """Add one value."""
        self.count += 1
        k = 1.0 / min(float(self.count), MEAN_SPAN)
        deviation = value - self.mean
        self.mean += k * deviation
        self.variance = (1.0 - k) * (self.variance + k * deviation * deviation)

    def exceeds(self, limit: float) -> bool:
        """Return whether there are `MIN_STRIDES` values and the mean exceeds the limit by two standard errors."""
        if self.count < MIN_STRIDES:
            return False
        return self.mean - 2.0 * sqrt(self.variance / min(float(self.count), MEAN_SPAN)) > limit


@define
class SwapEvidence:
    """The evidence that the device of a foot is worn on the other foot; positive values support an exchange."""

    roll: RunningAverage = field(factory=RunningAverage)
    """Inward roll of the foot at heel-strike minus its mean inward roll over the swing, rad."""
    centre: RunningAverage = field(factory=RunningAverage)
    """Outward movement of the centre of pressure before toe-off, m."""
    mirrored: bool = False
    """Flag: the layout is made for the other foot."""
    left_axis: Vec3 | None = None
    """Unit vector to the left, the axis of the foot's turn over its toes, sensor frame; None before any stride."""
    turn_integral: RateIntegral = field(factory=RateIntegral)
    """Integral of the angular rate over the stride under way."""
    centre_at: float | None = None
    """Time of the newest value of the centre of pressure, s."""
    centre_ys: list[float] = field(factory=list)
    """Values of the centre of pressure's y in this stance, m, foot frame."""


@stateful
class Sides:
    """Detects exchanged feet from the evidence of both feet, unless a device has reported a layout that fits its foot.

    Cost: an integral at 50 Hz, or a centre of pressure at 20 Hz for an insole without inertial sensor."""

    feet: PerFoot[SwapEvidence] = state(factory=lambda: per_foot(SwapEvidence))
    declared: list[Foot] = state(factory=list)
    """Feet whose devices have reported a layout that is made for them."""

    def update(self, view: FootView, events: Sequence[object]) -> bool:
        """Add the events of a sample, after the sample, and return whether both feet now look exchanged."""
        side, evidence_changed = self.feet[view.foot], False
        for event in events:
            if isinstance(event, StrideTaken):
                evidence_changed = True
                _add_landing(side, event, view.attitude)
                side.turn_integral.instants = side.turn_integral.instants[-INSTANT.size :]
            elif isinstance(event, ToeOff) and side.centre_ys:
                evidence_changed = True
                _add_stance(side, view.foot is Foot.LEFT)
        if not evidence_changed or view.after is None:
            return False
        layout = view.after.layout
        side.mirrored = layout is not None and layout.foot is not view.foot
        return self._both_look_swapped()

    def add_sample(self, view: FootView) -> None:
        """Add one sample of a foot to its evidence."""
        if self.declared:
            return
        side, gyro = self.feet[view.foot], view.sample.gyro
        if gyro is None:
            if view.moved_at is None and view.sample.pressure:
                _add_centre(side, view.t, None if view.pressed is None else view.pressed.centre_alone)
            return
        t, rate_integral = view.t, side.turn_integral
        dt = MAX_GAP if rate_integral.t is None else t - rate_integral.t
        if 0.0 <= dt < SAMPLE_INTERVAL:
            return
        if 0.0 < dt < MAX_GAP:
            rate_integral.add(t, dt, gyro)
        else:
            rate_integral.restart(t)

    def set_layout(self, foot: Foot, layout: Layout) -> None:
        """Set the layout that the device on `foot` has reported."""
        self.declared = [one for one in self.declared if one is not foot]
        if layout.foot is foot:
            self.declared.append(foot)
            self.reset()

    def reset(self) -> None:
        """Discard the recent motion of both feet, which is no longer needed."""
        for side in self.feet.values():
            side.turn_integral, side.centre_ys = RateIntegral(), []

    def _both_look_swapped(self) -> bool:
        left, right = self.feet.values()
        if left.mirrored and right.mirrored:
            return True
        if self.declared:
            return False
        if left.roll.count or right.roll.count:
            return left.roll.exceeds(ROLL_LIMIT) and right.roll.exceeds(ROLL_LIMIT)
        return left.centre.exceeds(CENTRE_LIMIT) and right.centre.exceeds(CENTRE_LIMIT)


def _add_landing(side: SwapEvidence, stride: StrideTaken, attitude: Quat) -> None:
    """Add the roll of the foot at the heel-strike of a finished stride; `attitude` is that at foot-flat."""
    t_toe_off, t_heel_strike = stride.t_toe_off, stride.t_heel_strike
    if t_toe_off is None or t_heel_strike is None or stride.flaws:
        return
    if stride.length < MIN_STRIDE_LENGTH or abs(stride.heading_change) > MAX_HEADING_CHANGE:
        return
    rate_integral = side.turn_integral
    times = [t for t, *_ in INSTANT.iter_unpack(rate_integral.instants)]
    if not times or times[0] > t_toe_off - PUSH_OFF_TIME:
        return
    toe_off_index = bisect_right(times, t_toe_off + TIME_TOLERANCE)
    heel_strike_index = bisect_right(times, t_heel_strike + TIME_TOLERANCE)
    if heel_strike_index - toe_off_index < MIN_INSTANTS:
        return
    *_, push_off_turn = rate_integral.turns_between(
        bisect_right(times, t_toe_off - PUSH_OFF_TIME + TIME_TOLERANCE) - 1, toe_off_index
    )
    *_, landing_turn = rate_integral.turns_between(heel_strike_index - 1, len(times))
    turn_angle = hypot(*push_off_turn)
    if turn_angle < MIN_PUSH_OFF_TURN or hypot(*landing_turn) > turn_angle:  # the second condition: walking backwards
        return
    axis = add(ZERO, push_off_turn, 1.0 / turn_angle)
    if side.left_axis is not None:
        axis = add(side.left_axis, sub(axis, side.left_axis), AXIS_WEIGHT)
    side.left_axis = axis
    forward = cross(axis, rotate_back(attitude, UP))
    length = hypot(*forward)
    if length <= 0.5:  # the axis is nearly vertical
        return
    forward = add(ZERO, forward, 1.0 / length)
    turns = rate_integral.turns_between(toe_off_index, heel_strike_index)
    angles = [dot(forward, turn) for turn in turns]  # positive: the left edge rises
    leftward = fsum(angles) / len(angles) - angles[-1]
    side.roll.add(-leftward if stride.foot is Foot.LEFT else leftward)


def _add_centre(side: SwapEvidence, t: float, centre: Vec2 | None) -> None:
    """Add the centre of pressure of an insole without an inertial sensor, at most every `CENTRE_INTERVAL`."""
    if side.centre_at is not None and 0.0 <= t - side.centre_at < CENTRE_INTERVAL:
        return
    side.centre_at = t
    if centre is None:
        return
    side.centre_ys.append(centre[1])
    if len(side.centre_ys) > MAX_CENTRES:
        del side.centre_ys[: MAX_CENTRES // 2]


def _add_stance(side: SwapEvidence, is_left: bool) -> None:
    """Add the lateral movement of the centre of pressure from the middle of the finished stance to its end."""
    ys, side.centre_ys = side.centre_ys, []
    n = len(ys)
    if n < MIN_CENTRES:
        return
    middle_values, end_values = ys[n // 3 : n - n // 3], ys[n - n // 6 :]
    leftward = fsum(end_values) / len(end_values) - fsum(middle_values) / len(middle_values)
    side.centre.add(leftward if is_left else -leftward)


@define
class FootSilence:
    """The time without samples of one foot."""

    t: float | None = None
    """Time of the newest sample, s; None before any, and of a stuck sensor, which is said then."""
    strides_since: int = 0
    """Number of strides that the other foot has taken since `t`."""
    silent: bool = False
    """Flag: the silence of this foot was reported."""


@frozen
class WearSettings:
    """The settings of `Wear`."""

    strides: int = 3
    """Number of strides of the other foot, since the last sample of a foot, from which that foot is silent."""
    seconds: float = 3.0
    """Least time since the last sample of a foot before that foot is silent, s."""


@stateful
class Wear(Part):
    """Detects a silent foot and exchanged feet from the samples of both feet.

    A foot that had samples is silent when, since its last sample, the other foot has taken `strides` strides and
    `seconds` have passed. FootSilent reports the silence; FootResumed comes with the foot's next sample. Nothing is
    reported while the wearer stands, or for a foot that never had a sample, because a recording may be of one foot.
    Recipes of two feet continue with the other foot. FeetSwapped is reported once, when `Sides` detects exchanged
    feet."""

    needs_samples = True
    notices = (LayoutReported,)

    settings: WearSettings = field(default=WearSettings())
    sides: Sides = state(factory=Sides)
    feet: PerFoot[FootSilence] = state(factory=lambda: per_foot(FootSilence))
    swapped: bool = False
    """Flag: exchanged feet were reported."""

    def feed(self, events: Inputs, view: FootView | None) -> Outputs:
        """Add one sample of a foot; return events of a silent foot, a resumed foot or exchanged feet."""
        is_stuck = False
        for event in events:
            if isinstance(event, LayoutReported) and event.site.foot is not None:
                self.sides.set_layout(event.site.foot, event.layout)
            elif isinstance(event, DefectFound):
                is_stuck |= event.defect is Defect.REPEATED
        if view is None:
            return ()
        t, this, other = view.t, self.feet[view.foot], self.feet[OTHER[view.foot]]
        outputs: list[PartOutput] = []
        if this.silent:
            this.silent = False
            silence = 0.0 if this.t is None else max(0.0, t - this.t)
            outputs.append(FootResumed(t=t, known_at=view.known_at, foot=view.foot, silent_for=silence))
        this.t, this.strides_since = None if is_stuck else t, 0
        if view.after is not None and view.after.covariance is not None:  # a stride has ended
            other.strides_since += 1
        if other.strides_since and other.t is not None and not other.silent:
            if t < other.t:
                other.strides_since = 0  # this foot's samples are late, or its clock has restarted
            elif other.strides_since >= self.settings.strides and t - other.t >= self.settings.seconds:
                other.silent = True
                outputs.append(FootSilent(t=t, known_at=view.known_at, foot=OTHER[view.foot], silent_for=t - other.t))
        if not self.swapped and other.t is not None:  # both feet must agree
            self.sides.add_sample(view)
            if events and self.sides.update(view, events):
                self.swapped = True
                self.sides.reset()
                outputs.append(FeetSwapped(t=t, known_at=view.known_at))
        return outputs
