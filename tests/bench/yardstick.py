"""A yardstick for the benchmark: a foot-mounted filter written the way it usually is, with numpy for everything.

Nine error states (position, velocity, attitude), the SHOE detector over a window of five samples, a zero-velocity
update whenever its statistic is below the gate: the textbook arrangement of Foxlin (2005) and Skog et al. (2010), one
sample at a time. It is honest code, not slowed down: matrices are made once where they can be, and nothing is computed
twice. What it does not do is what makes up a session: gaps, calibration, phases, steps, pressure.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from solepath import Sample
from solepath.vector import GRAVITY

Array = NDArray[np.float64]

WINDOW = 5
GATE = 3e5
SIGMA_ACC, SIGMA_GYRO = 0.01, np.radians(0.1)
ACC_NOISE, GYRO_NOISE, ZERO_VELOCITY = 0.5, np.radians(0.5), 0.01
"""m/s^2, rad/s, m/s."""


def cross_matrix(v: Array) -> Array:
    return np.array([[0.0, -v[2], v[1]], [v[2], 0.0, -v[0]], [-v[1], v[0], 0.0]])


def rotation(r: Array) -> Array:
    """The matrix that turns by |r| rad about r (Rodrigues)."""
    angle = float(np.linalg.norm(r))
    if angle < 1e-12:
        return np.eye(3)
    k = cross_matrix(r / angle)
    return np.eye(3) + np.sin(angle) * k + (1.0 - np.cos(angle)) * (k @ k)


class Yardstick:
    """Feed it the samples of one foot; `position` is where it is, m."""

    def __init__(self) -> None:
        self.position = np.zeros(3)
        self.velocity = np.zeros(3)
        self.attitude: Array | None = None
        self.covariance = np.diag([1e-10] * 3 + [1e-4] * 3 + [1e-3] * 3)
        self.acc = np.zeros((WINDOW, 3))
        self.gyro = np.zeros((WINDOW, 3))
        self.count = 0
        self.t = 0.0
        self.process = np.diag([0.0] * 3 + [ACC_NOISE**2] * 3 + [GYRO_NOISE**2] * 3)
        self.measure = np.hstack([np.zeros((3, 3)), np.eye(3), np.zeros((3, 3))])
        self.noise = ZERO_VELOCITY**2 * np.eye(3)
        self.gravity = np.array([0.0, 0.0, GRAVITY])

    def feed(self, sample: Sample) -> None:
        acc, gyro = np.array(sample.acc), np.array(sample.gyro)
        self.acc[self.count % WINDOW], self.gyro[self.count % WINDOW] = acc, gyro
        self.count += 1
        dt, self.t = sample.t - self.t, sample.t
        if self.attitude is None:
            self._level(acc)
        else:
            self._predict(dt, acc, gyro)
        if self.count >= WINDOW and self._statistic() < GATE:
            self._correct()

    def _level(self, acc: Array) -> None:
        up = acc / np.linalg.norm(acc)
        axis = np.cross(up, [0.0, 0.0, 1.0])
        sine = np.linalg.norm(axis)
        turn = axis / sine * np.arctan2(sine, up[2]) if sine > 0.0 else axis
        self.attitude = rotation(turn)

    def _predict(self, dt: float, acc: Array, gyro: Array) -> None:
        self.attitude = self.attitude @ rotation(gyro * dt)
        force = self.attitude @ acc
        acceleration = force - self.gravity
        self.position = self.position + self.velocity * dt + 0.5 * acceleration * dt**2
        self.velocity = self.velocity + acceleration * dt
        transition = np.eye(9)
        transition[:3, 3:6] = dt * np.eye(3)
        transition[3:6, 6:] = -dt * cross_matrix(force)
        self.covariance = transition @ self.covariance @ transition.T + self.process * dt**2

    def _statistic(self) -> float:
        mean = self.acc.mean(axis=0)
        off = self.acc - GRAVITY * mean / np.linalg.norm(mean)
        return float(((off**2).sum() / SIGMA_ACC**2 + (self.gyro**2).sum() / SIGMA_GYRO**2) / WINDOW)

    def _correct(self) -> None:
        h, p = self.measure, self.covariance
        gain = p @ h.T @ np.linalg.inv(h @ p @ h.T + self.noise)
        error = gain @ -self.velocity
        self.covariance = (np.eye(9) - gain @ h) @ p
        self.position = self.position + error[:3]
        self.velocity = self.velocity + error[3:6]
        self.attitude = rotation(error[6:]) @ self.attitude
