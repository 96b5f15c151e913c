"""Sensor models, from the true signal to the counts of a chip: errors, low pass, saturation, quantisation.

Signals are computed at fine instants, several per sample, and pass the chip's low pass before they are sampled.
Frequencies above half of the sampling rate are therefore attenuated, or alias, as in the real chip."""

from __future__ import annotations

from itertools import pairwise, repeat
from math import ceil, cos, exp, inf, pi, sin, sqrt
from typing import Any

import numpy as np
from attrs import frozen
from numpy.typing import NDArray

from ...types import Sample, Site
from ...types.vector import GRAVITY
from ..wearers.curves import Array, Rng
from ..wearers.motion import Kinematics
from ..wearers.turning import from_rotation_vectors, multiply_quaternions
from .air import STILL_AIR, Air
from .insoles import FULL_COUNT
from .parts import AttitudeErrors, BarometerErrors, CellErrors, Imu, TriadErrors

LEAD_IN_TIME = 0.12
"""Time before the first sample in which a filter reaches its steady state, s."""
MIN_FINE_RATE = 800.0
"""Least rate at which a signal is computed before it is filtered, Hz."""


@frozen(eq=False)
class Sampling:
    """The sampling instants of a device, and the finer instants at which its signals are computed."""

    times: Array
    """True times of the samples, s, (N)."""
    fine_times: Array
    """True times of the fine instants, s."""
    oversampling: int
    """Number of fine instants per sample."""
    lead_in: int
    """Number of fine instants before the first sample, in LEAD_IN_TIME s."""

    @property
    def rate(self) -> float:
        """Rate of the fine instants, Hz."""
        return 1.0 / float(self.fine_times[1] - self.fine_times[0])


def instants(first: float, interval: float, count: int) -> Sampling:
    """Return the instants of `count` samples from `first` s on, `interval` s apart."""
    oversampling = max(1, ceil(MIN_FINE_RATE * interval))
    step = interval / oversampling
    lead_in = ceil(LEAD_IN_TIME / step)
    fine_times = first + step * np.arange(-lead_in, (count - 1) * oversampling + 1, dtype=np.float64)
    return Sampling(first + interval * np.arange(count, dtype=np.float64), fine_times, oversampling, lead_in)


@frozen(eq=False)
class CountReading:
    """The counts of a chip, and where they are saturated."""

    counts: np.ndarray[tuple[int, ...], np.dtype[np.int64]]
    """Counts, (N, axes)."""
    saturated: np.ndarray[tuple[int, ...], np.dtype[np.bool_]]
    """True where at least one axis is at the end of its range, (N)."""


def measure(
    true: Array, sampling: Sampling, chip: TriadErrors, rng: Rng, force: Array | None = None, bandwidth: float = inf
) -> Array:
    """Return the samples (N, 3) of a three-axis sensor, not quantised, for the true values (fine instants, 3).

    `force` is the specific force at the fine instants, m/s^2, for gyroscopes that are sensitive to it. The low pass
    has the bandwidth of the chip or `bandwidth`, the device's own, Hz, whichever is lower."""
    measured = add_errors(true, sampling, chip, rng, force)
    return take_samples(low_pass(measured, sampling.rate, min(chip.bandwidth, bandwidth)), sampling)


def measure_imu(true: Kinematics, sampling: Sampling, chip: Imu, rng: Rng, bandwidth: float) -> tuple[Array, Array]:
    """Return the specific force, m/s^2, and the angular rate, rad/s, that an IMU measures, (N, 3) each."""
    acc = measure(true.force, sampling, chip.acc, rng, bandwidth=bandwidth)
    return acc, measure(true.rate, sampling, chip.gyro, rng, true.force, bandwidth)


def to_counts(measured: Array, chip: TriadErrors, count: float) -> CountReading:
    """Return the counts of measured values, limited to the bits of the chip; `count` is the value of one count."""
    limit = 2 ** (chip.bits - 1)
    counts = np.rint(measured / count)
    clipped = np.clip(counts, -limit, limit - 1)
    return CountReading(clipped.astype(np.int64), np.any(np.abs(counts) >= limit - 1, axis=1))


def add_errors(true: Array, sampling: Sampling, chip: TriadErrors, rng: Rng, force: Array | None = None) -> Array:
    """Return the true values with scale error, misalignment, bias, bias drift and white noise, not yet filtered."""
    specimen = rng if chip.specimen is None else specimen_rng(chip.specimen)
    signal = true @ mixing(chip, specimen).T
    bias = rng.standard_normal(3)
    if chip.specimen is not None and chip.bias_change < 1.0:
        own = np.random.default_rng([chip.specimen, 25]).standard_normal(3)
        bias = chip.bias_change * bias + sqrt(1.0 - chip.bias_change**2) * own
    signal += np.clip(chip.bias * bias, -chip.bias_limit, chip.bias_limit)
    signal += chip.drift * random_drift(sampling.fine_times, chip.correlation_time, 3, rng)
    if force is not None and chip.g_effect:
        signal += chip.g_effect * force * specimen.choice([-1.0, 1.0], 3)
    # White noise of density d has sigma d sqrt(rate / 2) when it fills the band up to half of the fine rate.
    signal += chip.density * sqrt(0.5 * sampling.rate) * rng.standard_normal(true.shape)
    return np.asarray(signal)


def specimen_rng(number: int) -> Rng:
    """Return the random numbers from which the scale, axes and signs of `g_effect` of a specimen are drawn."""
    return np.random.default_rng([number, 24])


def mixing(chip: TriadErrors, specimen: Rng) -> Array:
    """Return the matrix from true values to those with scale error and misalignment, (3, 3)."""
    scale, cross = chip.scale * specimen.standard_normal(3), chip.cross * specimen.standard_normal((3, 3))
    return np.asarray(np.eye(3) + np.diag(scale) + cross * (1.0 - np.eye(3)))


def low_pass(signal: Array, rate: float, bandwidth: float) -> Array:
    """Return the columns filtered by a causal second-order Butterworth low pass, with a delay of sqrt(2) / (2 pi f).

    f is `bandwidth`, Hz; a bandwidth of 0.45 `rate`, Hz, or more leaves the signal as it is."""
    if bandwidth >= 0.45 * rate:
        return signal
    w = 2.0 * pi * bandwidth
    t = np.arange(ceil(8.0 * sqrt(2.0) / w * rate)) / rate
    response = np.exp(-w * t / sqrt(2.0)) * np.sin(w * t / sqrt(2.0))
    response /= response.sum()
    return np.stack([np.convolve(axis, response)[: len(axis)] for axis in signal.T], axis=1)


def take_samples(signal: Array, sampling: Sampling) -> Array:
    """Return the rows of a signal that are at the sampling instants."""
    return signal[sampling.lead_in :: sampling.oversampling]


def random_drift(t: Array, correlation_time: float, axes: int, rng: Rng) -> Array:
    """Return a Gauss-Markov process that starts at 0 and tends to a standard deviation of 1, (N, axes).

    It is computed ten times per `correlation_time`, s, and interpolated smoothly: a temperature changes slowly."""
    nodes = np.arange(float(t[0]), float(t[-1]) + 0.2 * correlation_time, 0.1 * correlation_time)
    persistence = exp(-0.1)
    kicks = sqrt(1.0 - persistence * persistence) * rng.standard_normal((len(nodes), axes))
    path = np.zeros((len(nodes), axes))
    for k in range(1, len(nodes)):
        path[k] = persistence * path[k - 1] + kicks[k]
    at = (t - nodes[0]) / (0.1 * correlation_time)
    k = np.minimum(at.astype(np.int64), len(nodes) - 2)
    s = (at - k)[:, None]
    return np.asarray(path[k] + (path[k + 1] - path[k]) * s * s * (3.0 - 2.0 * s))


def read_cells(
    true: Array, t: Array, chip: CellErrors, count: float, rng: Rng, upward_force: Array | None = None
) -> CountReading:
    """Return the counts of an insole's cells for their true loads, in newtons, (N, cells), at times `t`, s, (N).

    `count` is the load of one count, in newtons. `upward_force` (N) is the specific
    force along the sole's upward normal, m/s^2, for parts with `relief_per_g`."""
    cells = true.shape[1]
    gain = 1.0 + chip.gain * np.clip(rng.standard_normal(cells), -3.0, 3.0)
    preload = chip.preload * np.asarray(rng.uniform(0.0, 2.0, cells))
    lagged = true.copy()
    interval = float(t[1] - t[0]) if len(t) > 1 else 1.0
    if chip.relief_per_g or chip.contact_noise:
        lagged += _contact_loads(true, interval, chip, preload, upward_force, rng)
        true = lagged.copy()
    follow = 1.0 - exp(-interval / chip.lag)
    for load, before, after in zip(true[1:], lagged[:-1], lagged[1:], strict=True):
        after[:] = before + follow * (load - before)
    # In place, because the loads of many cells on a long walk need much memory.
    lagged *= gain
    lagged += preload
    lagged += chip.noise * rng.standard_normal(true.shape)
    lagged /= count
    counts = np.rint(lagged, out=lagged)
    saturated = np.any(counts >= FULL_COUNT, axis=1)
    return CountReading(np.clip(counts, 0, FULL_COUNT, out=counts).astype(np.int64), saturated)


def _contact_loads(
    true: Array, interval: float, chip: CellErrors, preload: Array, upward_force: Array | None, rng: Rng
) -> Array:
    """Return the load that a foot in swing adds to the preload of each cell, in newtons, (N, cells); 0 in stance."""
    persistence = exp(-interval / chip.contact_correlation_time)
    change = chip.contact_noise * sqrt(1.0 - persistence * persistence) * rng.standard_normal(true.shape)
    for before, after in pairwise(change):
        after += persistence * before
    if upward_force is not None:
        change += chip.relief_per_g * np.outer(1.0 - upward_force / GRAVITY, preload)
    np.maximum(change, -preload, out=change)
    change[true.any(axis=1)] = 0.0
    return change


def air_pressure(height: Array) -> Array:
    """Return the air pressure, Pa, at a height in m, by the international standard atmosphere (ISO 2533)."""
    return np.asarray(101325.0 * (1.0 - 2.25577e-5 * height) ** 5.25588)


def read_barometer(height: Array, t: Array, chip: BarometerErrors, rng: Rng, air: Air = STILL_AIR) -> Array:
    """Return the pressures, Pa, that a barometer in this air reports at heights (N), m, and times (N), s."""
    pressure = air_pressure(height) + chip.offset * rng.standard_normal() + air.at(t)
    pressure += chip.drift * random_drift(t, chip.correlation_time, 1, rng)[:, 0]
    return np.asarray(pressure + chip.noise * rng.standard_normal(len(t)))


def read_attitudes(true: Array, t: Array, chip: AttitudeErrors, north: float, rng: Rng) -> Array:
    """Return the attitudes (N, 4), sensor to device's world, that a device reports for `true` (N, 4) at times `t`, s.

    The device's world is the walk's world turned about the vertical by `north` rad. Errors are added: about each axis a
    Gauss-Markov process whose standard deviation is the same from the start on, and the steady tilt."""
    initial = np.exp(-(t - t[0]) / chip.correlation_time)[:, None] * rng.standard_normal(3)
    turned = (initial + random_drift(t, chip.correlation_time, 3, rng)) * (chip.tilt, chip.tilt, chip.heading)
    if chip.steady_tilt:
        turned += chip.steady_tilt * np.append(rng.standard_normal(2), 0.0)
    # Coordinates turn by -north when the frame turns by north.
    about = np.array([[cos(0.5 * north), 0.0, 0.0, -sin(0.5 * north)]])
    return multiply_quaternions(multiply_quaternions(about, from_rotation_vectors(turned)), true)


def samples_of(
    site: Site,
    t: Array,
    acc: NDArray[Any] | None,
    gyro: NDArray[Any] | None,
    pressure: NDArray[Any] | None,
    quat: NDArray[Any] | None = None,
    saturated: NDArray[np.bool_] | None = None,
    mag: NDArray[Any] | None = None,
) -> list[Sample]:
    """Return the samples at times `t`, s, with the rows of the measured values."""
    # a zip of columns makes the tuples of the rows without a list of each
    vectors = [
        repeat(None) if one is None else zip(*one.T.tolist(), strict=True) for one in (acc, gyro, pressure, quat, mag)
    ]
    flags = repeat(False) if saturated is None else saturated.tolist()
    return [
        Sample(time, site, a, g, p, q, m, saturated=flag)
        for time, a, g, p, q, m, flag in zip(t.tolist(), *vectors, flags, strict=False)
    ]
