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
from ...types.vector import ZERO, add, add_quat, cross, dot, from_rotation_vector, multiply, normalise, sub

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
    """Return gb, the upward direction in the sensor frame, a unit vector.

    gb = C aR with the paper's matrix C would be its third column; the components that it prints are those of the third
    row, the column of the transposed matrix, which turns vectors of the reference frame into the sensor's. They are
    used."""
    q0, q1, q2, q3 = attitude
    return (2.0 * (q1 * q3 - q0 * q2), 2.0 * (q2 * q3 + q0 * q1), q0 * q0 - q1 * q1 - q2 * q2 + q3 * q3)


def gravity_error(attitude: Quat, acc: Vec3) -> Vec3:
    """Return the tilt error e = gb x g'R, sensor frame, rad; zero if `acc` is zero.

    `acc` is the measured specific force, in any unit."""
    length = sqrt(dot(acc, acc))
    return ZERO if length < 1e-9 else cross(gravity_direction(attitude), add(ZERO, acc, 1.0 / length))


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
    middle = add(rate_before, sub(rate_after, rate_before), 0.5)
    if dt * dt * dot(middle, middle) > LARGEST_SQUARED_TURN:
        return normalise(multiply(q, from_rotation_vector(add(ZERO, middle, dt))))
    slopes: list[Quat] = []
    for rate, step in ((rate_before, 0.0), (middle, 0.5), (middle, 0.5), (rate_after, 1.0)):
        at = add_quat(q, slopes[-1], step) if slopes else q
        slopes.append(multiply(at, (0.0, *add(ZERO, rate, 0.5 * dt))))
    for slope, weight in zip(slopes, (1.0, 2.0, 2.0, 1.0), strict=True):
        q = add_quat(q, slope, weight / 6.0)
    return normalise(q)
