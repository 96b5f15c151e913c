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
from numpy.typing import NDArray

from ....types.vector import GRAVITY
from .pauses import Floats, Pause, WayBetween

ASSUMED_NOISE, PRIOR_WEIGHT = (0.005, radians(0.03), radians(0.01)), 2.0
"""Assumed noise of a rest on each axis, m/s^2 (half a mg), of a way per root of its angle, rad, and of a bias from one
second to the next, rad/s/sqrt(s), and their weight, residuals.

The last is half of that of an MPU-9250 whose temperature varies by 2 K within five minutes (0.12 degrees/s/K)."""
SHORT_WAY = 7.0
"""Angle of the ways that are fitted first, rad: about one turn, which a scale error of 10 % does not spoil."""
MOST_ITERATIONS, CONVERGED = 40, 1e-8
"""Largest number of iterations of each stage, and the largest change of an element of A or G at which it ends."""
SYMMETRIC = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))
"""Rows and columns of the six elements of A."""
ROWS, COLUMNS = np.array(SYMMETRIC).T
I3 = np.eye(3)
BASIS = np.maximum(I3[ROWS, :, None] * I3[COLUMNS, None], I3[COLUMNS, :, None] * I3[ROWS, None])
"""The matrix of which each element of A is the factor, (6, 3, 3)."""
ACC, ACC_BIAS, GYRO, FIRST_NODE = slice(0, 6), slice(6, 9), slice(9, 18), 18
"""Indices of the unknowns of A, a, G, and of the first rest: then follow b, (3), and the turn of d, (2), of each."""
PER_PAUSE = 5
"""Number of unknowns of each rest."""
PRIOR_SIGMA = np.array([0.3] * 6 + [10.0] * 3 + [0.3] * 9)
"""Standard deviations before any reading: of the elements of A and G about 1 or 0, no unit, and of a, m/s^2."""


Noise = tuple[float, ...]
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
        nodes = step[FIRST_NODE:].reshape(-1, PER_PAUSE)
        up = self.up + np.array([across(one) @ turn for one, turn in zip(self.up, nodes[:, 3:], strict=True)])
        return Unknowns(
            self.acc + np.tensordot(step[ACC], BASIS, 1),
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
    closures: Floats
    """Angle by which each way does not close, rad."""
    excess: Floats
    """Closure of each way divided by its standard deviation."""
    converged: bool
    """True if the iterations have come to an end."""


def across(direction: Floats) -> Floats:
    """Return two unit vectors across a unit vector, as columns, (3, 2)."""
    first = np.cross(direction, I3[int(np.argmin(np.abs(direction)))])
    first /= np.linalg.norm(first)
    return np.stack((first, np.cross(direction, first)), axis=1)


def rotations(vectors: Floats) -> Floats:
    """Return the rotation matrices (N, 3, 3) of rotation vectors (N, 3), rad."""
    angle = np.linalg.norm(vectors, axis=1)[:, None, None] / np.pi
    k = np.cross(I3, vectors[:, None])
    return np.asarray(I3 + np.sinc(angle) * k + 0.5 * np.sinc(0.5 * angle) ** 2 * (k @ k))


def integrate(way: WayBetween, unknowns: Unknowns) -> tuple[Floats, Floats]:
    """Return the turn of a way, and how it depends on the correction G and on the biases at its start and end.

    The turn is the rotation from the sensor frame at the end to that at the start, (3, 3). Its change is a rotation
    vector in the sensor frame at the start, per element of G, (9), and per bias at the start, (3), and the end, (3)."""
    start, end = unknowns.biases[way.number : way.number + 2]
    share = ((way.t - way.t[0]) / (way.t[-1] - way.t[0]))[:, None]
    reading = way.gyro - start - share * (end - start)
    rate, dt = reading @ unknowns.gyro.T, np.diff(way.t)[:, None]
    # the second term is the turn of the axis within an interval
    vectors = 0.5 * dt * (rate[1:] + rate[:-1]) + dt * dt / 12.0 * np.cross(rate[:-1], rate[1:])
    turns = np.concatenate((I3[None], rotations(vectors)))
    distance = 1
    while distance < len(turns):  # products of 2, 4, 8 ... in a row
        turns[distance:] = turns[:-distance] @ turns[distance:]
        distance *= 2
    padded = np.pad(way.t, 1, mode="edge")
    turned = turns * (0.5 * (padded[2:] - padded[:-2]))[:, None, None]
    by_gyro = np.einsum("nij,nk->ijk", turned, reading).reshape(3, 9)
    by_bias = [np.tensordot(part, turned, 1) @ -unknowns.gyro for part in (1.0 - share[:, 0], share[:, 0])]
    return turns[-1], np.hstack((by_gyro, *by_bias))


def fit(pauses: Sequence[Pause], ways: Sequence[WayBetween]) -> Fit:
    """Return the fit to rests and to the ways, none of them spoilt, between some of them."""
    acc = np.array([rest.acc for rest in pauses])
    rates = np.array([rest.rate for rest in pauses])
    unknowns = Unknowns(I3, np.zeros(3), I3, rates, acc / np.linalg.norm(acc, axis=1, keepdims=True))
    short = [way for way in ways if way.angle < SHORT_WAY]
    if short and len(short) < len(ways):
        unknowns = _solve(pauses, short, unknowns).unknowns
    return _solve(pauses, ways, unknowns)


def _way_sigma(way: WayBetween, way_noise: float) -> float:
    return sqrt(way_noise**2 * max(way.angle, 0.1) + way.density**2 * float(way.t[-1] - way.t[0]))


def _solve(pauses: Sequence[Pause], ways: Sequence[WayBetween], unknowns: Unknowns) -> Fit:
    """Return the fit that begins with these unknowns."""
    noise: Noise = ASSUMED_NOISE
    converged = False
    for _ in range(MOST_ITERATIONS):
        rows, residuals, kinds = _system(pauses, ways, unknowns, noise)
        covariance = np.asarray(np.linalg.inv(rows.T @ rows), dtype=np.float64)
        step = -covariance @ (rows.T @ residuals)
        # the residuals after the step, by their slopes
        noise = _components(noise, residuals + rows @ step, kinds, np.sum(rows @ covariance * rows, axis=1))
        unknowns = unknowns.moved(step)
        converged = bool(np.abs(step[:FIRST_NODE]).max() < CONVERGED)
        if converged:
            break
    rows, residuals, kinds = _system(pauses, ways, unknowns, noise)
    excess = np.linalg.norm(residuals[kinds == 1].reshape(-1, 2), axis=1)
    closures = excess * [_way_sigma(way, noise[1]) for way in ways]
    return Fit(unknowns, np.asarray(np.linalg.inv(rows.T @ rows)), noise, closures, excess, converged)


def _components(noise: Noise, residuals: Floats, kinds: NDArray[np.intp], used: Floats) -> Noise:
    """Return the noise of rests, ways and biases from their weighted residuals and redundancies."""
    values = []
    for kind, (assumed, old) in enumerate(zip(ASSUMED_NOISE, noise, strict=True)):
        redundancy = float(np.sum(1.0 - used[kinds == kind]))
        squares = float(np.sum(residuals[kinds == kind] ** 2))
        values.append(old * sqrt((PRIOR_WEIGHT * (assumed / old) ** 2 + squares) / (PRIOR_WEIGHT + redundancy)))
    return tuple(values)


def _system(
    pauses: Sequence[Pause], ways: Sequence[WayBetween], unknowns: Unknowns, noise: Noise
) -> tuple[Floats, Floats, NDArray[np.intp]]:
    """Return weighted rows and weighted residuals of all equations, and the kind of each: the index of its noise.

    Kind 3 is of equations whose noise is known beforehand."""
    rows, residuals, kinds = list[Floats](), list[Floats](), list[int]()

    def add(kind: int, residual: Floats, sigma: float | Floats, *blocks: tuple[int, Floats]) -> None:
        """Add equations; `blocks` are their slopes, each with the index of its first unknown."""
        row = np.zeros((len(residual), FIRST_NODE + PER_PAUSE * len(pauses)))
        for first, block in blocks:
            row[:, first : first + block.shape[1]] = block
        rows.append((row.T / sigma).T)
        residuals.append(residual / sigma)
        kinds.extend([kind] * len(residual))

    bases = [across(one) for one in unknowns.up]
    nodes = range(FIRST_NODE, FIRST_NODE + PER_PAUSE * len(pauses), PER_PAUSE)
    for rest, node, base, up, bias in zip(pauses, nodes, bases, unknowns.up, unknowns.biases, strict=True):
        x = rest.acc - unknowns.acc_bias
        slopes = (0, (BASIS @ x).T), (6, -unknowns.acc), (node + 3, -GRAVITY * base)
        add(0, unknowns.acc @ x - GRAVITY * up, sqrt(noise[0] ** 2 + rest.acc_sigma**2), *slopes)
        vertical = rest.acc / np.linalg.norm(rest.acc)
        frame = np.column_stack((across(vertical), vertical)).T
        sigmas = np.array([rest.level_sigma, rest.level_sigma, rest.upright_sigma])
        add(3, frame @ (bias - rest.rate), sigmas, (node, frame))
    for way in ways:
        k, node = way.number, nodes[way.number]
        turn, slope = integrate(way, unknowns)
        end = bases[k + 1].T
        slope = end @ turn.T @ np.cross(I3, unknowns.up[k]) @ slope
        add(
            1,
            end @ (turn.T @ unknowns.up[k] - unknowns.up[k + 1]),
            _way_sigma(way, noise[1]),
            (9, slope[:, :9]),
            (node, slope[:, 9:12]),
            (node + 3, end @ turn.T @ bases[k]),
            (node + 5, slope[:, 12:]),
            (node + 8, -np.eye(2)),
        )
    changes = np.diff(unknowns.biases, axis=0)
    for rest, other, node, change in zip(pauses, pauses[1:], nodes, changes, strict=False):
        add(2, change, noise[2] * sqrt(other.middle - rest.middle), (node, -I3), (node + 5, I3))
    differences = np.concatenate(((unknowns.acc - I3)[ROWS, COLUMNS], unknowns.acc_bias, (unknowns.gyro - I3).ravel()))
    add(3, differences, PRIOR_SIGMA, (0, np.eye(FIRST_NODE)))
    return np.concatenate(rows), np.concatenate(residuals), np.array(kinds)
