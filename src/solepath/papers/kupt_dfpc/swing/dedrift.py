"""Corrector of KUPT: the velocity is known from heel-strike to toe-off, and a linear drift is removed from the swing.

Chen et al., "Smart insole-based indoor localization system for Internet of Things applications" (IEEE Internet of
Things Journal 6, 2019), section III.C.3, equations (8) and (10). The known velocities come from known_velocity.py. A
raw velocity is integrated from motion start without correction."""

from __future__ import annotations

from math import hypot

from ....foot.navigate.dedrift import LinearDedrift
from ....foot.phase import Cue
from ....foot.stance.stance import Stance
from ....types import Phase, Quat, Vec3
from ....types.attrs import define, field
from ....types.vector import TIME_EPSILON, ZERO
from .motion_moment import MotionMoment
from .settings import SwingSettings

SHORT_GAP = 0.08
"""Longest gap in a normal motion, s: one lost sample at the paper's 30 Hz leaves 0.067 s."""
LARGEST_ROLLING_SIGMA = 0.2
"""Sigma above which evidence of a rolling shoe is not used, m/s."""


@define
class SwingDedrift(LinearDedrift):
    """Corrector with known velocities on the ground; in swing the drift is linear between toe-off and heel-strike (8).

    Velocities are known from motion start to toe-off and from heel-strike to motion end, as means over the interval
    between two samples. So they are compared with the mean of the raw velocity over the same interval. The differences,
    the errors of (8), are those in the middle of the last interval before toe-off and, as in (5), of the first one
    after heel-strike. A heel does not roll at once: for `slide_time` it slides and the sole gives way, which (4) does
    not model. So k_h of (8) is the first sample at least that long after heel-strike; in the paper it is heel-strike
    itself. While the foot moves, the live position follows the known velocities. In swing it is integrated from the
    last of them. At motion end it is corrected in one jump. That V_errt belongs to the interval before toe-off is our
    reading: (7) has P(k + 1) - P(k), which at k_t is the interval after it, in which the shoe no longer rolls.

    The vertical rolling velocity is about L_r times the pitch rate, so a pivot that is 1 cm off at toe-off causes an
    error of 8 cm/s. In level walking a linear drift over the whole motion suffices for the height, and is used unless
    `vertical` is set.

    The raw velocity is zero at motion start. Some tenths of a second later, when the foot leaves the ground, its error
    cannot reach `largest_rolling_error`; in fig. 14, too, it drifts in swing and landing. On recorded insoles whose
    cells release the load late the foot then moves already and does not roll. So a rolling velocity in push-off that
    differs so much from the raw one is not used. If the heel never rolled, swing lasts until motion end, and the error
    is that at motion end.

    A motion is abnormal without toe-off or heel-strike, with a gap, or without a usable velocity at toe-off. Then one
    linear drift over the whole motion is removed, as with ZUPT. Four moments are kept, however long the motion."""

    settings: SwingSettings = SwingSettings()
    motion_start: Vec3 = field(default=ZERO, init=False)
    """Position where the motion started, m."""
    raw_velocity: Vec3 = field(default=ZERO, init=False)
    """Velocity by integration from motion start without correction, m/s."""
    raw_displacement: Vec3 = field(default=ZERO, init=False)
    """Integral of the raw velocity since motion start, m."""
    known_displacement: Vec3 = field(default=ZERO, init=False)
    """Integral of the known velocities since motion start, m."""
    interval_velocity: Vec3 = field(default=ZERO, init=False)
    """Mean raw velocity over the last interval, m/s."""
    interval: float = field(default=0.0, init=False)
    """Time between the last two samples, s."""
    current: MotionMoment | None = field(default=None, init=False)
    """State at the last sample; None after a gap."""
    previous: MotionMoment | None = field(default=None, init=False)
    """State at the sample before the last; None after a gap."""
    toe_off: MotionMoment | None = field(default=None, init=False)
    """State at the best candidate for toe-off."""
    toe_off_error_time: float = field(default=0.0, init=False)
    """Time of the error at toe-off, s since motion start; `heel_strike_error_time` likewise."""
    heel_strike: MotionMoment | None = field(default=None, init=False)
    heel_strike_error: Vec3 | None = field(default=None, init=False)
    heel_strike_error_time: float = field(default=0.0, init=False)
    previous_interval: float = field(default=0.0, init=False)
    standing: bool = field(default=True, init=False)
    """Flag: the last sample was in stance; a motion starts with the next sample."""
    moved: bool = field(default=False, init=False)
    """Flag: the motion has a sample without zero velocity."""
    has_gap: bool = field(default=False, init=False)
    """Flag: the motion has a gap."""
    last_error_index: float | None = field(default=None, init=False)

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
        ux, uy, uz = self.velocity
        LinearDedrift.predict(self, dt, acc, gyro, saturated)
        vx, vy, vz = self.velocity
        ux, uy, uz = vx - ux, vy - uy, vz - uz
        vx, vy, vz = self.raw_velocity
        self.raw_velocity = (vx + ux, vy + uy, vz + uz)
        vx, vy, vz = vx + 0.5 * ux, vy + 0.5 * uy, vz + 0.5 * uz
        self.interval_velocity = (vx, vy, vz)
        x, y, z = self.raw_displacement
        self.raw_displacement = (x + vx * dt, y + vy * dt, z + vz * dt)
        self.previous_interval, self.interval = self.interval, dt

    def correct(self, t: float, stance: Stance) -> bool:
        hint = stance.hint
        rolls = hint is Phase.PUSH_OFF or hint is Phase.LOADING
        if stance.sigma <= self.settings.largest_stance_sigma and not rolls and hint is not Phase.SWING:
            self._end_motion()
            return True
        self.moved = True
        self.previous = self.current
        error: Vec3 | None = None
        if rolls and stance.sigma <= LARGEST_ROLLING_SIGMA:
            error = self._use_velocity(stance.v_ref, hint is Phase.PUSH_OFF)
        elif self.previous is not None and self.previous.error is not None:
            # no new evidence: the error is taken to be that of the previous interval
            ex, ey, ez = self.previous.error
            vx, vy, vz = self.interval_velocity
            self._add_known((vx - ex, vy - ey, vz - ez))
            if hint is not Phase.SWING:
                error = self.previous.error
        self.current = self._moment(error)
        return False

    def _moment(self, error: Vec3 | None) -> MotionMoment:
        return MotionMoment(self.swing, self.raw_displacement, self.known_displacement, error)

    def _use_velocity(self, v_ref: Vec3, push_off: bool) -> Vec3 | None:
        """Use the known velocity over the last interval; return the raw velocity's error, None if it is too large."""
        (vx, vy, vz), (rx, ry, rz) = self.interval_velocity, v_ref
        error = (vx - rx, vy - ry, vz - rz)
        if push_off and hypot(error[0], error[1]) > self.settings.largest_rolling_error:
            self._add_known(self.interval_velocity)
            return None
        self._add_known(v_ref)
        # the live position moves with the known velocity; the live velocity is the raw velocity minus its error
        (ux, uy, uz), (px, py, pz) = self.raw_velocity, self.velocity
        # integration used the mean of old and new velocity over this interval; replace it by v_ref
        change = (ux - vx, uy - vy, uz - vz)  # half of the velocity's change over the interval
        x, y, z = self.position
        dt = self.interval
        self.position = (
            x + (rx - (px - change[0])) * dt,
            y + (ry - (py - change[1])) * dt,
            z + (rz - (pz - change[2])) * dt,
        )
        self.velocity = (ux - error[0], uy - error[1], uz - error[2])
        previous, heel_strike = self.previous, self.heel_strike
        is_settled = (
            previous is not None
            and heel_strike is not None
            and previous.elapsed - heel_strike.elapsed >= self.settings.slide_time - TIME_EPSILON
        )
        if is_settled and self.heel_strike_error is None:
            self.heel_strike = previous
            self.heel_strike_error = error
            self.heel_strike_error_time = self.swing - 0.5 * dt
        return error

    def _add_known(self, v: Vec3) -> None:
        x, y, z = self.known_displacement
        dt = self.interval
        self.known_displacement = (x + v[0] * dt, y + v[1] * dt, z + v[2] * dt)

    def mark(self, t: float, cue: Cue) -> None:
        """Set the candidate: for toe-off the sample before this one (A of fig. 4), for heel-strike this one (D)."""
        if cue is Cue.CLEAR:
            self.toe_off = self.previous
            if self.previous is not None:
                self.toe_off_error_time = self.previous.elapsed - 0.5 * self.previous_interval
        elif cue is Cue.CONTACT:
            self.heel_strike = self.current
            self.heel_strike_error = None

    def _end_motion(self) -> None:
        """End the motion, or add one more sample of stance."""
        duration = self.swing
        if self.moved:
            self.last_error_index = None
        vx, vy, vz = self.raw_velocity
        x, y, z = self.raw_displacement
        half = 0.5 * duration
        displacement = (x - vx * half, y - vy * half, z - vz * half)
        calibrated = self._calibrated_displacement(duration)
        if calibrated is not None:
            displacement = calibrated if self.settings.vertical else (calibrated[0], calibrated[1], displacement[2])
        x, y, z = self.motion_start
        self.position = (x + displacement[0], y + displacement[1], z + displacement[2])
        self.velocity = ZERO
        self._level()
        self.swing = 0.0
        self.standing = True

    def _calibrated_displacement(self, duration: float) -> Vec3 | None:
        """Return the displacement of a normal motion that ends here, m: (8) integrated; set the error index (10).

        It is None if the motion is abnormal."""
        toe_off, heel_strike = self.toe_off, self.heel_strike
        if self.has_gap or toe_off is None or toe_off.error is None or heel_strike is None:
            return None
        error, error_time = self.heel_strike_error, self.heel_strike_error_time
        if error is None:  # the heel never rolled: the velocity is zero where the foot stands
            error, error_time = self.raw_velocity, duration
            heel_strike = self._moment(error)
        else:
            # in the last interval, before the foot rests, the error is taken to be unchanged
            vx, vy, vz = self.interval_velocity
            self._add_known((vx - error[0], vy - error[1], vz - error[2]))
        drift_start = self.toe_off_error_time
        if error_time <= drift_start:
            return None
        swing = heel_strike.elapsed - toe_off.elapsed
        # integral over the swing of (k - k_t) / (k_h - k_t), for V_raw - V_errt - driftrate (k - k_t)
        drift_time = (
            0.5
            * ((heel_strike.elapsed - drift_start) ** 2 - (toe_off.elapsed - drift_start) ** 2)
            / (error_time - drift_start)
        )
        displacement = [0.0, 0.0, 0.0]
        for k in range(3):
            first, last = toe_off.error[k], error[k]
            swing_displacement = (
                heel_strike.raw_displacement[k]
                - toe_off.raw_displacement[k]
                - first * swing
                - (last - first) * drift_time
            )
            displacement[k] = (
                toe_off.known_displacement[k]
                + swing_displacement
                + self.known_displacement[k]
                - heel_strike.known_displacement[k]
            )
        self.last_error_index = hypot(toe_off.error[0] + error[0], toe_off.error[1] + error[1])
        return (displacement[0], displacement[1], displacement[2])

    def _start_motion(self) -> None:
        self.motion_start = self.position
        self.raw_velocity = self.velocity
        self.raw_displacement = self.known_displacement = ZERO
        self.current = self.previous = self.toe_off = self.heel_strike = None
        self.heel_strike_error = None
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
        x, y, z = position
        u, v, w = self.motion_start
        self.raw_velocity = velocity
        self.raw_displacement = (x - u, y - v, z - w)
        self.current = self.previous = None
        self.moved = self.has_gap = True
