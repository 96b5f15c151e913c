"""Navigation of Li, Liu, Liu, Chen, Ma, "3D tracking via shoe sensing" (Sensors 16, 1809, 2016), sections 3.2 to 3.4.

Gravity corrects the tilt in stance only. A drift that is linear in time is removed from the velocity and, on level
strides, from the height. Numbers without a source were chosen by hand."""

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
"""Number of level strides over which `level_slope` is a plain mean; later strides have a weight of 1/8 each."""
SHORTEST_SWING = 0.3
"""Duration of the shortest swing, s."""
LONGEST_USUAL_STRIDE = 1.2
"""Duration, s, above which a stride contains an undetected stance; its height error grows with the square of time."""
SHORTEST_STANCE = 0.03
"""Duration of the shortest stance, s."""
REPORT_DELAY = 0.05
"""Time after which an uncertain stance is reported even if the previous stance became certain, s."""
OVERDUE_LIMIT_GROWTH = 10.0
"""Growth of the speed limit with the square of the time after `LONGEST_SWING`, m/s^3: speeds may err by any amount."""
HIGHEST_SPEED = 15.0
"""Highest speed of a foot, m/s."""
LARGEST_LEVEL_HEIGHT = 0.12
"""Absolute height change from which on a stride is not level, m."""
UNCERTAIN_SIGMA, LONGEST_SWING = 0.04, 0.9
"""Largest sigma of a stance, m/s, and time without a stance, s, after which twice that sigma is accepted."""
SPEED_LIMIT, SPEED_LIMIT_GROWTH, UNCERTAIN_SHARE = 0.5, 1.0, 0.5
"""Limit of the integrated speed at a stance, m/s; its growth with time since the last stance, m/s^2; and its factor.

The factor applies without the hint STATIONARY. A tilt error of 6 degrees makes the speed grow by 1 m/s^2."""


@frozen
class ShoeSensingSettings(DedriftSettings):
    """Settings of `ShoeSensing`."""

    kp: float = 1.0
    """Gain of the tilt feedback in stance, 1/s; the paper gives no value."""
    tilt_share: float = 0.4
    """Share of the tilt error that is corrected after a motion, 0 to 1; 0 for none. The tilt error is computed from the
    velocity left at the end of the motion. The paper does not have this. The stances of joggers are too short for the
    feedback."""
    eliminate: bool = True
    """Flag: the height error of level strides is removed."""
    detector_delay: float = 0.15
    """Longest delay of the detector, s: the window of `ShortTimeEnergy`. The samples of this time before the detected
    end of a stance count as motion."""


@define
class ShoeSensing(LinearDedrift):
    """Corrector with tilt feedback in stance that removes linear drifts of velocity and, on level strides, height.

    In stance gyro' = gyro - Kp e. The quaternion is integrated by Runge and Kutta's method. At the end of a motion from
    t_a to t_b, e~ (T - t_a) is subtracted from V(T), and e~_s (T - t_a) from the height S_z(T). Frame and units are
    those of `Corrector`. Latency: velocity, position and height are corrected in one jump at the first sample of
    stance, and once more when an uncertain stance becomes certain.

    e~ = (dv2 - dv1) / (t_b - t_a) of section 3.3 is the velocity left when the foot stands again, divided by the time
    since it last stood. So half of the product of both is subtracted from the position. The height error of
    section 3.4.2 is removed likewise: after a level stride the foot stands as high as before. The paper does not say
    how its live track knows e~_s before t_b. Here the live height within a stride (`FootMoved`) has the whole drift
    since t_a. It is corrected in one jump when the foot stands, and earlier heights are not reported again. The paper
    prints V(T) and S_z(T) with `stationary = 1` for the moving foot, but its section 3.1.2 has the opposite. A stride
    is level by its angle per metre (steepness.py).

    Beyond the paper: There are moments without acceleration in mid-swing and before foot-flat. The moments without
    acceleration in the stance of joggers are hardly longer. So evidence without the hint STATIONARY is only an
    uncertain stance: the last stance must have been `SHORTEST_SWING` before, sigma at most `UNCERTAIN_SIGMA`, and the
    integrated speed low. If more certain evidence follows, the motion is corrected again at that later sample. After a
    certain stance an uncertain one is reported only when it has lasted for `REPORT_DELAY`, because every stance of a
    walker becomes certain. So a jogger's first two strides may become one. The velocity left at the end of a motion
    also corrects the tilt (`tilt_share`).

    Most of the height error of a level stride comes from a tilt due to an accelerometer bias. This error per metre is
    equal in all strides (25 mg make 3.5 cm in 1.4 m). So its mean over the level strides, `level_slope`, is removed
    from every stride before the angle is computed. A stride that then still ends `LARGEST_LEVEL_HEIGHT` or more above
    or below its start is not level, whatever its angle: it leads onto or off a stair, and its height is not removed."""

    settings: ShoeSensingSettings = ShoeSensingSettings()
    level_slope: float = field(default=0.0, init=False)
    """Height gained per metre of level strides, m/m, positive upwards; zero without `eliminate`."""
    level_strides: int = field(default=0, init=False)
    """Number of strides in the mean `level_slope`, at most `LEARNT_STRIDES`."""
    stride_slope: float = field(default=0.0, init=False)
    """Height per metre of the last stride in excess of `level_slope`, m/m; zero if that stride was not level."""
    last_acc: Vec3 = field(default=ZERO, init=False)
    """Specific force of the last sample, sensor frame, m/s^2."""
    velocity_change: Vec3 = field(default=ZERO, init=False)
    """Change of the velocity by the last sample, m/s."""
    recent_samples: deque[tuple[float, float, Vec3]] = field(factory=deque, init=False)
    """Last samples of stance, each with its time, s, duration, s, and change of the velocity, m/s."""
    standing: bool = field(default=True, init=False)
    """Flag: the last sample was in stance."""
    least_sigma: float = field(default=0.0, init=False)
    """Least sigma of this stance, m/s."""
    stance_age: float = field(default=0.0, init=False)
    """Time since the start of the latest stance, s."""
    is_certain: bool = field(default=True, init=False)
    """Flag: the last stance became certain."""
    tilt_correction: tuple[float, float] = field(default=(0.0, 0.0), init=False)
    """Rotation of the attitude at the end of this stance: half angles about the world's x and y, rad."""
    continued_motion: tuple[Vec3, Vec3] | None = field(default=None, init=False)
    """Position, m, and velocity, m/s, integrated without stopping at this uncertain stance; None once it is certain."""
    continued_time: float = field(default=0.0, init=False)
    """Duration of `continued_motion`, s."""
    last_dt: float = field(default=0.0, init=False)
    """Time between the last two samples, s."""
    stance_position: Vec3 = field(default=ZERO, init=False)
    """Position where the foot stands or last stood, m."""
    previous_position: Vec3 = field(default=ZERO, init=False)
    """Position where the foot stood before `stance_position`, m."""

    def start(self, attitude: Quat, tilt_sigma: float) -> None:
        # the upward direction in the sensor frame: that of the mean specific force from which `attitude` was computed
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
            k = min(self.settings.kp, 0.5 / dt) if dt > 0.0 else 0.0  # at most half of the error in one sample
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
        self.time_since_anchor += dt

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
        """End the motion at this position and velocity, because the evidence is the most certain so far."""
        (x, y, z), (vx, vy, vz), (rx, ry, rz) = position, velocity, stance.v_ref
        half = 0.5 * self.continued_time
        k = 0.5 * self.settings.tilt_share / (GRAVITY * max(self.continued_time, SHORTEST_SWING))  # half angles
        self.tilt_correction = (k * (vy - ry), -k * (vx - rx))
        x, y, z = x + (rx - vx) * half, y + (ry - vy) * half, z + (rz - vz) * half
        if self.settings.eliminate:
            z = self._height_at_end(x, y, z)
        self.stance_position = (x, y, z)
        self.least_sigma = stance.sigma
        if stance.hint is Phase.STATIONARY:
            self.continued_motion = None

    def _height_at_end(self, x: float, y: float, z: float) -> float:
        """Return the height S_z, m, at the end of a stride whose integrated end is (x, y, z), m."""
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
        """Start a motion with the samples in `recent_samples`, in which the foot moved already."""
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
        self.continued_motion = None
        self.recent_samples.clear()
