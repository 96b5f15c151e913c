"""Strapdown navigation of one foot: attitude, velocity and position from specific force and angular rate.

The navigation frame is z up, with the heading that the sensor had when its first attitude was found. The tracker turns
it into the world frame. A corrector (`ErrorStateFilter`, `LinearDedrift`) extends this class with the use of stance
evidence, which keeps the integration from drifting. `integrate` is equation (5) of Bebek et
al. 2010 (IEEE Trans. Instrum. Meas. 59)."""

from __future__ import annotations

from math import cos, sin, sqrt

from ...types import Quat, Vec3
from ...types.attrs import define, field
from ...types.vector import GRAVITY, IDENTITY, ZERO, add, from_yaw, multiply, normalise, rotate, turned
from .corrector import Corrector

WIDEST_SERIES = 0.06
"""Square of the half angle up to which the series for sin and cos are accurate to 1e-12, rad^2."""

CONING = 1.0 / 12.0
"""Half of the factor of w1 x w2 in the rotation vector from a sample with rate w1 to the next one with w2, by dt^2.

A rate that changes linearly gives dt^2 / 12 w1 x w2 (coning; Bortz 1971, IEEE Trans. Aerospace 7). The mean of w1 and
w2 is wrong by dt^3 w'' / 12 where the rate is curved; turned into the navigation frame and summed over a stride, that
is once more dt^3 / 12 w x w' per sample, by partial integration. Both have the same sign in every stride and opposite
signs in both feet: without them an emulated heading drifts by 0.6 degrees a minute at 100 Hz and by 2.4 at 50 Hz."""


@define
class Strapdown(Corrector):
    """Integrates attitude by the rotation vector, velocity and position by the trapezoidal rule.

    The interval between samples may vary."""

    attitude: Quat = field(default=IDENTITY, init=False)
    velocity: Vec3 = field(default=ZERO, init=False)
    position: Vec3 = field(default=ZERO, init=False)
    force: Vec3 | None = field(default=None, init=False)
    """Specific force of the last sample, navigation frame, m/s^2; None before any sample and after a gap."""
    rate: Vec3 | None = field(default=None, init=False)
    """Angular rate of the last sample, sensor frame, rad/s; None before any sample and after a gap."""

    def repair(self, yaw: float, position: Vec3) -> None:
        """Turn the attitude by `yaw` rad and set `position`, m."""
        self.attitude = normalise(multiply(from_yaw(yaw), self.attitude))
        self.position = position
        self.force = None

    def turn_about(self, yaw: float, by: Vec3) -> None:
        """Turn attitude, velocity and force by `yaw` rad about the foot, and move it by `by` m."""
        self.attitude = normalise(multiply(from_yaw(yaw), self.attitude))
        self.velocity = turned(self.velocity, yaw)
        if self.force is not None:
            self.force = turned(self.force, yaw)
        self.position = add(self.position, by)

    def integrate(self, dt: float, acc: Vec3, gyro: Vec3) -> Vec3:
        """Integrate one sample; return the mean acceleration over dt, m/s^2."""
        # half the rotation vector of a rate that changes linearly; series for sin and cos, because its angle is small
        gx, gy, gz = gyro
        rx, ry, rz = self.rate or gyro
        k, m = 0.25 * dt, CONING * dt * dt
        hx = k * (gx + rx) + m * (ry * gz - rz * gy)
        hy = k * (gy + ry) + m * (rz * gx - rx * gz)
        hz = k * (gz + rz) + m * (rx * gy - ry * gx)
        self.rate = gyro
        n = hx * hx + hy * hy + hz * hz
        if n < WIDEST_SERIES:
            c = 1.0 - n * (0.5 - n * (1.0 / 24.0 - n * (1.0 / 720.0 - n / 40320.0)))
            s = 1.0 - n * (1.0 / 6.0 - n * (1.0 / 120.0 - n * (1.0 / 5040.0 - n / 362880.0)))
        else:
            angle = sqrt(n)
            c, s = cos(angle), sin(angle) / angle
        qw, qx, qy, qz = multiply(self.attitude, (c, hx * s, hy * s, hz * s))
        k = 1.5 - 0.5 * (qw * qw + qx * qx + qy * qy + qz * qz)  # one Newton step towards length 1
        self.attitude = attitude = (qw * k, qx * k, qy * k, qz * k)
        fx, fy, fz = force = rotate(attitude, acc)
        px, py, pz = self.force or force
        # trapezoidal rule: a = (f + f_previous) / 2 - g, v <- v + a dt, p <- p + (v + v_previous) dt / 2
        ax, ay, az = 0.5 * (fx + px), 0.5 * (fy + py), 0.5 * (fz + pz) - GRAVITY
        self.force = force
        u, v, w = self.velocity
        vx, vy, vz = u + ax * dt, v + ay * dt, w + az * dt
        self.velocity = (vx, vy, vz)
        k = 0.5 * dt
        x, y, z = self.position
        self.position = (x + k * (u + vx), y + k * (v + vy), z + k * (w + vz))
        return ax, ay, az
