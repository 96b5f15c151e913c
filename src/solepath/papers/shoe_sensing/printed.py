"""Navigation of Li, Liu, Liu, Chen, Ma, "3D tracking via shoe sensing" (Sensors 16, 1809, 2016), sections 3.2 to 3.4.

Gravity corrects the tilt in stance only. A drift that is linear in time is removed from the velocity and, on level
strides, from the height. V(T) and S(T) are integrated by `Strapdown`; here their drift is taken off. Numbers without a
source were chosen by hand."""

from __future__ import annotations

from math import hypot
from typing import ClassVar

from ...foot.navigate.dedrift import LinearDedrift
from ...foot.stance.stance import Stance
from ...types import Phase, Quat, Vec3
from ...types.attrs import stateful
from ...types.vector import IDENTITY, ZERO, add, sub
from .posture import INITIAL_GAIN, INITIAL_TIME, gravity_direction, gravity_error, is_upside_down, turn
from .steepness import steepness

KP = 1.0
"""Gain of the tilt feedback in stance, 1/s; the paper gives no value."""


@stateful
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

    initial_time: ClassVar[float] = INITIAL_TIME
    """Time in stance, s, in which the first attitude is found, sample by sample, from Q = [1, 0, 0, 0]."""

    initial_left: float = 0.0
    """Time in stance until the first attitude is found, s."""
    last_acc: Vec3 = ZERO
    """Specific force of the last sample, sensor frame, m/s^2."""
    velocity_change: Vec3 = ZERO
    """Change of the velocity by the last sample, m/s."""
    standing: bool = True
    """Flag: the last sample was in stance."""
    stance_position: Vec3 = ZERO
    """Position where the foot stands or last stood, m."""
    previous_position: Vec3 = ZERO
    """Position where the foot stood before `stance_position`, m."""

    def start(self, attitude: Quat, tilt_sigma: float) -> None:
        self.last_acc = gravity_direction(attitude)  # that of the mean specific force which gave `attitude`
        self.initial_left = self.initial_time
        is_iterated = self.initial_left > 0.0 and not is_upside_down(attitude)
        LinearDedrift.start(self, IDENTITY if is_iterated else attitude, tilt_sigma)
        self.stance_position = self.previous_position = ZERO
        self.standing = True

    def predict(self, dt: float, acc: Vec3, gyro: Vec3, saturated: bool = False) -> None:
        rate_before, rate_after, velocity = self.rate or gyro, gyro, self.velocity
        if self.standing:
            k = INITIAL_GAIN if self.initial_left > 0.0 else KP
            self.initial_left = max(0.0, self.initial_left - dt)
            k = min(k, 0.5 / dt) if dt > 0.0 else 0.0  # at most half of the error in one sample
            error = gravity_error(self.attitude, self.last_acc)
            rate_before, rate_after = add(rate_before, error, -k), add(rate_after, error, -k)
        self.last_acc = acc
        self.attitude, self.rate = turn(self.attitude, rate_before, rate_after, dt), None
        LinearDedrift.predict(self, dt, acc, ZERO, saturated)
        self.rate = gyro
        self.velocity_change = sub(self.velocity, velocity)

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
        x, y, z = add(position, sub(v_ref, velocity), 0.5 * duration)
        return (x, y, self.height_at_end(x, y, z))

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
