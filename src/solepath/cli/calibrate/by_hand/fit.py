"""Fits scale, axes and bias of both sensors to rests and to the ways between them, by Gauss-Newton.

Unknown are the correction of the accelerometer, f = A (reading - a) with a symmetric A, that of the gyroscope,
w = G (reading - b) with any G, the bias b at each rest, and the direction d of gravity, sensor frame, at each rest.
Observed are

- the mean reading of every rest: A (reading - a) = g d, whose length is that of Ferraris et al. (1995) and Tedaldi et
  al. (2014), 9 unknowns from 12 rests;
- every way: the rate integrated from the middle of one rest to that of the next must turn d into the next d. A creep of
  the hand during a rest is part of the ways before and after it;
- the mean rate of every rest, as its bias, and that a bias changes slowly from rest to rest.

A symmetric A is a choice: gravity does not show how the sensor is turned in its case, and this A turns nothing. It
makes a frame of three right angles as near the axes of the accelerometer as there is, and G brings the gyroscope into
it.

A turn about the vertical moves no gravity, so a way says nothing about it. Other ways do, in which another axis of the
sensor is vertical. What all ways leave open has a large standard deviation (coverage.py).

Standard deviations are from the residuals: the noise of rests and that of ways are two variance components (Foerstner
1979, ZfV 104), each with the weight of `PRIOR_WEIGHT` residuals of the assumed one, because ten residuals alone show a
variance to a third only. Noise of a way grows with the root of the angle that the sensor turned through: it is made of
errors of many small turns."""

from __future__ import annotations

from collections.abc import Sequence
from math import radians, sqrt

import numpy as np
from attrs import frozen

from ....types.vector import GRAVITY
from .pauses import Floats, Pause, WayBetween

ASSUMED_NOISE, PRIOR_WEIGHT = (0.005, radians(0.03), radians(0.01)), 2.0
"""Assumed noise of a rest on each axis, m/s^2 (half a mg), of a way per root of its angle, rad, and of a bias from one
second to the next, rad/s/sqrt(s), and their weight, residuals.

The last is half of that of an MPU-9250 whose temperature varies by 2 K within five minutes (0.12 degrees/s/K)."""
PRIOR_ERROR, PRIOR_BIAS = 0.3, 10.0
"""Standard deviations before any reading: of the elements of A and G about 1 or 0, no unit, and of a, m/s^2."""
SHORT_WAY = 7.0
"""Angle of the ways that are fitted first, rad: about one turn, which a scale error of 10 % does not spoil."""
MOST_ITERATIONS, CONVERGED = 40, 1e-8
"""Largest number of iterations of each stage, and the largest change of an element of A or G at which it ends."""
SYMMETRIC = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))
"""Rows and columns of the six elements of A."""
ACC, ACC_BIAS, GYRO, FIRST_NODE = slice(0, 6), slice(6, 9), slice(9, 18), 18
"""Indices of the unknowns of A, a, G, and of the first rest: then follow b, (3), and the turn of d, (2), of each."""
PER_PAUSE = 5
"""Number of unknowns of each rest."""


Noise = tuple[float, float, float]
"""Noise of rests, m/s^2, of ways, rad per root of rad, and of biases, rad/s/sqrt(s)."""


@frozen(eq=False)
class Unknowns:
    """The values of all unknowns."""

    acc: Floats
    """Correction A of the accelerometer, symmetric, (3, 3)."""
    acc_bias: Floats
    """Bias of the accelerometer, m/s^2, (3)."""
    gyro: Floats
    """Correction G of the gyroscope, (3, 3)."""
    biases: Floats
    """Bias of the gyroscope at each rest, rad/s, (n, 3)."""
    up: Floats
    """Unit vectors of the specific force at each rest, sensor frame, (n, 3)."""

    def moved(self, step: Floats) -> Unknowns:
        """Return the unknowns after a step."""
        acc = self.acc.copy()
        for value, (i, j) in zip(step[ACC], SYMMETRIC, strict=True):
            acc[i, j] += value
            if i != j:
                acc[j, i] += value
        nodes = step[FIRST_NODE:].reshape(-1, PER_PAUSE)
        up = self.up + np.einsum("nij,nj->ni", np.stack([across(one) for one in self.up]), nodes[:, 3:])
        return Unknowns(
            acc,
            self.acc_bias + step[ACC_BIAS],
            self.gyro + step[GYRO].reshape(3, 3),
            self.biases + nodes[:, :3],
            up / np.linalg.norm(up, axis=1, keepdims=True),
        )


@frozen(eq=False)
class Fit:
    """The result of a fit."""

    unknowns: Unknowns
    covariance: Floats
    """Covariance of all unknowns, in the order of the indices of this module."""
    noise: Noise
    """Noise of rests, ways and biases."""
    closures: tuple[float, ...]
    """Angle by which each way does not close, rad."""
    excess: tuple[float, ...]
    """Closure of each way divided by its standard deviation."""
    converged: bool
    """True if the iterations have come to an end."""


@frozen(eq=False)
class _Integral:
    """The turn of a way, and how it depends on the correction of the gyroscope."""

    turn: Floats
    """Rotation from the sensor frame at the end to that at the start, (3, 3)."""
    by_gyro: Floats
    """Change of the turn, as a rotation vector in the sensor frame at the start, per element of G, (3, 9)."""
    by_bias: tuple[Floats, Floats]
    """The same per bias at the start and at the end, (3, 3) each."""


def across(direction: Floats) -> Floats:
    """Return two unit vectors across a unit vector, as columns, (3, 2)."""
    first = np.cross(direction, np.eye(3)[int(np.argmin(np.abs(direction)))])
    first /= np.linalg.norm(first)
    return np.stack((first, np.cross(direction, first)), axis=1)


def cross_matrix(v: Floats) -> Floats:
    """Return the matrix (3, 3) of the vector product with v."""
    x, y, z = v
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])


def rotations(vectors: Floats) -> Floats:
    """Return the rotation matrices (N, 3, 3) of rotation vectors (N, 3), rad."""
    angle = np.linalg.norm(vectors, axis=1)[:, None, None]
    k = np.zeros((len(vectors), 3, 3))
    k[:, 0, 1], k[:, 0, 2], k[:, 1, 2] = -vectors[:, 2], vectors[:, 1], -vectors[:, 0]
    k -= np.swapaxes(k, 1, 2)
    half = np.sinc(0.5 * angle / np.pi)
    return np.asarray(np.eye(3) + np.sinc(angle / np.pi) * k + 0.5 * half * half * (k @ k))


def integrate(way: WayBetween, gyro: Floats, start: Floats, end: Floats) -> _Integral:
    """Return the turn of a way with the correction G and the biases at its start and end, rad/s."""
    share = ((way.t - way.t[0]) / (way.t[-1] - way.t[0]))[:, None]
    reading = way.gyro - start - share * (end - start)
    rate, dt = reading @ gyro.T, np.diff(way.t)[:, None]
    # the second term is the turn of the axis within an interval
    vectors = 0.5 * dt * (rate[1:] + rate[:-1]) + dt * dt / 12.0 * np.cross(rate[:-1], rate[1:])
    turns = np.concatenate((np.eye(3)[None], rotations(vectors)))
    distance = 1
    while distance < len(turns):  # products of 2, 4, 8 ... in a row
        turns[distance:] = turns[:-distance] @ turns[distance:]
        distance *= 2
    weight = 0.5 * (np.concatenate((dt, [[0.0]])) + np.concatenate(([[0.0]], dt)))
    turned = turns * weight[:, :, None]
    by_gyro = np.einsum("nij,nk->ijk", turned, reading).reshape(3, 9)
    early = np.einsum("nij,n->ij", turned, 1.0 - share[:, 0]) @ gyro
    late = np.einsum("nij,n->ij", turned, share[:, 0]) @ gyro
    return _Integral(turns[-1], by_gyro, (-early, -late))


def fit(pauses: Sequence[Pause], ways: Sequence[WayBetween]) -> Fit:
    """Return the fit to rests and to the ways, none of them spoilt, between some of them."""
    acc = np.array([rest.acc for rest in pauses])
    mean = acc / np.linalg.norm(acc, axis=1, keepdims=True)
    rates = np.array([rest.rate for rest in pauses])
    unknowns = Unknowns(np.eye(3), np.zeros(3), np.eye(3), rates, mean)
    short = [way for way in ways if way.angle < SHORT_WAY]
    if short and len(short) < len(ways):
        unknowns, _, _ = _solve(pauses, short, unknowns, ASSUMED_NOISE)
    unknowns, noise, converged = _solve(pauses, ways, unknowns, ASSUMED_NOISE)
    normal, _, residuals, _ = _system(pauses, ways, unknowns, noise)
    first = 3 * len(pauses)
    last = first + 2 * len(ways)
    excess = np.linalg.norm(residuals[first:last].reshape(-1, 2), axis=1)
    sigmas = np.array([_way_sigma(way, noise[1]) for way in ways])
    return Fit(
        unknowns, np.asarray(np.linalg.inv(normal), dtype=np.float64), noise, tuple((excess * sigmas).tolist()),
        tuple(excess.tolist()), converged,
    )  # fmt: skip


def _way_sigma(way: WayBetween, way_noise: float) -> float:
    return sqrt(way_noise**2 * max(way.angle, 0.1) + way.density**2 * float(way.t[-1] - way.t[0]))


def _solve(
    pauses: Sequence[Pause], ways: Sequence[WayBetween], unknowns: Unknowns, noise: Noise
) -> tuple[Unknowns, Noise, bool]:
    """Return the unknowns, the noise of rests and ways, and whether the iterations have converged."""
    for _ in range(MOST_ITERATIONS):
        normal, gradient, residuals, rows = _system(pauses, ways, unknowns, noise)
        covariance = np.asarray(np.linalg.inv(normal), dtype=np.float64)
        step = -covariance @ gradient
        # the residuals after the step, by their slopes
        noise = _components(len(pauses), len(ways), noise, residuals + rows @ step, rows, covariance)
        unknowns = unknowns.moved(step)
        if np.abs(step[:FIRST_NODE]).max() < CONVERGED:
            return unknowns, noise, True
    return unknowns, noise, False


def _components(pauses: int, ways: int, noise: Noise, residuals: Floats, rows: Floats, covariance: Floats) -> Noise:
    """Return the noise of rests, ways and biases from their weighted residuals and redundancies."""
    used = np.einsum("ij,ij->i", rows @ covariance, rows)
    first, last = 3 * pauses, 3 * pauses + 2 * ways
    values = []
    parts = (slice(0, first), slice(first, last), slice(last, last + 3 * (pauses - 1)))
    for assumed, old, part in zip(ASSUMED_NOISE, noise, parts, strict=True):
        redundancy = float(np.sum(1.0 - used[part]))
        squares = float(np.sum(residuals[part] ** 2))
        values.append(old * sqrt((PRIOR_WEIGHT * (assumed / old) ** 2 + squares) / (PRIOR_WEIGHT + redundancy)))
    return values[0], values[1], values[2]


def _system(
    pauses: Sequence[Pause], ways: Sequence[WayBetween], unknowns: Unknowns, noise: Noise
) -> tuple[Floats, Floats, Floats, Floats]:
    """Return normal matrix, gradient, weighted residuals and weighted rows of all equations."""
    count = FIRST_NODE + PER_PAUSE * len(pauses)
    rows, residuals = [], []

    def add(row: Floats, residual: Floats, sigma: float) -> None:
        rows.append(row / sigma)
        residuals.append(residual / sigma)

    bases = [across(one) for one in unknowns.up]
    for k, rest in enumerate(pauses):
        row, node = np.zeros((3, count)), FIRST_NODE + PER_PAUSE * k
        x = rest.acc - unknowns.acc_bias
        for number, (i, j) in enumerate(SYMMETRIC):
            row[i, number] += x[j]
            if i != j:
                row[j, number] += x[i]
        row[:, ACC_BIAS] = -unknowns.acc
        row[:, node + 3 : node + 5] = -GRAVITY * bases[k]
        add(row, unknowns.acc @ x - GRAVITY * unknowns.up[k], sqrt(noise[0] ** 2 + rest.acc_sigma**2))
    for way in ways:
        k, row = way.number, np.zeros((3, count))
        node = FIRST_NODE + PER_PAUSE * k
        whole = integrate(way, unknowns.gyro, unknowns.biases[k], unknowns.biases[k + 1])
        by_turn = whole.turn.T @ cross_matrix(unknowns.up[k])
        row[:, GYRO] = by_turn @ whole.by_gyro
        row[:, node : node + 3], row[:, node + 5 : node + 8] = (by_turn @ one for one in whole.by_bias)
        row[:, node + 3 : node + 5] = whole.turn.T @ bases[k]
        row[:, node + 8 : node + 10] = -bases[k + 1]
        residual = whole.turn.T @ unknowns.up[k] - unknowns.up[k + 1]
        add(bases[k + 1].T @ row, bases[k + 1].T @ residual, _way_sigma(way, noise[1]))
    for k, (rest, other) in enumerate(zip(pauses, pauses[1:], strict=False)):
        row, node = np.zeros((3, count)), FIRST_NODE + PER_PAUSE * k
        row[:, node : node + 3], row[:, node + 5 : node + 8] = -np.eye(3), np.eye(3)
        sigma = noise[2] * sqrt(other.middle - rest.middle)
        add(row, unknowns.biases[k + 1] - unknowns.biases[k], sigma)
    for k, rest in enumerate(pauses):
        row, node = np.zeros((3, count)), FIRST_NODE + PER_PAUSE * k
        row[:, node : node + 3] = np.eye(3)
        up = rest.acc / np.linalg.norm(rest.acc)
        frame, sigmas = np.column_stack((across(up), up)), np.array([rest.level_sigma] * 2 + [rest.upright_sigma])
        weight = frame.T / sigmas[:, None]
        add(weight @ row, weight @ (unknowns.biases[k] - rest.rate), 1.0)
    beforehand = np.zeros((FIRST_NODE, count))
    beforehand[:, :FIRST_NODE] = np.eye(FIRST_NODE)
    beforehand[ACC] /= PRIOR_ERROR
    beforehand[ACC_BIAS] /= PRIOR_BIAS
    beforehand[GYRO] /= PRIOR_ERROR
    differences = np.concatenate(
        ([unknowns.acc[i, j] - (i == j) for i, j in SYMMETRIC], unknowns.acc_bias, (unknowns.gyro - np.eye(3)).ravel())
    )
    rows.append(beforehand)
    residuals.append(np.diag(beforehand) * differences)
    matrix, vector = np.concatenate(rows), np.concatenate(residuals)
    return matrix.T @ matrix, matrix.T @ vector, vector, matrix
