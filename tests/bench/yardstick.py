"""The yardstick of the benchmark: a foot-mounted error-state filter with SHOE in numpy, in the usual style.

It is the textbook method of Foxlin (2005) and Skog et al. (2010), one sample at a time: nine error states (position,
velocity, attitude), SHOE over five samples, and a zero-velocity update when its statistic is below STATISTIC_LIMIT. It
has no gaps, calibration, phases, strides, pressure or activities.

It has the style of published research code, of OpenShoe and its successors in Python: a function for each equation,
with arrays as arguments and results. F and G are built for every sample, a quaternion is converted to a matrix wherever
one is needed, the gain uses an inverse, and SHOE is a loop. Nothing is slowed down on purpose; with constant matrices
built once, rotation matrices and SHOE as one expression the same filter takes some 0.55 of the time (peers.py).
"""

from __future__ import annotations

from collections import deque

import numpy as np
from numpy.typing import NDArray

from solepath import Sample
from solepath.types.vector import GRAVITY

Array = NDArray[np.float64]

WINDOW_SIZE = 5
STATISTIC_LIMIT = 3e5
SIGMA_ACC, SIGMA_GYRO = 0.01, np.radians(0.1)
ACC_NOISE, GYRO_NOISE, ZERO_VELOCITY = 0.5, np.radians(0.5), 0.01
"""Standard deviations of acceleration, m/s^2, of angular rate, rad/s, and of the zero velocity, m/s."""
INITIAL_DEVIATIONS = (1e-5, 1e-2, 1e-3**0.5)
"""Standard deviations of position, m, velocity, m/s, and attitude, rad, at the start."""


def cross_matrix(v: Array) -> Array:
    return np.array([[0.0, -v[2], v[1]], [v[2], 0.0, -v[0]], [-v[1], v[0], 0.0]])


def quaternion_of(r: Array) -> Array:
    """Return the quaternion (w, x, y, z) of the rotation by |r| rad about r."""
    angle = np.linalg.norm(r)
    if angle == 0.0:
        return np.array([1.0, 0.0, 0.0, 0.0])
    return np.concatenate(([np.cos(angle / 2.0)], np.sin(angle / 2.0) * r / angle))


def product(p: Array, q: Array) -> Array:
    """Return the Hamilton product of two quaternions."""
    w, x, y, z = p
    matrix = np.array([[w, -x, -y, -z], [x, w, -z, y], [y, z, w, -x], [z, -y, x, w]])
    return matrix @ q


def matrix_of(q: Array) -> Array:
    """Return the rotation matrix of a unit quaternion."""
    w, v = q[0], q[1:]
    return (w**2 - v @ v) * np.eye(3) + 2.0 * np.outer(v, v) + 2.0 * w * cross_matrix(v)


def state_matrices(attitude: Array, acc: Array, dt: float) -> tuple[Array, Array]:
    """Return F = I + dt Fc of the error states, and G = dt Gc, through which the noise of acc and gyro enters."""
    zero, one, turn = np.zeros((3, 3)), np.eye(3), matrix_of(attitude)
    force = turn @ acc
    fc = np.block([[zero, one, zero], [zero, zero, -cross_matrix(force)], [zero, zero, zero]])
    gc = np.block([[zero, zero], [turn, zero], [zero, turn]])
    return np.eye(9) + dt * fc, dt * gc


def shoe(window: deque[tuple[Array, Array]]) -> float:
    """Return the SHOE statistic of the window; smaller is more still."""
    mean = np.mean([acc for acc, _ in window], axis=0)
    up = mean / np.linalg.norm(mean)
    total = 0.0
    for acc, gyro in window:
        residual = acc - GRAVITY * up
        total += residual @ residual / SIGMA_ACC**2 + gyro @ gyro / SIGMA_GYRO**2
    return float(total) / len(window)


class UsualFilter:
    """A filter in the usual style. `feed` takes the samples of one foot; `position` is the foot's position, m."""

    def __init__(self) -> None:
        self.position = np.zeros(3)
        self.velocity = np.zeros(3)
        self.attitude: Array | None = None
        self.covariance = np.diag(np.repeat(INITIAL_DEVIATIONS, 3) ** 2)
        self.noise = np.diag([ACC_NOISE**2] * 3 + [GYRO_NOISE**2] * 3)
        self.window: deque[tuple[Array, Array]] = deque(maxlen=WINDOW_SIZE)
        self.t = 0.0

    def feed(self, sample: Sample) -> None:
        acc, gyro = np.array(sample.acc), np.array(sample.gyro)
        dt, self.t = sample.t - self.t, sample.t
        self.window.append((acc, gyro))
        if self.attitude is None:
            self.attitude = quaternion_of(_levelling_rotation(acc))
        else:
            self.attitude = self._predict(self.attitude, dt, acc, gyro)
        if len(self.window) == WINDOW_SIZE and shoe(self.window) < STATISTIC_LIMIT:
            self.attitude = self._correct(self.attitude)

    def _predict(self, attitude: Array, dt: float, acc: Array, gyro: Array) -> Array:
        attitude = product(attitude, quaternion_of(gyro * dt))
        attitude = attitude / np.linalg.norm(attitude)
        force = matrix_of(attitude) @ acc
        acceleration = force - np.array([0.0, 0.0, GRAVITY])
        self.position = self.position + self.velocity * dt + 0.5 * acceleration * dt**2
        self.velocity = self.velocity + acceleration * dt
        f, g = state_matrices(attitude, acc, dt)
        self.covariance = f @ self.covariance @ f.T + g @ self.noise @ g.T
        self.covariance = (self.covariance + self.covariance.T) / 2.0
        return attitude

    def _correct(self, attitude: Array) -> Array:
        h = np.block([np.zeros((3, 3)), np.eye(3), np.zeros((3, 3))])
        r = ZERO_VELOCITY**2 * np.eye(3)
        p = self.covariance
        gain = p @ h.T @ np.linalg.inv(h @ p @ h.T + r)
        error = gain @ (np.zeros(3) - self.velocity)
        self.covariance = (np.eye(9) - gain @ h) @ p
        self.covariance = (self.covariance + self.covariance.T) / 2.0
        self.position = self.position + error[0:3]
        self.velocity = self.velocity + error[3:6]
        return product(quaternion_of(error[6:9]), attitude)


def _levelling_rotation(acc: Array) -> Array:
    """Return the rotation vector, rad, that turns the specific force at rest to the vertical."""
    up = acc / np.linalg.norm(acc)
    axis = np.cross(up, [0.0, 0.0, 1.0])
    sine = np.linalg.norm(axis)
    return axis / sine * np.arctan2(sine, up[2]) if sine > 0.0 else axis
