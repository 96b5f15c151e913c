"""Attitude of a foot by Li, Liu, Liu, Chen, Ma, "3D tracking via shoe sensing" (Sensors 16, 1809, 2016), section 3.2.

A vector product with gravity gives the tilt, and Runge and Kutta's fourth-order method integrates the quaternion. Q
turns vectors from the sensor frame to the reference frame, whose gravitational vector is aR = [0, 0, 1]: the direction
of an accelerometer's reading at rest, upwards. gb is aR turned into the sensor frame, g'R the measured direction there;
both are unit vectors. e = gb x g'R has the axis of Q's tilt error and, if small, its angle, rad.

The first attitude is found sample by sample: with each sample at rest Q, which starts as [1, 0, 0, 0] (fig. 6), turns
as it does in every stance, gyro' = gyro - Kp e. The paper does not describe its P, "the solution process of the
quaternion", any further."""

from __future__ import annotations

from math import sqrt

from ...types import Quat, Vec3
from ...types.vector import from_rotation_vector, multiply, normalise

INITIAL_TIME = 4.0
"""Time to the first attitude, s: it "will converge in about 4 s (i.e., 400 points)" (fig. 7)."""
INITIAL_GAIN = 2.0
"""Gain Kp in that time, 1/s. The tangent of half the error falls as exp(-Kp t), to 3e-4 in the 4 s of fig. 7."""
LEAST_COSINE = 0.1
"""Cosine of half the tilt below which a sensor is upside down."""
LARGEST_SQUARED_TURN = 1.0
"""Square of the largest rotation within one sample, rad^2, for which Runge and Kutta's error is at most 1e-3 rad.

A larger rotation, which occurs at low sample rates, is computed in closed form."""


def gravity_direction(attitude: Quat) -> Vec3:
    """Return gb, the upward direction in the sensor frame, a unit vector."""
    q0, q1, q2, q3 = attitude
    return (2.0 * (q1 * q3 - q0 * q2), 2.0 * (q2 * q3 + q0 * q1), q0 * q0 - q1 * q1 - q2 * q2 + q3 * q3)


def gravity_error(attitude: Quat, acc: Vec3) -> Vec3:
    """Return the tilt error e = gb x g'R, sensor frame, rad; zero if `acc` is zero.

    `acc` is the measured specific force, in any unit."""
    x, y, z = acc
    length = sqrt(x * x + y * y + z * z)
    if length < 1e-9:
        return (0.0, 0.0, 0.0)
    k = 1.0 / length
    x, y, z = x * k, y * k, z * k
    bx, by, bz = gravity_direction(attitude)
    return (by * z - bz * y, bz * x - bx * z, bx * y - by * x)


def is_upside_down(attitude: Quat) -> bool:
    """Return whether a sensor with this first attitude, which has no heading, is almost upside down.

    Then the vector product is zero without giving an axis, and no iteration from Q = [1, 0, 0, 0] converges."""
    return abs(attitude[0]) <= LEAST_COSINE


def turn(q: Quat, rate_before: Vec3, rate_after: Vec3, dt: float) -> Quat:
    """Return Q after `dt` s in which the rate changes linearly between two values, sensor frame, rad/s.

    Q' = 1/2 Q w, of which the paper prints the matrix, is integrated by Q_n+1 = Q_n + h/6 (k1 + 2 k2 + 2 k3 + k4) and
    normalised; h is `dt`. The paper prints 3 k3, which must be a mistake: the weights of the classical method add up to
    6, and with 3 k3 every rotation would be a sixth too large. The paper's f(w_n + h/2, ...) is taken to be the rate in
    the middle of the interval, the mean of both rates."""
    ax, ay, az = rate_before
    cx, cy, cz = rate_after
    half = 0.5 * dt
    ax, ay, az, cx, cy, cz = ax * half, ay * half, az * half, cx * half, cy * half, cz * half
    bx, by, bz = 0.5 * (ax + cx), 0.5 * (ay + cy), 0.5 * (az + cz)
    if 4.0 * (bx * bx + by * by + bz * bz) > LARGEST_SQUARED_TURN:
        return normalise(multiply(q, from_rotation_vector((2.0 * bx, 2.0 * by, 2.0 * bz))))
    # k1 to k3 are multiplied by the interval: h k1 and so on
    w, x, y, z = q
    k1w = -ax * x - ay * y - az * z
    k1x = ax * w + az * y - ay * z
    k1y = ay * w - az * x + ax * z
    k1z = az * w + ay * x - ax * y
    pw, px, py, pz = w + 0.5 * k1w, x + 0.5 * k1x, y + 0.5 * k1y, z + 0.5 * k1z
    k2w = -bx * px - by * py - bz * pz
    k2x = bx * pw + bz * py - by * pz
    k2y = by * pw - bz * px + bx * pz
    k2z = bz * pw + by * px - bx * py
    pw, px, py, pz = w + 0.5 * k2w, x + 0.5 * k2x, y + 0.5 * k2y, z + 0.5 * k2z
    k3w = -bx * px - by * py - bz * pz
    k3x = bx * pw + bz * py - by * pz
    k3y = by * pw - bz * px + bx * pz
    k3z = bz * pw + by * px - bx * py
    pw, px, py, pz = w + k3w, x + k3x, y + k3y, z + k3z
    sixth = 1.0 / 6.0
    w += (k1w + 2.0 * (k2w + k3w) - cx * px - cy * py - cz * pz) * sixth
    x += (k1x + 2.0 * (k2x + k3x) + cx * pw + cz * py - cy * pz) * sixth
    y += (k1y + 2.0 * (k2y + k3y) + cy * pw - cz * px + cx * pz) * sixth
    z += (k1z + 2.0 * (k2z + k3z) + cz * pw + cy * px - cx * py) * sixth
    k = 1.0 / sqrt(w * w + x * x + y * y + z * z)
    return (w * k, x * k, y * k, z * k)
