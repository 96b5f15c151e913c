"""Navigation of Li, Liu, Liu, Chen, Ma, "3D tracking via shoe sensing" (Sensors 16, 1809, 2016), sections 3.2 to 3.4.

Gravity corrects the tilt in stance only. A drift that is linear in time is removed from the velocity and, on level
strides, from the height. Numbers without a source were chosen by hand."""

from __future__ import annotations

from math import hypot, sqrt

from ...foot.navigate.dedrift import LinearDedrift
from ...foot.settings import DedriftSettings
from ...foot.stance.stance import Stance
from ...types import Phase, Quat, Vec3
from ...types.attrs import define, field, frozen
from ...types.vector import GRAVITY, IDENTITY, ZERO, rotate
from .posture import INITIAL_GAIN, INITIAL_TIME, gravity_direction, gravity_error, is_upside_down, turn
from .steepness import steepness

HIGHEST_SPEED = 15.0
"""Highest speed of a foot, m/s."""


@frozen
class GatedTiltSettings(DedriftSettings):
    """Settings of `GatedTilt`."""

    kp: float = 1.0
    """Gain of the tilt feedback in stance, 1/s; the paper gives no value."""
    eliminate: bool = True
    """Flag: the height error of level strides is removed."""
    initial_time: float = INITIAL_TIME
    """Time in stance, s, in which the first attitude is found, sample by sample, from Q = [1, 0, 0, 0].

    0 for an attitude that is known at once, from the mean specific force of the first samples at rest."""


@define
class GatedTilt(LinearDedrift):
    """Corrector as printed: tilt feedback in stance, and removal of linear drifts of velocity and height.

    In stance gyro' = gyro - Kp e, with a larger Kp in the first `initial_time` (posture.py). The quaternion is
    integrated by Runge and Kutta's method. At the end of a motion from t_a to t_b, e~ (T - t_a) is subtracted from
    V(T), and e~_s (T - t_a) from the height S_z(T). Evidence without the hint STATIONARY is not used. Frame and units
    are those of `Corrector`. Latency: velocity, position and height are corrected in one jump at the first sample of
    stance.

    e~ = (dv2 - dv1) / (t_b - t_a) of section 3.3 is the velocity left when the foot stands again, divided by the time
    since it last stood. So half of the product of both is subtracted from the position. The height error of
    section 3.4.2 is removed likewise: after a level stride the foot stands as high as before. The paper does not say
    how its live track knows e~_s before t_b. Here the live height within a stride (`FootMoved`) has the whole drift
    since t_a. It is corrected in one jump when the foot stands, and earlier heights are not reported again. The paper
    prints V(T) and S_z(T) with `stationary = 1` for the moving foot, but its section 3.1.2 has the opposite. A stride
    is level by its angle per metre (steepness.py)."""

    settings: GatedTiltSettings = GatedTiltSettings()
    initial_left: float = field(default=0.0, init=False)
    """Time in stance until the first attitude is found, s."""
    last_acc: Vec3 = field(default=ZERO, init=False)
    """Specific force of the last sample, sensor frame, m/s^2."""
    velocity_change: Vec3 = field(default=ZERO, init=False)
    """Change of the velocity by the last sample, m/s."""
    standing: bool = field(default=True, init=False)
    """Flag: the last sample was in stance."""
    stance_position: Vec3 = field(default=ZERO, init=False)
    """Position where the foot stands or last stood, m."""
    previous_position: Vec3 = field(default=ZERO, init=False)
    """Position where the foot stood before `stance_position`, m."""

    def start(self, attitude: Quat, tilt_sigma: float) -> None:
        self.last_acc = gravity_direction(attitude)  # that of the mean specific force which gave `attitude`
        self.initial_left = self.settings.initial_time
        is_iterated = self.initial_left > 0.0 and not is_upside_down(attitude)
        LinearDedrift.start(self, IDENTITY if is_iterated else attitude, tilt_sigma)
        self.stance_position = self.previous_position = ZERO
        self.standing = True

    def predict(self, dt: float, acc: Vec3, gyro: Vec3, saturated: bool = False) -> None:
        rate_before = gyro if self.rate is None else self.rate
        self.rate = rate_after = gyro
        attitude = self.attitude
        if self.standing:
            k = self.settings.kp
            if self.initial_left > 0.0:
                self.initial_left -= dt
                k = INITIAL_GAIN
            k = min(k, 0.5 / dt) if dt > 0.0 else 0.0  # at most half of the error in one sample
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
        self.swing += dt
        self.time_since_anchor += dt

    def correct(self, t: float, stance: Stance) -> bool:
        was_standing, self.standing = self.standing, stance.hint is Phase.STATIONARY
        if not self.standing:
            return False
        if not was_standing:
            self.previous_position = self.stance_position
            self.stance_position = self.dedrifted(self.position, self.velocity, self.swing, stance.v_ref)
        self.swing = 0.0
        self.position, self.velocity = self.stance_position, stance.v_ref
        return True

    def dedrifted(self, position: Vec3, velocity: Vec3, duration: float, v_ref: Vec3) -> Vec3:
        """Return where the foot stands after a motion that was integrated to `position`, m, and `velocity`, m/s.

        The motion lasted `duration` s and began at `previous_position`; its true last velocity is `v_ref`, m/s."""
        (x, y, z), (vx, vy, vz), (rx, ry, rz) = position, velocity, v_ref
        half = 0.5 * duration
        x, y, z = x + (rx - vx) * half, y + (ry - vy) * half, z + (rz - vz) * half
        return (x, y, self.height_at_end(x, y, z) if self.settings.eliminate else z)

    def height_at_end(self, x: float, y: float, z: float) -> float:
        """Return the height S_z, m, at the end of a stride whose integrated end is (x, y, z), m."""
        bx, by, bz = self.previous_position
        return bz if steepness(hypot(x - bx, y - by), z - bz) == 0 else z

    def infill(self, dt: float, attitude: Quat, velocity: Vec3, position: Vec3) -> None:
        self.standing = False
        LinearDedrift.infill(self, dt, attitude, velocity, position)

    def repair(self, yaw: float, position: Vec3) -> None:
        LinearDedrift.repair(self, yaw, position)
        self.stance_position = self.previous_position = position
