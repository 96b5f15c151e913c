"""Sensor models, from the true signal to the counts of a part: errors, low pass, saturation, quantisation.

Signals are computed at several instants per sample and pass the part's low pass before they are sampled. Frequencies
above half of the sampling rate are therefore attenuated, or alias, as in the real part."""

from __future__ import annotations

from itertools import repeat
from math import ceil, cos, exp, inf, pi, sin, sqrt
from typing import Any

import numpy as np
from attrs import frozen
from numpy.typing import NDArray

from ...types import Sample, Site
from ...types.vector import GRAVITY
from ..wearers.curves import Array, Rng
from ..wearers.motion import Kinematics
from ..wearers.turning import multiply_quaternions
from .parts import AttitudePart, BarometerPart, CellPart, Imu, Triad

INTERNAL_RATE = 800.0
"""Least rate at which a signal is computed before it is filtered, Hz."""


@frozen(eq=False)
class Instants:
    """Sampling instants of a device, and the finer instants at which its signals are computed."""

    taken: Array
    """True times of the samples, s, (N)."""
    fine: Array
    """True times of the fine instants, s."""
    every: int
    """Number of fine instants per sample."""
    before: int
    """Number of fine instants before the first sample, which let the filter settle."""

    @property
    def rate(self) -> float:
        """Rate of the fine instants, Hz."""
        return 1.0 / float(self.fine[1] - self.fine[0])


def instants(first: float, interval: float, count: int) -> Instants:
    """Return the instants of `count` samples from `first` s on, `interval` s apart."""
    every = max(1, ceil(INTERNAL_RATE * interval))
    step = interval / every
    before = ceil(0.12 / step)
    fine = first + step * np.arange(-before, (count - 1) * every + 1, dtype=np.float64)
    return Instants(first + interval * np.arange(count, dtype=np.float64), fine, every, before)


@frozen(eq=False)
class CountReading:
    """Counts of a part, and where they are saturated."""

    counts: np.ndarray[tuple[int, ...], np.dtype[np.int64]]
    """Counts, (N, axes)."""
    saturated: np.ndarray[tuple[int, ...], np.dtype[np.bool_]]
    """True where at least one axis is at the end of its range, (N)."""


def measure(
    true: Array, when: Instants, part: Triad, rng: Rng, force: Array | None = None, bandwidth: float = inf
) -> Array:
    """Return the samples (N, 3) that a triad measures of `true` (fine instants, 3), before quantisation.

    `force` is the specific force at the fine instants, for gyroscopes that are sensitive to it, m/s^2. `bandwidth` is
    that of the device's own low pass, Hz, if it is below the part's."""
    measured = errors(true, when, part, rng, force)
    return sample(low_pass(measured, when.rate, min(part.bandwidth, bandwidth)), when)


def measure_imu(true: Kinematics, when: Instants, part: Imu, rng: Rng, bandwidth: float) -> tuple[Array, Array]:
    """Return the specific force, m/s^2, and the angular rate, rad/s, that an IMU measures, (N, 3) each."""
    acc = measure(true.force, when, part.acc, rng, bandwidth=bandwidth)
    return acc, measure(true.rate, when, part.gyro, rng, true.force, bandwidth)


def to_counts(measured: Array, part: Triad, count: float) -> CountReading:
    """Return the counts of measured values, limited to the bits of the part."""
    limit = 2 ** (part.bits - 1)
    counts = np.rint(measured / count)
    clipped = np.clip(counts, -limit, limit - 1)
    return CountReading(clipped.astype(np.int64), np.any(np.abs(counts) >= limit - 1, axis=1))


def errors(true: Array, when: Instants, part: Triad, rng: Rng, force: Array | None = None) -> Array:
    """Return `true` with scale error, misalignment, bias, its variation and white noise, before filter and clipping."""
    mixing = np.eye(3) + np.diag(part.scale * rng.standard_normal(3))
    mixing += part.cross * rng.standard_normal((3, 3)) * (1.0 - np.eye(3))
    signal = true @ mixing.T
    signal += np.clip(part.bias * rng.standard_normal(3), -part.bias_limit, part.bias_limit)
    signal += part.wander * wander(when.fine, part.memory, 3, rng)
    if force is not None and part.g_effect:
        signal += part.g_effect * force * rng.choice([-1.0, 1.0], 3)
    # White noise of density d has sigma d sqrt(rate / 2) when it fills the band up to half of the fine rate.
    signal += part.density * sqrt(0.5 * when.rate) * rng.standard_normal(true.shape)
    return np.asarray(signal)


def low_pass(signal: Array, rate: float, bandwidth: float) -> Array:
    """Filter with a causal second-order Butterworth low pass; the delay is sqrt(2) / (2 pi f)."""
    if bandwidth >= 0.45 * rate:
        return signal
    w = 2.0 * pi * bandwidth
    t = np.arange(ceil(8.0 * sqrt(2.0) / w * rate)) / rate
    response = np.exp(-w * t / sqrt(2.0)) * np.sin(w * t / sqrt(2.0))
    response /= response.sum()
    return np.stack([np.convolve(axis, response)[: len(axis)] for axis in signal.T], axis=1)


def sample(signal: Array, when: Instants) -> Array:
    """Return the values at the sampling instants."""
    return signal[when.before :: when.every]


def wander(t: Array, memory: float, axes: int, rng: Rng) -> Array:
    """Return a Gauss-Markov process of unit sigma and correlation time `memory` s that is 0 at the start, (N, axes).

    It is computed ten times per `memory` and interpolated smoothly, because a temperature does not change fast."""
    nodes = np.arange(float(t[0]), float(t[-1]) + 0.2 * memory, 0.1 * memory)
    keep = exp(-0.1)
    kicks = sqrt(1.0 - keep * keep) * rng.standard_normal((len(nodes), axes))
    path = np.zeros((len(nodes), axes))
    for k in range(1, len(nodes)):
        path[k] = keep * path[k - 1] + kicks[k]
    at = (t - nodes[0]) / (0.1 * memory)
    k = np.minimum(at.astype(np.int64), len(nodes) - 2)
    s = (at - k)[:, None]
    return np.asarray(path[k] + (path[k + 1] - path[k]) * s * s * (3.0 - 2.0 * s))


def read_cells(
    true: Array, when: Array, part: CellPart, count: float, rng: Rng, full: int = 4095, lift: Array | None = None
) -> CountReading:
    """Return the counts of an insole's cells for their true loads `true` (N, cells), N, at times `when` (N), s.

    `lift` (N) is the specific force along the sole's upward normal, m/s^2, for parts with `hang`."""
    cells = true.shape[1]
    gain = 1.0 + part.gain * np.clip(rng.standard_normal(cells), -3.0, 3.0)
    preload = part.preload * np.asarray(rng.uniform(0.0, 2.0, cells))
    lagged = true.copy()
    interval = float(when[1] - when[0]) if len(when) > 1 else 1.0
    if part.hang or part.rub:
        lagged += _contact(true, interval, part, preload, lift, rng)
        true = lagged.copy()
    follow = 1.0 - exp(-interval / part.lag)
    for k in range(1, len(lagged)):
        lagged[k] = lagged[k - 1] + follow * (true[k] - lagged[k - 1])
    # In place, because the loads of many cells on a long walk need much memory.
    lagged *= gain
    lagged += preload
    lagged += part.noise * rng.standard_normal(true.shape)
    lagged /= count
    counts = np.rint(lagged, out=lagged)
    saturated = np.any(counts >= full, axis=1)
    return CountReading(np.clip(counts, 0, full, out=counts).astype(np.int64), saturated)


def _contact(true: Array, interval: float, part: CellPart, preload: Array, lift: Array | None, rng: Rng) -> Array:
    """Return the load that the foot in the air adds to the preload of each cell, N, (N, cells); 0 while it stands."""
    keep = exp(-interval / part.rub_memory)
    change = part.rub * sqrt(1.0 - keep * keep) * rng.standard_normal(true.shape)
    for k in range(1, len(change)):
        change[k] += keep * change[k - 1]
    if lift is not None:
        change += part.hang * np.outer(1.0 - lift / GRAVITY, preload)
    np.maximum(change, -preload, out=change)
    change[true.any(axis=1)] = 0.0
    return change


def air_pressure(height: Array) -> Array:
    """Return the air pressure, Pa, at a height in m, by the international standard atmosphere (ISO 2533)."""
    return np.asarray(101325.0 * (1.0 - 2.25577e-5 * height) ** 5.25588)


def read_barometer(height: Array, t: Array, part: BarometerPart, rng: Rng) -> Array:
    """Return the pressures, Pa, that a barometer reports at heights (N), m, and times (N), s."""
    pressure = air_pressure(height) + part.offset * rng.standard_normal()
    pressure += part.wander * wander(t, part.memory, 1, rng)[:, 0]
    return np.asarray(pressure + part.noise * rng.standard_normal(len(t)))


def read_attitudes(true: Array, t: Array, part: AttitudePart, north: float, rng: Rng) -> Array:
    """Return the attitudes (N, 4), sensor to the device's world, that a device reports for `true` (N, 4) at times `t`.

    The device's world is the walk's world, turned about the vertical by `north` rad and by the part's errors: a
    Gauss-Markov process about each axis with the same sigma at the start as later."""
    initial = np.exp(-(t - t[0]) / part.memory)[:, None] * rng.standard_normal(3)
    turned = (initial + wander(t, part.memory, 3, rng)) * (part.tilt, part.tilt, part.heading)
    angle = np.linalg.norm(turned, axis=1, keepdims=True)
    axis = 0.5 * np.sinc(angle / (2.0 * pi)) * turned  # sin(angle / 2) / angle
    about = np.array([[cos(0.5 * north), 0.0, 0.0, -sin(0.5 * north)]])
    return multiply_quaternions(multiply_quaternions(about, np.concatenate((np.cos(0.5 * angle), axis), axis=1)), true)


def samples_of(
    site: Site,
    t: Array,
    acc: NDArray[Any] | None,
    gyro: NDArray[Any] | None,
    pressure: NDArray[Any] | None,
    quat: NDArray[Any] | None = None,
    saturated: NDArray[np.bool_] | None = None,
) -> list[Sample]:
    """Return the samples at times `t`, s, with the rows of the measured values."""
    vectors = [repeat(None) if one is None else map(tuple, one.tolist()) for one in (acc, gyro, pressure, quat)]
    full = repeat(False) if saturated is None else saturated.tolist()
    return [
        Sample(when, site, a, g, p, q, saturated=limit)
        for when, a, g, p, q, limit in zip(t.tolist(), *vectors, full, strict=False)
    ]
