"""Corrector of KUPT: velocity known from heel-strike to toe-off, a linear drift taken out of the swing between.

Chen et al., "Smart insole-based indoor localization system for Internet of Things applications" (IEEE Internet of
Things Journal 6, 2019), section III.C.3, equations (8) and (10). The velocities come from known_velocity.py."""

from __future__ import annotations

from math import hypot

from ...foot.navigate.dedrift import LinearDedrift
from ...foot.phase import Cue
from ...foot.settings import DedriftSettings
from ...foot.stance.stance import Stance
from ...types import Phase, Quat, Vec3
from ...types.attrs import define, field, frozen
from ...types.vector import TIE, ZERO

SHORT_GAP = 0.08
"""Longest gap of a normal motion, s: one lost sample of the paper's 30 Hz is 0.067 s; differences take true time."""
LARGEST_ROLLING_SIGMA = 0.2
"""Sigma above which evidence of a rolling shoe is not used, m/s."""
LARGEST_ROLLING_ERROR = 0.6
"""Distance of a rolling velocity of push-off from the raw one, along the ground, above which it is not used, m/s.

In 0.3 s a tilt that is off by 2 degrees and an accelerometer by 20 mg make 0.16 m/s, a rolling velocity is good to 0.1,
and three times both together is 0.57. Emulated feet stay within 0.05; recorded ones that roll reach 0.5, and those
whose cells release late are at 0.7 to 1.3."""


@frozen
class MotionMoment:
    """State of the integration at one sample of a motion.

    `elapsed`: s since motion start. `velocity` (m/s) and `raw_displacement` (m): raw. `known_displacement`: integral of
    the known velocities, m. `error`: raw less known velocity over the interval that ended here, m/s; None when unknown.
    """

    elapsed: float
    velocity: Vec3
    raw_displacement: Vec3
    known_displacement: Vec3
    error: Vec3 | None


@frozen
class SwingSettings(DedriftSettings):
    """Settings of `SwingDedrift`."""

    slide_time: float = 0.02
    """Time after heel-strike in which the heel still slides, s."""
    vertical: bool = False
    """Flag: the known velocity is used for heights too."""


@define
class SwingDedrift(LinearDedrift):
    """Corrector with known velocities on the ground; in swing the drift is linear between toe-off and heel-strike (8).

    Velocities are known from motion start to toe-off and from heel-strike to motion end, as means over the interval
    between two samples. So they are compared with the raw velocity's mean over the same interval, and the errors belong
    to the middle of it: over the last interval before toe-off and, as in (5), the one after heel-strike. A heel does
    not roll at once: it slides on the ground and the sole gives way for `slide_time` s, which (4) does not model, so
    k_h of (8) is the first sample that long after heel-strike; 0 gives the paper's. While the foot moves, the live
    position takes the velocities as they become known and continues from the last of them in swing; at motion end it is
    corrected in one jump.

    The vertical part of a rolling velocity is about L_r times the pitch rate: a pivot that is off by 1 cm at toe-off
    makes 8 cm/s, and in level walking it adds nothing to a height corrected by a line over the whole motion. So heights
    get that line unless `vertical` is set.

    A raw velocity that was zero at motion start cannot be off by `LARGEST_ROLLING_ERROR` when the foot leaves the
    ground a few tenths of a second later; in fig. 14 too it drifts in swing and landing. On recorded insoles, whose
    cells release late, the foot is then already in motion and does not roll. So a velocity of push-off that contradicts
    the raw one so much is not used. Where the heel never rolled the error is that at motion end, and the swing lasts
    until then.

    A motion without both marks, with a gap in it, or without a usable velocity at toe-off is abnormal: it loses one
    linear drift over its whole time, as with ZUPT. Memory is three moments, however long the motion."""

    settings: SwingSettings = SwingSettings()
    motion_start: Vec3 = field(default=ZERO, init=False)
    """Position where the motion started, m."""
    raw_velocity: Vec3 = field(default=ZERO, init=False)
    raw_displacement: Vec3 = field(default=ZERO, init=False)
    known_displacement: Vec3 = field(default=ZERO, init=False)
    interval_velocity: Vec3 = field(default=ZERO, init=False)
    """Mean raw velocity over the last interval, m/s."""
    interval: float = field(default=0.0, init=False)
    current: MotionMoment | None = field(default=None, init=False)
    previous: MotionMoment | None = field(default=None, init=False)
    toe_off: MotionMoment | None = field(default=None, init=False)
    toe_off_error_time: float = field(default=0.0, init=False)
    """Time of the error at toe-off, s since motion start."""
    heel_strike: MotionMoment | None = field(default=None, init=False)
    heel_strike_error: Vec3 | None = field(default=None, init=False)
    heel_strike_error_time: float = field(default=0.0, init=False)
    previous_interval: float = field(default=0.0, init=False)
    standing: bool = field(default=True, init=False)
    """Flag: the last sample was one of stance, and a motion starts with the next."""
    moved: bool = field(default=False, init=False)
    """Flag: there was a sample without a zero velocity since the last with one."""
    has_gap: bool = field(default=False, init=False)
    """Flag: a gap lies in this motion."""
    last_error_index: float | None = field(default=None, init=False)

    @property
    def error_index(self) -> float | None:
        """Error index (10), m/s: the length of the horizontal part of V_errt + V_errh; None for an abnormal motion.

        The paper has one number for a velocity that has three; the error of the horizontal position is the one that
        matters."""
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
        if stance.sigma <= self.settings.trusted and not rolls and hint is not Phase.SWING:
            self._end_motion()
            return True
        self.moved = True
        self.previous = self.current
        error: Vec3 | None = None
        if rolls and stance.sigma <= LARGEST_ROLLING_SIGMA:
            error = self._use_velocity(stance.v_ref, hint is Phase.PUSH_OFF)
        elif self.previous is not None and self.previous.error is not None:
            # nothing new is known: the error stays as it was
            ex, ey, ez = self.previous.error
            vx, vy, vz = self.interval_velocity
            self._add_known((vx - ex, vy - ey, vz - ez))
            if hint is not Phase.SWING:
                error = self.previous.error
        self.current = MotionMoment(
            self.swing, self.raw_velocity, self.raw_displacement, self.known_displacement, error
        )
        return False

    def _use_velocity(self, v_ref: Vec3, push_off: bool) -> Vec3 | None:
        """Use the known velocity over the last interval; return the raw one's error, None if it is too large."""
        (vx, vy, vz), (rx, ry, rz) = self.interval_velocity, v_ref
        error = (vx - rx, vy - ry, vz - rz)
        if push_off and hypot(error[0], error[1]) > LARGEST_ROLLING_ERROR:
            self._add_known(self.interval_velocity)
            return None
        self._add_known(v_ref)
        # live: the position reached with the known velocity, and the raw velocity less its error
        (ux, uy, uz), (px, py, pz) = self.raw_velocity, self.velocity
        # integration took a mean of (p + p_before)/2 over this interval; take v_ref instead
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
        settled = (
            previous is not None
            and heel_strike is not None
            and previous.elapsed - heel_strike.elapsed >= self.settings.slide_time - TIE
        )
        if settled and self.heel_strike_error is None:
            self.heel_strike = previous
            self.heel_strike_error = error
            self.heel_strike_error_time = self.swing - 0.5 * dt
        return error

    def _add_known(self, v: Vec3) -> None:
        x, y, z = self.known_displacement
        dt = self.interval
        self.known_displacement = (x + v[0] * dt, y + v[1] * dt, z + v[2] * dt)

    def mark(self, t: float, cue: Cue) -> None:
        """Set a candidate: for toe-off the sample before this one (A of fig. 4), for heel-strike this one (D)."""
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
        """Return the displacement of a normal motion that ends here, m, and set the error index; None for any other."""
        toe_off, heel_strike = self.toe_off, self.heel_strike
        if self.has_gap or toe_off is None or toe_off.error is None or heel_strike is None:
            return None
        error, error_at = self.heel_strike_error, self.heel_strike_error_time
        if error is None:  # the heel never rolled: the velocity is known where the foot stands
            error, error_at = self.raw_velocity, duration
            heel_strike = MotionMoment(
                duration, self.raw_velocity, self.raw_displacement, self.known_displacement, error
            )
        else:
            # the last interval, in which the foot came to rest, with the error as it was
            vx, vy, vz = self.interval_velocity
            self._add_known((vx - error[0], vy - error[1], vz - error[2]))
        drift_start = self.toe_off_error_time
        if error_at <= drift_start:
            return None
        swing = heel_strike.elapsed - toe_off.elapsed
        # of V_raw - V_errt - driftrate (k - kt), from k_t to k_h
        drift_time = (
            0.5
            * ((heel_strike.elapsed - drift_start) ** 2 - (toe_off.elapsed - drift_start) ** 2)
            / (error_at - drift_start)
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
        """Start a motion at the position of the foot."""
        self.motion_start = self.position
        self.raw_velocity = self.velocity
        self.raw_displacement = self.known_displacement = ZERO
        self.current = self.previous = self.toe_off = self.heel_strike = None
        self.heel_strike_error = None
        self.standing = self.moved = self.has_gap = False

    def bridge(self, dt: float) -> float:
        if self.standing:
            self._start_motion()
        over = LinearDedrift.bridge(self, dt)
        if over == 0.0:
            self._start_motion()  # it continues from the same position, at rest
        if dt > SHORT_GAP:
            self.has_gap = True
            self.current = self.previous = None
        self.moved = True
        return over

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
