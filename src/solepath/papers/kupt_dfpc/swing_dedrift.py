"""The corrector of KUPT: velocity known from heel-strike to toe-off, a linear drift taken out of the swing between.

Chen et al., "Smart insole-based indoor localization system for Internet of Things applications" (IEEE Internet of
Things Journal 6, 2019), section III.C.3, equations (8) and (10). Which velocities are known, known_velocity.py says.
"""

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
"""A step with a longer gap than this is abnormal, s: two samples of the paper's 30 Hz lie 0.067 s apart when one is
lost between them, and differences take the true time."""
ROLLING = 0.2
"""Evidence of a rolling shoe with a sigma above this is not used, m/s."""
GROSS = 0.6
"""A rolling velocity of push-off further than this from the raw one, along the ground, is not believed, m/s. In 0.3 s a
tilt that is off by 2 degrees and an accelerometer by 20 mg make 0.16 m/s, a rolling velocity is good to 0.1, and three
times both together is 0.57. Emulated feet stay within 0.05; recorded ones that roll reach 0.5, and those whose cells
let go late are at 0.7 to 1.3."""


@frozen
class MotionMoment:
    """What the integration had come to at one sample of a motion. `at`: s since motion start. `velocity` (m/s) and
    `way` (m): raw. `known`: the way as far as velocities were known, m. `error`: raw less known velocity over the
    interval that ended here, m/s; None when it was not known."""

    at: float
    velocity: Vec3
    way: Vec3
    known: Vec3
    error: Vec3 | None


@frozen
class SwingSettings(DedriftSettings):
    """What `SwingDedrift` is set to."""

    slide: float = 0.02
    """For so long after heel-strike the heel has not stopped sliding, s."""
    vertical: bool = False
    """Take the known velocity for heights too."""


@define
class SwingDedrift(LinearDedrift):
    """Known velocities from motion start to toe-off and from heel-strike to motion end; in swing the raw velocity less
    a drift that is linear between the errors at toe-off and heel-strike (8).

    Known velocities are means over the interval between two samples, so they are compared with the raw velocity's mean
    over the same interval, and the errors belong to the middle of it: over the last interval before toe-off and, as in
    (5), the one after heel-strike. A heel does not roll at once: it slides on the ground and the sole gives way for
    `slide` s, and (4) knows nothing of that, so k_h of (8) is the first sample that long after heel-strike; 0 gives
    the paper's. While the foot moves, the live position takes the velocities as they become known and goes on from the
    last of them in swing; at motion end it is put right in one jump.

    The vertical part of a rolling velocity is about L_r times the pitch rate: a pivot that is off by 1 cm at toe-off
    makes 8 cm/s, and in level walking nothing of a height that a line over the whole motion does not give as well. So
    heights get that line unless `vertical` is set.

    A raw velocity that was zero at motion start cannot be off by `GROSS` when the foot leaves the ground a few tenths
    of a second later; in fig. 14 too it drifts in swing and landing. On recorded insoles, whose cells let go late, the
    foot is then on its way already and does not roll. So a velocity of push-off that contradicts the raw one so much is
    not believed. Where the heel never rolled the error is that at motion end, and the swing lasts until then.

    A motion without both marks, with a gap in it, or without a believed velocity at toe-off is abnormal: it loses one
    linear drift over its whole time, as with ZUPT. Memory is three moments, however long the motion.
    """

    settings: SwingSettings = SwingSettings()
    base: Vec3 = field(default=ZERO, init=False)
    """Where the motion started, m."""
    raw_velocity: Vec3 = field(default=ZERO, init=False)
    raw_way: Vec3 = field(default=ZERO, init=False)
    known_way: Vec3 = field(default=ZERO, init=False)
    mean: Vec3 = field(default=ZERO, init=False)
    """Raw velocity over the last interval, m/s."""
    interval: float = field(default=0.0, init=False)
    here: MotionMoment | None = field(default=None, init=False)
    before: MotionMoment | None = field(default=None, init=False)
    toe_off: MotionMoment | None = field(default=None, init=False)
    toe_off_from: float = field(default=0.0, init=False)
    """To which time the error at toe-off belongs, s since motion start."""
    strike: MotionMoment | None = field(default=None, init=False)
    strike_error: Vec3 | None = field(default=None, init=False)
    strike_from: float = field(default=0.0, init=False)
    last_interval: float = field(default=0.0, init=False)
    stood: bool = field(default=True, init=False)
    """The last sample was one of stance: a motion starts with the next."""
    moved: bool = field(default=False, init=False)
    """There was a sample without a zero velocity since the last with one."""
    spoilt: bool = field(default=False, init=False)
    """A gap lies in this motion."""
    index: float | None = field(default=None, init=False)

    @property
    def error_index(self) -> float | None:
        """(10), m/s: the length of the horizontal part of V_errt + V_errh; None for an abnormal motion. The paper has
        one number for a velocity that has three; where the foot goes is the horizontal matter."""
        return self.index

    def start(self, attitude: Quat, tilt_sigma: float) -> None:
        LinearDedrift.start(self, attitude, tilt_sigma)
        self._begin()
        self.index = None

    def predict(self, dt: float, acc: Vec3, gyro: Vec3, saturated: bool = False) -> None:
        if self.stood:
            self._begin()
        ux, uy, uz = self.velocity
        LinearDedrift.predict(self, dt, acc, gyro, saturated)
        vx, vy, vz = self.velocity
        ux, uy, uz = vx - ux, vy - uy, vz - uz
        vx, vy, vz = self.raw_velocity
        self.raw_velocity = (vx + ux, vy + uy, vz + uz)
        vx, vy, vz = vx + 0.5 * ux, vy + 0.5 * uy, vz + 0.5 * uz
        self.mean = (vx, vy, vz)
        x, y, z = self.raw_way
        self.raw_way = (x + vx * dt, y + vy * dt, z + vz * dt)
        self.last_interval, self.interval = self.interval, dt

    def correct(self, t: float, stance: Stance) -> bool:
        hint = stance.hint
        rolls = hint is Phase.PUSH_OFF or hint is Phase.LOADING
        if stance.sigma <= self.settings.trusted and not rolls and hint is not Phase.SWING:
            self._stand()
            return True
        self.moved = True
        self.before = self.here
        error: Vec3 | None = None
        if rolls and stance.sigma <= ROLLING:
            error = self._take(stance.v_ref, hint is Phase.PUSH_OFF)
        elif self.before is not None and self.before.error is not None:
            # nothing new is known: the error stays as it was
            ex, ey, ez = self.before.error
            vx, vy, vz = self.mean
            self._advance((vx - ex, vy - ey, vz - ez))
            if hint is not Phase.SWING:
                error = self.before.error
        self.here = MotionMoment(self.swing, self.raw_velocity, self.raw_way, self.known_way, error)
        return False

    def _take(self, v_ref: Vec3, push_off: bool) -> Vec3 | None:
        """The velocity over the last interval is known; returns the error of the raw one, None if not believed."""
        (vx, vy, vz), (rx, ry, rz) = self.mean, v_ref
        error = (vx - rx, vy - ry, vz - rz)
        if push_off and hypot(error[0], error[1]) > GROSS:
            self._advance(self.mean)
            return None
        self._advance(v_ref)
        # live: where the known velocity led, and the raw velocity less its error
        (ux, uy, uz), (px, py, pz) = self.raw_velocity, self.velocity
        # the step from the last sample to this one was made with a mean of (p + p_before)/2; make it with v_ref
        change = (ux - vx, uy - vy, uz - vz)  # half of the velocity's change over the interval
        x, y, z = self.position
        dt = self.interval
        self.position = (
            x + (rx - (px - change[0])) * dt,
            y + (ry - (py - change[1])) * dt,
            z + (rz - (pz - change[2])) * dt,
        )
        self.velocity = (ux - error[0], uy - error[1], uz - error[2])
        before, strike = self.before, self.strike
        settled = before is not None and strike is not None and before.at - strike.at >= self.settings.slide - TIE
        if settled and self.strike_error is None:
            self.strike = before
            self.strike_error = error
            self.strike_from = self.swing - 0.5 * dt
        return error

    def _advance(self, v: Vec3) -> None:
        x, y, z = self.known_way
        dt = self.interval
        self.known_way = (x + v[0] * dt, y + v[1] * dt, z + v[2] * dt)

    def mark(self, t: float, cue: Cue) -> None:
        """As in `Corrector`. CLEAR: the sample before this one is the best candidate for toe-off (point A of fig. 4);
        CONTACT: this one is it for heel-strike (point D)."""
        if cue is Cue.CLEAR:
            self.toe_off = self.before
            if self.before is not None:
                self.toe_off_from = self.before.at - 0.5 * self.last_interval
        elif cue is Cue.CONTACT:
            self.strike = self.here
            self.strike_error = None

    def _stand(self) -> None:
        """Motion end, or one more sample of stance."""
        duration = self.swing
        if self.moved:
            self.index = None
        vx, vy, vz = self.raw_velocity
        x, y, z = self.raw_way
        half = 0.5 * duration
        way = (x - vx * half, y - vy * half, z - vz * half)
        calibrated = self._calibrated_way(duration)
        if calibrated is not None:
            way = calibrated if self.settings.vertical else (calibrated[0], calibrated[1], way[2])
        x, y, z = self.base
        self.position = (x + way[0], y + way[1], z + way[2])
        self.velocity = ZERO
        self._level()
        self.swing = 0.0
        self.stood = True

    def _calibrated_way(self, duration: float) -> Vec3 | None:
        """The way of a normal motion that ends here, m; sets the error index. None for any other."""
        toe_off, strike = self.toe_off, self.strike
        if self.spoilt or toe_off is None or toe_off.error is None or strike is None:
            return None
        error, at = self.strike_error, self.strike_from
        if error is None:  # the heel never rolled: the velocity is known where the foot stands
            error, at = self.raw_velocity, duration
            strike = MotionMoment(duration, self.raw_velocity, self.raw_way, self.known_way, error)
        else:
            # the last interval, in which the foot came to rest, with the error as it was
            vx, vy, vz = self.mean
            self._advance((vx - error[0], vy - error[1], vz - error[2]))
        began = self.toe_off_from
        if at <= began:
            return None
        swing = strike.at - toe_off.at
        # of V_raw - V_errt - driftrate (k - kt), from k_t to k_h
        gone = 0.5 * ((strike.at - began) ** 2 - (toe_off.at - began) ** 2) / (at - began)
        way = [0.0, 0.0, 0.0]
        for k in range(3):
            first, last = toe_off.error[k], error[k]
            flown = strike.way[k] - toe_off.way[k] - first * swing - (last - first) * gone
            way[k] = toe_off.known[k] + flown + self.known_way[k] - strike.known[k]
        self.index = hypot(toe_off.error[0] + error[0], toe_off.error[1] + error[1])
        return (way[0], way[1], way[2])

    def _begin(self) -> None:
        """A motion starts where the foot is."""
        self.base = self.position
        self.raw_velocity = self.velocity
        self.raw_way = self.known_way = ZERO
        self.here = self.before = self.toe_off = self.strike = None
        self.strike_error = None
        self.stood = self.moved = self.spoilt = False

    def bridge(self, dt: float) -> float:
        if self.stood:
            self._begin()
        over = LinearDedrift.bridge(self, dt)
        if over == 0.0:
            self._begin()  # taken up where it was, and at rest
        if dt > SHORT_GAP:
            self.spoilt = True
            self.here = self.before = None
        self.moved = True
        return over

    def infill(self, dt: float, attitude: Quat, velocity: Vec3, position: Vec3) -> None:
        if self.stood:
            self._begin()
        LinearDedrift.infill(self, dt, attitude, velocity, position)
        x, y, z = position
        u, v, w = self.base
        self.raw_velocity = velocity
        self.raw_way = (x - u, y - v, z - w)
        self.here = self.before = None
        self.moved = self.spoilt = True
