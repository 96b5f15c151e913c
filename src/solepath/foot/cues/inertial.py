"""Cues from the inertial sensor, with hysteresis and debounce.

`InertialCues` uses stillness and the sagittal rate, which is the angular rate about the axis to the wearer's left:
positive is toe down. During a stride this rate rises as the heel lifts and has a peak of several rad/s at push-off. It
is negative for a long time while the leg swings, and returns through zero as the heel lands. Toe-off is the moment at
which the rate has fallen to half its peak, because there it falls most steeply. Such landmarks are common in gait
analysis (Sabatini et al., IEEE Trans. Biomed. Eng. 52, 2005; Mariani et al., Gait & Posture 37, 2013). The ground may
stop the foot earlier or later than the rate returns through zero, so heel-strike is the onset of the impact
(`Impact`).

Numbers without a source were chosen by hand on the recordings of docs/accuracy.md, those of heel-strike and toe-off on
recordings that contain such events. `solepath-lab sensitivity` prints the effect of half and of twice each."""

from __future__ import annotations

from collections.abc import Callable
from math import sqrt

from ...types import Phase, Vec3
from ...types.attrs import define, field
from ...types.vector import TIME_EPSILON, ZERO, add, dot, scaled, sub
from ..phase import LOADING, PUSH_OFF, STATIONARY, SWING, Cue, in_columns
from .cues import TimedCue

LEAST_PUSH_OFF_TURN = 0.25
"""Smallest turn of the foot in a push-off, rad."""
SAME_AXIS_COSINE = 0.5
"""Smallest cosine of the angle between the axes of two push-offs of one wearer: 60 degrees; no unit."""
OTHER_AXIS_PUSH_OFFS = 3
"""Number of push-offs in a row about another axis after which that axis replaces the learnt one."""
AXIS_GAIN = 0.2
"""Weight of the newest push-off in the learnt sagittal axis, 0 to 1."""
STILLNESS_DEBOUNCE = 0.009
"""Shortest duration of stillness that counts, and of motion that ends it, s."""
LEAST_PUSH_OFF_RATE = 1.5
"""Smallest peak of the sagittal rate in a push-off, rad/s."""
TOE_OFF_RATE_RATIO = 0.5
"""Ratio of the sagittal rate at toe-off to its peak in push-off; no unit."""
LANDING_RATE = 1.0
"""Rate through which the sagittal rate rises at about the landing of the heel, rad/s, toe down positive.

It is positive because the ground then turns the sole down."""
IMPACT_SETTLING_TIME = 0.045
"""Time after the onset of an impact at which that onset is final, s.

Heel-strike must be known within 60 ms at 100 Hz. With 55 ms the scatter is 0.1 to 0.4 ms less (chosen by hand)."""
LONGEST_IMPACT_TIME = 0.1
"""Longest time for which an impact is observed, s."""
LEAST_IMPACT_SHOCK, IMPACT_SIGHT_TIME = 5e3, 0.01
"""Shock of a landing and time since its onset that show an impact before the onset is final, m^2/s^5 and s.

With 1e4 fewer landings of slow walkers are seen, with 3e3 no more of them, and some earlier. With 0 s one in twenty is
seen 40 ms before its final onset, with 15 ms all are seen 7 ms later (chosen on `ipol_10m_uturn`, `slow_gait`,
`tripod_treadmill`, `marpino_heel_toe` and emulated walks)."""
LEAST_LANDING_SHOCK = 1e4
"""Smallest integral of the squared jerk that shows that a slow foot has landed, m^2/s^5.

This is 600 m/s^3 for 30 ms. Muscles that swing a leg reach half of that jerk, the ground some thousands of m/s^3."""
SHORTEST_SWING_TIME = 0.1
"""Shortest time from toe-off to heel-strike, s."""
SHUFFLE_SPEED = 0.35
"""Speed above which a foot that does not turn has left the ground without push-off, m/s."""
SHUFFLE_SPEED_PER_RATE = 0.2
"""Increase of SHUFFLE_SPEED for each rad/s of sagittal rate, m.

This is the largest distance of a sensor from the toes, over which the foot rolls."""
SHUFFLE_TIME = 0.15
"""Time for which a foot must be faster than SHUFFLE_SPEED to have left the ground, s."""
STILLNESS_DELAY = 0.02
"""Time from the start of stillness to its detection, s, because stillness is judged over a window."""
HEEL_DOWN_RATE = 0.12
"""Sagittal rate below which the heel has not left the ground, rad/s."""


SHOCK_MEMORY_TIME = 0.02
"""Time constant with which the shock decays before the foot lands, s."""


@define
class Impact:
    """The impact that ends one swing. Call `add_sample` for every sample of the swing.

    The turn of the foot, or the loss of its speed, shows that the foot has landed. The jerk, j = d acc / dt, shows the
    time. The ground stops the foot within some hundredths of a second: the force rises when the heel touches it and
    falls again when the foot has stopped, so that the squared jerk is large at both ends. Heel-strike is the first of
    them, a standard deviation before the mean time,

        t_HS = m - s,  m = sum t |j|^2 dt / sum |j|^2 dt,  s^2 = sum (t - m)^2 |j|^2 dt / sum |j|^2 dt.

    This needs no threshold on the force and works for any mounting and rate. It is not early when the sole turns down
    well before it bears weight. It is never before the foot has begun to turn down (LANDING_RATE): what shook the leg
    in the swing is no impact. "Shock" is the integral of the squared jerk, m^2/s^5."""

    shock: float = 0.0
    """Recent shock, m^2/s^5."""
    mean_time: float = 0.0
    """Mean time of `shock`, s."""
    spread: float = 0.0
    """Integral of the squared jerk times the squared time from `mean_time`, m^2/s^3."""
    onset: float = 0.0
    """Onset of `shock`, s."""
    peak_speed: float = 0.0
    """Largest speed of the swing so far, m/s."""
    peak_shock: float = 0.0
    """Largest shock since the foot had its largest speed, m^2/s^5."""
    peak_onset: float = 0.0
    """Onset of `peak_shock`, s."""

    def start_swing(self, t: float) -> None:
        """Start a swing at toe-off at `t`, s."""
        self.mean_time = self.onset = t
        self.shock = self.spread = self.peak_speed = self.peak_shock = 0.0

    def add_sample(self, t: float, dt: float, previous_acc: Vec3, acc: Vec3, speed: float, landing: bool) -> None:
        """Add one sample of the swing.

        `previous_acc` and `acc` are the specific force of the last sample and of this one, m/s^2. `speed` is in m/s.
        While `landing` is True the shock does not decay."""
        if speed > self.peak_speed:
            self.peak_speed = speed
            self.peak_shock = 0.0
        if dt <= 0.0:
            return
        x, y, z = acc
        px, py, pz = previous_acc
        x -= px
        y -= py
        z -= pz
        sample_shock = (x * x + y * y + z * z) / dt
        shock = self.shock
        if not landing:
            kept = 1.0 - dt / SHOCK_MEMORY_TIME if dt < SHOCK_MEMORY_TIME else 0.0
            shock *= kept
            self.spread *= kept
        self.shock = shock = shock + sample_shock
        if sample_shock > 0.0:
            after_mean, share = t - 0.5 * dt - self.mean_time, sample_shock / shock
            self.mean_time += after_mean * share
            self.spread += after_mean * after_mean * (1.0 - share) * sample_shock
            self.onset = self.mean_time - sqrt(self.spread / shock)
        if shock > self.peak_shock:
            self.peak_shock = shock
            self.peak_onset = self.onset


@define
class InertialCues:
    """Detects gait events from the inertial sensor: a small machine, whose states are the phases of the foot.

    Each sample first sets the timers of what the foot does (`still_since`, `moving_since` and `fast_since`; the others
    are those of a stance or of a swing). Then the signs of the phase are tried, in the order of STILL_SIGNS for a still
    foot and of MOVING_SIGNS for one that moves; the first that has lasted for long enough gives the cue. `describe`
    prints them.

    Latency: toe-off one sample; heel-strike IMPACT_SETTLING_TIME, or until the foot is still if no impact is found;
    foot-flat and heel-off STILLNESS_DEBOUNCE. `impact_at` is known IMPACT_SIGHT_TIME after the impact; a heel-strike
    follows within LONGEST_IMPACT_TIME, unless samples are missing."""

    still_since: float | None = None
    """Time since which zero velocity evidence is accepted, s; None while it is not."""
    moving_since: float | None = None
    """Time since which zero velocity evidence is not accepted, s; None while it is."""
    fast_since: float | None = None
    """Time since which a moving foot is faster than a shuffle, s; None while it is not, and after heel-strike."""
    turn: Vec3 = ZERO
    """Turn on the ground since the foot started to move, sensor frame, rad."""
    peak_rate: float = 0.0
    """Highest sagittal rate on the ground since the foot started to move, rad/s."""
    not_turning_at: float | None = None
    """Last time in this stance at which the foot did not turn, s; None before any, and in swing."""
    swing_start: float | None = None
    """Start of the last swing, s; None before any."""
    lowest_rate: float = 0.0
    """Lowest sagittal rate of this swing, rad/s."""
    landing_at: float | None = None
    """Time at which the sagittal rate rose through LANDING_RATE, s; None before that and after heel-strike."""
    impact_at: float | None = None
    """Onset of the impact of this swing by the sample that has shown it, s; None before that and in stance."""
    impact: Impact = field(factory=Impact)
    axis: Vec3 | None = None
    """Unit vector to the wearer's left, sensor frame, learnt from the turn of the foot at push-off; None at first."""
    other_axis_push_offs: int = 0
    """Number of push-offs in a row about another axis than `axis`."""
    turned_back: bool = False
    """Flag: the foot turns as in a swing in what is taken for a push-off, which is counted once."""
    force: Vec3 | None = None
    """Specific force of the last sample, sensor frame, m/s^2."""
    sagittal: float = 0.0
    """Sagittal rate of the last sample, rad/s; the norm of the rate while the axis is unknown."""

    def update(
        self, t: float, dt: float, acc: Vec3, gyro: Vec3, still: bool, speed: float, phase: Phase
    ) -> TimedCue | None:
        """Return the cue of one sample, or None.

        `acc` is in m/s^2, `gyro` in rad/s without bias. `still` is True when zero-velocity evidence was accepted.
        `speed` is in m/s."""
        previous_rate, axis = self.sagittal, self.axis
        gx, gy, gz = gyro
        if axis is None:
            rate = sqrt(gx * gx + gy * gy + gz * gz)
        else:
            x, y, z = axis
            rate = x * gx + y * gy + z * gz
        self.sagittal = rate
        previous_force, self.force = self.force, acc
        if still:
            self.moving_since = self.fast_since = None
            if self.still_since is None:
                self.still_since = t
        else:
            self.still_since = None
            if self.moving_since is None:
                self.moving_since = t
                self.turn = ZERO
                self.peak_rate = 0.0
            if speed < SHUFFLE_SPEED + SHUFFLE_SPEED_PER_RATE * (rate if rate > 0.0 else -rate):
                self.fast_since = None
            elif self.fast_since is None:
                self.fast_since = t
        if phase is SWING:
            self.not_turning_at = None
            if rate < self.lowest_rate:
                self.lowest_rate = rate
            if previous_force is not None:
                self.impact.add_sample(t, dt, previous_force, acc, speed, self.landing_at is not None)
        else:
            if rate < HEEL_DOWN_RATE and (still or self.not_turning_at is None):
                self.not_turning_at = t
            if not still:
                self.turn = add(self.turn, gyro, dt)
                if rate > self.peak_rate:
                    self.peak_rate = rate
        for sign, cue in (STILL_SIGNS if still else MOVING_SIGNS)[phase]:
            t_cue = sign(self, t, dt, speed, previous_rate)
            if t_cue is not None:
                return self._report(cue, t_cue)
        return None

    def _stood(self, t: float, dt: float, speed: float, previous_rate: float) -> float | None:
        """Return the time since which the foot stands still."""
        since = self.still_since
        return since - STILLNESS_DELAY if since is not None and t - since >= STILLNESS_DEBOUNCE - TIME_EPSILON else None

    def _moved(self, t: float, dt: float, speed: float, previous_rate: float) -> float | None:
        """Return the time at which the foot, which moves, last did not turn."""
        since = self.moving_since
        if since is None or t - since < STILLNESS_DEBOUNCE - TIME_EPSILON:
            return None
        return since if self.not_turning_at is None else min(self.not_turning_at, since)

    def _pushed_off(self, t: float, dt: float, speed: float, previous_rate: float) -> float | None:
        """Return the time at which a straight line between two samples falls through the rate of toe-off."""
        rate, toe_off_rate = self.sagittal, TOE_OFF_RATE_RATIO * self.peak_rate
        if self.peak_rate <= LEAST_PUSH_OFF_RATE or rate >= toe_off_rate:
            return None
        if not self._learn_axis():
            return None
        share = (previous_rate - toe_off_rate) / (previous_rate - rate) if previous_rate > toe_off_rate else 1.0
        return t - dt * (1.0 - share)

    def _shuffled(self, t: float, dt: float, speed: float, previous_rate: float) -> float | None:
        """Return the time since which the foot is too fast for one on the ground."""
        since = self.fast_since
        return since if since is not None and t - since >= SHUFFLE_TIME - TIME_EPSILON else None

    def _stopped(self, t: float, dt: float, speed: float, previous_rate: float) -> float | None:
        """Return the onset of the impact of a foot that stands still: of the landing, or the largest of the swing."""
        if self.landing_at is not None:
            return max(self.landing_at, self.impact.onset)
        t_stood = self._stood(t, dt, speed, previous_rate)
        return self.impact.peak_onset if t_stood is not None and self.impact.peak_shock > 0.0 else t_stood

    def _landed(self, t: float, dt: float, speed: float, previous_rate: float) -> float | None:
        """Return the onset of the impact of a landing, or of a foot that has become slow, once it is final."""
        landing_at, rate, impact = self.landing_at, self.sagittal, self.impact
        if landing_at is not None:
            onset = max(landing_at, impact.onset)
            settled = t - onset >= IMPACT_SETTLING_TIME - TIME_EPSILON
            if settled or t - landing_at >= LONGEST_IMPACT_TIME - TIME_EPSILON:
                return onset
            if self.impact_at is None and impact.shock >= LEAST_IMPACT_SHOCK and t - onset >= IMPACT_SIGHT_TIME:
                self.impact_at = onset
            return None
        if self.swing_start is not None and t - self.swing_start < SHORTEST_SWING_TIME - TIME_EPSILON:
            return None
        if previous_rate < LANDING_RATE <= rate and self.lowest_rate < 0.0 and self.axis is not None:
            self.landing_at = t - dt * (rate - LANDING_RATE) / (rate - previous_rate)
        elif (
            speed < SHUFFLE_SPEED
            and impact.peak_shock > LEAST_LANDING_SHOCK
            and t - impact.peak_onset >= IMPACT_SETTLING_TIME - TIME_EPSILON
        ):
            return impact.peak_onset
        return None

    def _report(self, cue: Cue, t: float) -> TimedCue:
        """Return a cue at `t`, s, and set the timers of the phase that it starts."""
        if cue is Cue.CLEAR:
            self.swing_start = t
            self.impact.start_swing(t)
            self.lowest_rate = self.peak_rate = 0.0
            self.landing_at = self.impact_at = None
        elif cue is Cue.LIFT:
            self.turned_back = False
        elif cue is Cue.CONTACT:
            self.peak_rate = 0.0
            self.turn = ZERO
            self.landing_at = self.impact_at = self.fast_since = None
        return TimedCue(cue, t)

    def reset(self) -> None:
        """Discard the times since which the foot is still or fast, because a gap counts as neither."""
        self.still_since = self.fast_since = None

    def restart(self) -> InertialCues:
        """Return cues for times that restart; the axis stays."""
        return InertialCues(axis=self.axis)

    def make_hidden_toe_off(self, t: float) -> TimedCue:
        """Return a toe-off at `t`, s, which a gap has hidden; the swing may go on after the gap."""
        return self._report(Cue.CLEAR, t)

    def apply_toe_off(self, phase: Phase) -> None:
        """Learn the sagittal axis from a toe-off that the load has shown in `phase`."""
        if phase is PUSH_OFF and self.peak_rate > LEAST_PUSH_OFF_RATE:
            self._learn_axis()

    def _learn_axis(self) -> bool:
        """Learn the sagittal axis from the turn as the heel lifts; return whether the turn was a push-off."""
        x, y, z = self.turn
        angle = sqrt(dot(self.turn, self.turn))
        if angle < LEAST_PUSH_OFF_TURN:
            return False
        newest = (x / angle, y / angle, z / angle)
        learnt = self.axis
        if learnt is None:
            self.axis = newest
            return True
        cosine = dot(learnt, newest)
        if cosine < SAME_AXIS_COSINE:
            # a single turn about another axis is no push-off; several in a row mean that the sensor was turned
            turns_back = cosine < -SAME_AXIS_COSINE
            if not (turns_back and self.turned_back):
                self.other_axis_push_offs += 1
            self.turned_back = turns_back
            if self.other_axis_push_offs < OTHER_AXIS_PUSH_OFFS:
                return False
            learnt = newest
        self.other_axis_push_offs = 0
        axis = add(learnt, sub(newest, learnt), AXIS_GAIN)
        self.axis = scaled(axis, 1.0 / sqrt(dot(axis, axis)))
        return True


Sign = Callable[[InertialCues, float, float, float, float], float | None]
"""Method that returns the time of a sign, s, or None: t and dt (s), speed (m/s), rate of the sample before (rad/s)."""
Signs = dict[Phase, tuple[tuple[Sign, Cue], ...]]

STILL_SIGNS: Signs = {
    LOADING: ((InertialCues._stood, Cue.FLAT),),
    STATIONARY: (),
    PUSH_OFF: ((InertialCues._stood, Cue.FLAT),),
    SWING: ((InertialCues._stopped, Cue.CONTACT),),
}
"""Signs of a still foot that end each phase, in the order in which they are tried, with their cues."""
MOVING_SIGNS: Signs = {
    LOADING: ((InertialCues._shuffled, Cue.CLEAR),),
    STATIONARY: ((InertialCues._moved, Cue.LIFT),),
    PUSH_OFF: ((InertialCues._pushed_off, Cue.CLEAR), (InertialCues._shuffled, Cue.CLEAR)),
    SWING: ((InertialCues._landed, Cue.CONTACT),),
}
"""The same of a foot that moves."""


def describe() -> str:
    """Return both tables as text."""
    rows = [
        [phase.name, foot, sign.__name__[1:], cue.value]
        for phase in STILL_SIGNS
        for foot, table in (("still", STILL_SIGNS), ("moving", MOVING_SIGNS))
        for sign, cue in table[phase]
    ]
    return in_columns([["phase", "foot", "sign", "cue"], *rows])
