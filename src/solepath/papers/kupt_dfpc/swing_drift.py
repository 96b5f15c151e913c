"""Corrector of KUPT as printed: the velocity is known from heel-strike to toe-off, in swing its drift is linear (8).

Chen et al., "Smart insole-based indoor localization system for Internet of Things applications" (IEEE Internet of
Things Journal 6, 2019), section III.C.3, equation (8), and section III.C.4, error index (10). The known velocities come
from known_velocity.py. A raw velocity is integrated from motion start without correction. The integral of (8) is
computed at motion end (`SwingDedrift._calibrated_displacement`); single velocities V_calibrated are not kept."""

from __future__ import annotations

from math import hypot, inf
from typing import ClassVar

from ...foot.navigate.dedrift import LinearDedrift
from ...foot.phase import Cue
from ...foot.stance.stance import Stance
from ...types import Phase, Quat, Vec3
from ...types.attrs import frozen, stateful
from ...types.vector import TIME_EPSILON, ZERO, add, sub

SHORT_GAP = 0.08
"""Longest gap in a normal motion, s: one lost sample at the paper's 30 Hz leaves 0.067 s."""
LARGEST_ROLLING_SIGMA = 0.2
"""Sigma above which evidence of a rolling shoe is not used, m/s."""


@frozen
class MotionMoment:
    """The state of the integration at one sample of a motion, navigation frame."""

    elapsed: float
    """Time since motion start, s."""
    interval: float
    """Time since the sample before, s."""
    raw_displacement: Vec3
    """Integral of the raw velocity, m."""
    known_displacement: Vec3
    """Integral of the known velocities, m."""
    error: Vec3 | None
    """Mean raw velocity minus known velocity over the interval that ended here, m/s; None when unknown."""
    drift: float = 0.0
    """Sum since motion start of the squared changes of specific force between samples times time, m^2/s^2."""

    @property
    def error_time(self) -> float:
        """Time of `error` since motion start, s: the middle of its interval."""
        return self.elapsed - 0.5 * self.interval


@stateful
class SwingDedrift(LinearDedrift):
    """Corrector with known velocities on the ground; in swing the drift is linear between toe-off and heel-strike (8).

    Velocities are known from motion start to toe-off and from heel-strike to motion end, as means over the interval
    between two samples. So they are compared with the mean of the raw velocity over the same interval. The differences,
    the errors of (8), are those in the middle of the last interval before toe-off and, as in (5), of the first one
    after heel-strike. That V_errt belongs to the interval before toe-off is our reading: (7) has P(k + 1) - P(k), which
    at k_t is the interval after it, in which the shoe no longer rolls. Known velocities are used on all three axes,
    because (8) singles out none. If the heel never rolled, swing lasts until motion end, and the error is that at
    motion end. While the foot moves, the live position follows the known velocities. In swing it is integrated from the
    last of them. At motion end it is corrected in one jump.

    A motion is abnormal without toe-off or heel-strike, with a gap, or without a usable velocity at toe-off. Then one
    linear drift over the whole motion is removed, as with ZUPT. Four moments are kept, however long the motion."""

    slide_time: ClassVar[float] = 0.0
    """Time after heel-strike in which the heel still slides, s: none as printed."""
    largest_rolling_error: ClassVar[float] = inf
    """Largest horizontal difference of rolling and raw velocity in push-off that is used, m/s: any as printed."""

    motion_start: Vec3 = ZERO
    """Position where the motion started, m."""
    raw_velocity: Vec3 = ZERO
    """Velocity by integration from motion start without correction, m/s."""
    raw_displacement: Vec3 = ZERO
    """Integral of the raw velocity since motion start, m."""
    known_displacement: Vec3 = ZERO
    """Integral of the known velocities since motion start, m."""
    interval_velocity: Vec3 = ZERO
    """Mean raw velocity over the last interval, m/s."""
    interval: float = 0.0
    """Time between the last two samples, s."""
    current: MotionMoment | None = None
    """State at the last sample; None after a gap."""
    previous: MotionMoment | None = None
    """State at the sample before the last; None after a gap."""
    toe_off: MotionMoment | None = None
    """State at the best candidate for toe-off."""
    heel_strike: MotionMoment | None = None
    """State at heel-strike, or at the end of the slide after it."""
    heel_roll: MotionMoment | None = None
    """State at the first sample after it to which the heel rolled; None before."""
    standing: bool = True
    """Flag: the last sample was in stance; a motion starts with the next sample."""
    moved: bool = False
    """Flag: the motion has a sample without zero velocity."""
    has_gap: bool = False
    """Flag: the motion has a gap."""
    last_error_index: float | None = None

    @property
    def error_index(self) -> float | None:
        """Error index (10), m/s: horizontal length of V_errt + V_errh, the errors at toe-off and heel-strike.

        It is None for an abnormal motion. (10) leaves open how three components make one number."""
        return self.last_error_index

    def start(self, attitude: Quat, tilt_sigma: float) -> None:
        LinearDedrift.start(self, attitude, tilt_sigma)
        self._start_motion()
        self.last_error_index = None

    def predict(self, dt: float, acc: Vec3, gyro: Vec3, saturated: bool = False) -> None:
        if self.standing:
            self._start_motion()
        velocity, raw_velocity = self.velocity, self.raw_velocity
        LinearDedrift.predict(self, dt, acc, gyro, saturated)
        change = sub(self.velocity, velocity)
        self.raw_velocity = add(raw_velocity, change)
        self.interval_velocity = add(raw_velocity, change, 0.5)
        self.raw_displacement = add(self.raw_displacement, self.interval_velocity, dt)
        self.interval = dt

    def correct(self, t: float, stance: Stance) -> bool:
        hint = stance.hint
        rolls = hint is Phase.PUSH_OFF or hint is Phase.LOADING
        if stance.sigma <= self.settings.largest_stance_sigma and not rolls and hint is not Phase.SWING:
            self._end_motion()
            return True
        self.moved = True
        self.previous = previous = self.current
        error = known_error = None
        if rolls and stance.sigma <= LARGEST_ROLLING_SIGMA:
            error = known_error = self._use_velocity(stance.v_ref, hint is Phase.PUSH_OFF)
        elif previous is not None and previous.error is not None:
            # no new evidence: the error is taken to be that of the previous interval
            self._add_known(sub(self.interval_velocity, previous.error))
            error = None if hint is Phase.SWING else previous.error
        self.current = self._moment(error)
        landed = self.heel_strike if self.heel_roll is None else None
        if known_error is not None and previous is not None and landed is not None:
            slid = previous.elapsed - landed.elapsed >= self.slide_time - TIME_EPSILON
            self.heel_strike, self.heel_roll = (previous, self.current) if slid else (landed, None)
        return False

    def _moment(self, error: Vec3 | None) -> MotionMoment:
        return MotionMoment(self.swing, self.interval, self.raw_displacement, self.known_displacement, error)

    def _use_velocity(self, v_ref: Vec3, push_off: bool) -> Vec3 | None:
        """Use the known velocity over the last interval; return the raw velocity's error, None if it is too large."""
        error = sub(self.interval_velocity, v_ref)
        if push_off and hypot(error[0], error[1]) > self.largest_rolling_error:
            self._add_known(self.interval_velocity)
            return None
        self._add_known(v_ref)
        # the live position moves with the known velocity; the live velocity is the raw velocity minus its error.
        # Integration used the mean of old and new velocity over this interval; replace it by v_ref.
        mean = sub(self.velocity, sub(self.raw_velocity, self.interval_velocity))
        self.position = add(self.position, sub(v_ref, mean), self.interval)
        self.velocity = sub(self.raw_velocity, error)
        return error

    def _add_known(self, velocity: Vec3) -> None:
        self.known_displacement = add(self.known_displacement, velocity, self.interval)

    def mark(self, t: float, cue: Cue) -> None:
        """Set the candidate: for toe-off the sample before this one (A of fig. 4), for heel-strike this one (D)."""
        if cue is Cue.CLEAR:
            self.toe_off = self.previous
        elif cue is Cue.CONTACT:
            self.heel_strike, self.heel_roll = self.current, None

    def _end_motion(self) -> None:
        """End the motion, or add one more sample of stance."""
        duration = self.swing
        if self.moved:
            self.last_error_index = None
        displacement = self._calibrated_displacement(duration)
        if displacement is None:
            displacement = add(self.raw_displacement, self.raw_velocity, -0.5 * duration)
        self.position = add(self.motion_start, displacement)
        self.velocity = ZERO
        self._level()
        self.swing = 0.0
        self.standing = True

    def _calibrated_displacement(self, duration: float) -> Vec3 | None:
        """Return the displacement of a normal motion that ends here, m: (8) integrated; set the error index (10).

        It is None if the motion is abnormal."""
        toe_off, landed, roll = self.toe_off, self.heel_strike, self.heel_roll
        if self.has_gap or toe_off is None or toe_off.error is None or landed is None:
            return None
        if roll is None or roll.error is None:  # the heel never rolled: the velocity is zero where the foot stands
            error, error_time = self.raw_velocity, duration
            landed = self._moment(error)
        else:
            # in the last interval, before the foot rests, the error is taken to be unchanged
            error, error_time = roll.error, roll.error_time
            self._add_known(sub(self.interval_velocity, error))
        drift_start = toe_off.error_time
        if error_time <= drift_start:
            return None
        # integral over the swing of (k - k_t) / (k_h - k_t), for V_raw - V_errt - driftrate (k - k_t)
        drift_time = (
            0.5
            * ((landed.elapsed - drift_start) ** 2 - (toe_off.elapsed - drift_start) ** 2)
            / (error_time - drift_start)
        )
        swing = sub(landed.raw_displacement, toe_off.raw_displacement)
        swing = add(swing, toe_off.error, toe_off.elapsed - landed.elapsed)
        swing = add(swing, sub(error, toe_off.error), -drift_time)
        self.last_error_index = hypot(toe_off.error[0] + error[0], toe_off.error[1] + error[1])
        return sub(add(add(toe_off.known_displacement, swing), self.known_displacement), landed.known_displacement)

    def _start_motion(self) -> None:
        self.motion_start = self.position
        self.raw_velocity = self.velocity
        self.raw_displacement = self.known_displacement = ZERO
        self.current = self.previous = self.toe_off = self.heel_strike = self.heel_roll = None
        self.standing = self.moved = self.has_gap = False

    def bridge(self, dt: float) -> float:
        if self.standing:
            self._start_motion()
        integration_time = LinearDedrift.bridge(self, dt)
        if integration_time == 0.0:
            self._start_motion()  # after a long gap: from the same position, at rest
        if dt > SHORT_GAP:
            self.has_gap = True
            self.current = self.previous = None
        self.moved = True
        return integration_time

    def infill(self, dt: float, attitude: Quat, velocity: Vec3, position: Vec3) -> None:
        if self.standing:
            self._start_motion()
        LinearDedrift.infill(self, dt, attitude, velocity, position)
        self.raw_velocity = velocity
        self.raw_displacement = sub(position, self.motion_start)
        self.current = self.previous = None
        self.moved = self.has_gap = True
