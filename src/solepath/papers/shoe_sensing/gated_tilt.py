"""Navigation of Li, Liu, Liu, Chen, Ma, "3D tracking via shoe sensing" (Sensors 16, 1809, 2016), sections 3.2 to 3.4.

Gravity corrects the tilt in stance only. A drift that is linear in time is taken out of the velocity and, on level
strides, out of the height."""

from __future__ import annotations

from collections import deque
from math import hypot, sqrt

from ...body.activity.steepness import steepness
from ...foot.navigate.dedrift import LinearDedrift
from ...foot.settings import DedriftSettings
from ...foot.stance.stance import Stance
from ...types import Phase, Quat, Vec3
from ...types.attrs import define, field, frozen
from ...types.vector import GRAVITY, TIE, ZERO, rotate, tipped
from .posture import gravity_error, posture, turn

LEAST_LENGTH = 0.5
"""Length below which a stride is not used to learn the height gained per metre, m."""
LEARNT_STRIDES = 8
"""Number of level strides over which `level_slope` is a plain mean; after that, older strides fade."""
SHORTEST_SWING = 0.3
"""Duration of the shortest swing, s."""
LONGEST_USUAL_STRIDE = 1.2
"""Duration above which a stride contains a missed stance, s: its errors grow with the square of time."""
SHORTEST_STANCE = 0.03
"""Duration of the shortest stance, s."""
REPORT_DELAY = 0.05
"""Time after which a stance that is not yet certain is reported although the last one became certain, s."""
OVERDUE_LIMIT_GROWTH = 10.0
"""Growth of the speed limit with the square of the overdue time, m/s^3: a spoilt attitude can make any speed."""
HIGHEST_SPEED = 15.0
"""Highest speed of a foot, m/s."""
LARGEST_LEVEL_HEIGHT = 0.12
"""Height change from which on a stride is not level, m, up or down."""
UNCERTAIN_SIGMA, LONGEST_SWING = 0.04, 0.9
"""Sigma above which evidence is no stance, m/s, and time without a stance after which twice as much is allowed, s."""
SPEED_LIMIT, SPEED_LIMIT_GROWTH, UNCERTAIN_SHARE = 0.5, 1.0, 0.5
"""Speed limit of a standing foot, m/s, its growth since the last stance, m/s^2, and the share for uncertain evidence.

A tilt error of 6 degrees makes as much growth."""


@frozen
class ShoeSensingSettings(DedriftSettings):
    """Settings of `ShoeSensing`."""

    kp: float = 1.0
    """Gain of the tilt feedback in stance, 1/s; the paper gives no value."""
    tilt_share: float = 0.4
    """Share of the tilt error that is corrected after a motion, 0 to 1; 0 turns it off. Not in the paper. The velocity
    left at the end of a motion shows that error. Joggers' stances are too short for the feedback."""
    eliminate: bool = True
    """Flag: the height error of level strides is removed."""
    detector_delay: float = 0.15
    """Longest delay of the detector, s: the window of `ShortTimeEnergy`. After a stance, samples of that time count as
    motion."""


@define
class ShoeSensing(LinearDedrift):
    """Corrector that feeds tilt back in stance and takes linear drifts out of velocity and, on level strides, height.

    gyro' = gyro - Kp e in stance; Runge-Kutta quaternion; V(T) less e~ (T - t_a); S_z(T) less e~_s (T - t_a). Frame and
    units are those of `Corrector`. Latency: velocity, position and, on a level stride, height are corrected in one jump
    with the first sample of stance, and once more when an uncertain stance becomes certain. The feedback of a sample of
    stance turns the interval after it.

    e~ = (dv2 - dv1) / (t_b - t_a) of section 3.3 is the velocity left when the foot stands again, over the time since
    it last stood. Removing it linearly from the velocity removes half of it times that time from the position. Section
    3.4.2's height error is removed in the same way and is zero at t_b: the foot stands as high as before. The paper
    does not say how its live track knows e~_s before t_b. Here the live height within a stride (`FootMoved`) has the
    whole drift since t_a, the line is subtracted in one jump when the foot stands, and heights in between are not
    reported again. V(T) and S_z(T) are printed with `stationary = 1` beside the moving foot and 0 beside the standing
    one; by section 3.1.2 it is the other way about. A stride is level by its angle per metre (steepness.py).

    Beyond the paper: in mid-swing, and before foot-flat, there are moments without acceleration, and joggers hardly
    have longer ones. So evidence without the hint STATIONARY is stance for the time being, if it comes `SHORTEST_SWING`
    after the last stance, its sigma is at most `UNCERTAIN_SIGMA`, and the integrated speed is low. If the foot then
    stands with more certainty, the motion is corrected by that later moment. A wearer whose last stance became certain
    is not reported to stand before that: walkers' strides end with certainty, a jogger's first may be reported as one
    with the second. The velocity left at the end of a stance turns the tilt (`tilt_share`). Most of a level stride's
    height is a tilt made by an accelerometer bias, equal per metre in every stride (25 mg make 3.5 cm of 1.4 m): the
    mean of the level strides, `level_slope`, is subtracted from every stride before it is judged. A stride that still ends
    `LARGEST_LEVEL_HEIGHT` or more above or below its start is not level, whatever its angle: it goes onto or off a stair
    with a long stride, and keeps its height."""

    settings: ShoeSensingSettings = ShoeSensingSettings()
    level_slope: float = field(default=0.0, init=False)
    """Height gained by level strides per metre of their length, m; zero without `eliminate`."""
    level_strides: int = field(default=0, init=False)
    """Number of strides that `level_slope` comes from, at most `LEARNT_STRIDES`."""
    stride_slope: float = field(default=0.0, init=False)
    """Height per metre that the stride before this stance adds to `level_slope`; zero if that stride was not level."""
    last_acc: Vec3 = field(default=ZERO, init=False)
    """Specific force of the last sample, sensor frame, m/s^2."""
    velocity_change: Vec3 = field(default=ZERO, init=False)
    """Change of the velocity by the last sample, m/s."""
    recent_samples: deque[tuple[float, float, Vec3]] = field(factory=deque, init=False)
    """Last samples of stance, each with its time, s, duration, s, and change of the velocity, m/s."""
    standing: bool = field(default=True, init=False)
    """Flag: the last sample was one of stance."""
    least_sigma: float = field(default=0.0, init=False)
    """Least sigma of this stance, m/s."""
    stance_age: float = field(default=0.0, init=False)
    """Time since the start of this stance or, in a motion, of the last one, s."""
    is_certain: bool = field(default=True, init=False)
    """Flag: the last stance became certain."""
    tilt_correction: tuple[float, float] = field(default=(0.0, 0.0), init=False)
    """Turn of the attitude at the end of this stance, half angles about x and y, rad."""
    continued_motion: tuple[Vec3, Vec3] | None = field(default=None, init=False)
    """Position, m, and velocity, m/s, as if the motion before this stance went on; None once that motion is final."""
    continued_time: float = field(default=0.0, init=False)
    """Duration of the motion that `continued_motion` continues, s."""
    last_dt: float = field(default=0.0, init=False)
    """Duration of the last sample, s."""
    stance_position: Vec3 = field(default=ZERO, init=False)
    """Position where the foot stands or last stood, m."""
    previous_position: Vec3 = field(default=ZERO, init=False)
    """Position where the foot stood before `stance_position`, m."""

    def start(self, attitude: Quat, tilt_sigma: float) -> None:
        # the mean specific force of the rest from which the attitude was found, sensor frame
        w, x, y, z = attitude
        up = (2.0 * (x * z - w * y), 2.0 * (y * z + w * x), w * w - x * x - y * y + z * z)
        LinearDedrift.start(self, posture(up), tilt_sigma)
        self.stance_position = self.previous_position = ZERO
        self.standing = True
        self.least_sigma = 0.0
        self.stance_age = self.continued_time = self.stride_slope = 0.0
        self.continued_motion = None
        self.is_certain = True
        self.tilt_correction = (0.0, 0.0)
        self.recent_samples.clear()
        self.last_acc = up

    def predict(self, dt: float, acc: Vec3, gyro: Vec3, saturated: bool = False) -> None:
        rate_before = gyro if self.rate is None else self.rate
        self.rate = rate_after = gyro
        attitude = self.attitude
        if self.standing:
            k = min(self.settings.kp, 0.5 / dt) if dt > 0.0 else 0.0
            ex, ey, ez = gravity_error(attitude, self.last_acc)
            ex, ey, ez = k * ex, k * ey, k * ez
            x, y, z = rate_before
            rate_before = (x - ex, y - ey, z - ez)
            x, y, z = rate_after
            rate_after = (x - ex, y - ey, z - ez)
        self.last_acc = acc
        self.attitude = attitude = turn(attitude, rate_before, rate_after, dt)
        fx, fy, fz = force = rotate(attitude, acc)
        px, py, pz = force if self.force is None else self.force
        self.force = force
        half = 0.5 * dt
        dx, dy, dz = self.velocity_change = ((fx + px) * half, (fy + py) * half, (fz + pz) * half - GRAVITY * dt)
        vx, vy, vz = self.velocity
        ux, uy, uz = vx + dx, vy + dy, vz + dz
        x, y, z = self.position
        self.position = (x + (vx + ux) * half, y + (vy + uy) * half, z + (vz + uz) * half)
        speed = sqrt(ux * ux + uy * uy + uz * uz)
        if speed > HIGHEST_SPEED:
            k = HIGHEST_SPEED / speed
            ux, uy, uz, speed = ux * k, uy * k, uz * k, HIGHEST_SPEED
        self.velocity = (ux, uy, uz)
        self.length += speed * dt
        if self.continued_motion is not None:
            (x, y, z), (vx, vy, vz) = self.continued_motion
            x, y, z = x + (vx + 0.5 * dx) * dt, y + (vy + 0.5 * dy) * dt, z + (vz + 0.5 * dz) * dt
            self.continued_motion = ((x, y, z), (vx + dx, vy + dy, vz + dz))
            self.continued_time += dt
        self.last_dt = dt
        self.stance_age += dt
        self.swing += dt
        self.lasted += dt

    def correct(self, t: float, stance: Stance) -> bool:
        was_standing = self.standing
        self.standing = standing = self._is_stance(stance)
        if not standing:
            if was_standing:
                self._start_motion()
            elif self.stance_age >= SHORTEST_SWING:
                self.continued_motion = None
            return False
        if was_standing:
            recent_samples = self.recent_samples
            recent_samples.append((t, self.last_dt, self.velocity_change))
            oldest = t - self.settings.detector_delay + TIE
            while recent_samples and recent_samples[0][0] <= oldest:
                recent_samples.popleft()
        elif self.continued_motion is None:
            self.previous_position = self.stance_position
            self.continued_motion, self.continued_time = (self.position, self.velocity), self.swing
            self.stance_age = self.least_sigma = 0.0
        if self.continued_motion is not None and not 0.0 < self.least_sigma <= stance.sigma:
            self._end_motion(*self.continued_motion, stance)
        self.swing = 0.0
        self.position = self.stance_position
        self.velocity = stance.v_ref
        return self.continued_motion is None or not self.is_certain or self.stance_age >= REPORT_DELAY

    def _is_stance(self, stance: Stance) -> bool:
        """Return whether the foot stands, judged by the evidence and the integrated speed."""
        sigma, is_certain = stance.sigma, stance.hint is Phase.STATIONARY
        if self.standing and self.stance_age < SHORTEST_STANCE:
            return True
        if stance.hint is Phase.SWING or sigma > 2.0 * UNCERTAIN_SIGMA:
            return False
        if self.standing:
            return sigma <= max(UNCERTAIN_SIGMA, self.least_sigma)
        (vx, vy, vz), swing = self.velocity, self.swing
        if self.continued_motion is not None:
            if sigma >= self.least_sigma:
                return False
            (_, (vx, vy, vz)), swing = self.continued_motion, self.continued_time
        elif swing < SHORTEST_SWING and not is_certain:
            return False
        limit = SPEED_LIMIT + SPEED_LIMIT_GROWTH * swing
        if not is_certain:
            limit *= UNCERTAIN_SHARE
        if swing > LONGEST_SWING:
            limit += OVERDUE_LIMIT_GROWTH * (swing - LONGEST_SWING) ** 2
        elif sigma > UNCERTAIN_SIGMA:
            return False
        return vx * vx + vy * vy + vz * vz < limit * limit

    def _end_motion(self, position: Vec3, velocity: Vec3, stance: Stance) -> None:
        """End the motion at this position and velocity: the foot stands, with more certainty than it did before."""
        (x, y, z), (vx, vy, vz), (rx, ry, rz) = position, velocity, stance.v_ref
        half = 0.5 * self.continued_time
        k = 0.5 * self.settings.tilt_share / (GRAVITY * max(self.continued_time, SHORTEST_SWING))
        self.tilt_correction = (k * (vy - ry), -k * (vx - rx))
        x, y, z = x + (rx - vx) * half, y + (ry - vy) * half, z + (rz - vz) * half
        if self.settings.eliminate:
            z = self._height_at_end(x, y, z)
        self.stance_position = (x, y, z)
        self.least_sigma = stance.sigma
        if stance.hint is Phase.STATIONARY:
            self.continued_motion = None

    def _height_at_end(self, x: float, y: float, z: float) -> float:
        """Return S_z at the end of a stride that integration has brought to (x, y, z), m."""
        bx, by, bz = self.previous_position
        distance = hypot(x - bx, y - by)
        height = z - bz - self.level_slope * distance
        height_limit = LARGEST_LEVEL_HEIGHT * max(1.0, self.continued_time / LONGEST_USUAL_STRIDE) ** 2
        if abs(height) >= height_limit or steepness(distance, height) != 0:
            self.stride_slope = 0.0
            return bz + height
        self.stride_slope = height / distance if distance > LEAST_LENGTH else 0.0
        return bz

    def _start_motion(self) -> None:
        """End the stance, which was over already for the samples in `recent_samples`."""
        if self.stride_slope != 0.0:
            self.level_strides = min(self.level_strides + 1, LEARNT_STRIDES)
            self.level_slope += self.stride_slope / self.level_strides
            self.stride_slope = 0.0
        self.is_certain = self.continued_motion is None
        self.attitude = tipped(self.attitude, *self.tilt_correction)
        self.tilt_correction = (0.0, 0.0)
        self.swing = 0.0
        x, y, z = self.stance_position
        vx = vy = vz = 0.0
        for _, dt, (dx, dy, dz) in (*self.recent_samples, (0.0, self.last_dt, self.velocity_change)):
            x, y, z = x + (vx + 0.5 * dx) * dt, y + (vy + 0.5 * dy) * dt, z + (vz + 0.5 * dz) * dt
            vx, vy, vz = vx + dx, vy + dy, vz + dz
            self.swing += dt
        self.recent_samples.clear()
        self.position, self.velocity = (x, y, z), (vx, vy, vz)

    def bridge(self, dt: float) -> float:
        self._discard_recent_samples()
        return LinearDedrift.bridge(self, dt)

    def infill(self, dt: float, attitude: Quat, velocity: Vec3, position: Vec3) -> None:
        self._discard_recent_samples()
        self.standing = False
        LinearDedrift.infill(self, dt, attitude, velocity, position)

    def repair(self, yaw: float, position: Vec3) -> None:
        LinearDedrift.repair(self, yaw, position)
        self.stance_position = self.previous_position = position
        self._discard_recent_samples()

    def _discard_recent_samples(self) -> None:
        """Discard the last samples and the uncorrected motion."""
        self.continued_motion = None
        self.recent_samples.clear()
