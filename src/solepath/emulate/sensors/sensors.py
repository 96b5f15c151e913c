"""From what truly happens to what a part reports: errors, low pass, saturation, counts.

Signals are worked out at several instants per sample and pass the part's low pass before they are sampled, so that what
is too fast for the sample rate aliases or is rounded off as it is in the part.
"""

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
from ..wearers.turning import multiplied
from .parts import AttitudePart, BarometerPart, CellPart, Imu, Triad

INTERNAL_RATE = 800.0
"""Hz: instants per second at which a signal is worked out before it is filtered, at least."""


@frozen(eq=False)
class Instants:
    """When a device samples: `taken` (N) in true time, s, and `fine`, the finer instants that lead up to them.

    `every` fine instants make one sample, and `before` of them precede the first one for the filter to settle.
    """

    taken: Array
    fine: Array
    every: int
    before: int

    @property
    def rate(self) -> float:
        """Of the fine instants, Hz."""
        return 1.0 / float(self.fine[1] - self.fine[0])


def instants(first: float, interval: float, count: int) -> Instants:
    """`count` samples from `first` at `interval` s."""
    every = max(1, ceil(INTERNAL_RATE * interval))
    step = interval / every
    before = ceil(0.12 / step)
    fine = first + step * np.arange(-before, (count - 1) * every + 1, dtype=np.float64)
    return Instants(first + interval * np.arange(count, dtype=np.float64), fine, every, before)


@frozen(eq=False)
class CountReading:
    """`counts` (N, axes) as the part gives them, and where at least one axis was at its limit (N)."""

    counts: np.ndarray[tuple[int, ...], np.dtype[np.int64]]
    saturated: np.ndarray[tuple[int, ...], np.dtype[np.bool_]]


def measure(
    true: Array, when: Instants, part: Triad, rng: Rng, force: Array | None = None, bandwidth: float = inf
) -> Array:
    """What a triad measures of `true` (fine instants, 3) at the instants that are taken (N, 3), before it makes counts.

    `force` is the specific force at the same instants, for gyroscopes that feel it. `bandwidth` (Hz) is that of a
    device's own low pass, where it is below the part's.
    """
    measured = errors(true, when, part, rng, force)
    return sample(low_pass(measured, when.rate, min(part.bandwidth, bandwidth)), when)


def measure_imu(true: Kinematics, when: Instants, part: Imu, rng: Rng, bandwidth: float) -> tuple[Array, Array]:
    """What accelerometer and gyroscope measure."""
    acc = measure(true.force, when, part.acc, rng, bandwidth=bandwidth)
    return acc, measure(true.rate, when, part.gyro, rng, true.force, bandwidth)


def to_counts(measured: Array, part: Triad, count: float) -> CountReading:
    """The counts of what a triad measured, as far as its bits go."""
    limit = 2 ** (part.bits - 1)
    counts = np.rint(measured / count)
    clipped = np.clip(counts, -limit, limit - 1)
    return CountReading(clipped.astype(np.int64), np.any(np.abs(counts) >= limit - 1, axis=1))


def errors(true: Array, when: Instants, part: Triad, rng: Rng, force: Array | None = None) -> Array:
    """Scale, misalignment, bias, its wander, and white noise added to `true`; nothing is filtered or clipped yet."""
    mixing = np.eye(3) + np.diag(part.scale * rng.standard_normal(3))
    mixing += part.cross * rng.standard_normal((3, 3)) * (1.0 - np.eye(3))
    signal = true @ mixing.T
    signal += np.clip(part.bias * rng.standard_normal(3), -part.bias_limit, part.bias_limit)
    signal += part.wander * wander(when.fine, part.memory, 3, rng)
    if force is not None and part.g_effect:
        signal += part.g_effect * force * rng.choice([-1.0, 1.0], 3)
    # White noise of density d has sigma d sqrt(rate / 2) when it fills the band up to half the fine rate.
    signal += part.density * sqrt(0.5 * when.rate) * rng.standard_normal(true.shape)
    return np.asarray(signal)


def low_pass(signal: Array, rate: float, bandwidth: float) -> Array:
    """A second-order Butterworth low pass as its impulse response; causal, so it delays by sqrt(2) / (2 pi f)."""
    if bandwidth >= 0.45 * rate:
        return signal
    w = 2.0 * pi * bandwidth
    t = np.arange(ceil(8.0 * sqrt(2.0) / w * rate)) / rate
    response = np.exp(-w * t / sqrt(2.0)) * np.sin(w * t / sqrt(2.0))
    response /= response.sum()
    return np.stack([np.convolve(axis, response)[: len(axis)] for axis in signal.T], axis=1)


def sample(signal: Array, when: Instants) -> Array:
    """The values at the instants when samples are taken."""
    return signal[when.before :: when.every]


def wander(t: Array, memory: float, axes: int, rng: Rng) -> Array:
    """A Gauss-Markov process of unit sigma and `memory` s that is 0 at the start, (N, axes).

    Worked out ten times in `memory` and joined smoothly: temperature has no fast part, white noise is another matter.
    """
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
    """What the cells of an insole report of their true loads `true` (N, cells), N, taken at `when` (N).

    `lift` (N): specific force along the sole's upward normal, m/s^2, for parts that feel how the shoe hangs.
    """
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
    # In place: the loads of many cells on a long walk are large enough once.
    lagged *= gain
    lagged += preload
    lagged += part.noise * rng.standard_normal(true.shape)
    lagged /= count
    counts = np.rint(lagged, out=lagged)
    saturated = np.any(counts >= full, axis=1)
    return CountReading(np.clip(counts, 0, full, out=counts).astype(np.int64), saturated)


def _contact(true: Array, interval: float, part: CellPart, preload: Array, lift: Array | None, rng: Rng) -> Array:
    """What the foot in the air adds to the preload of each cell, (N, cells); nothing while it stands."""
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
    """Pa at a height in m, by the international standard atmosphere (ISO 2533)."""
    return np.asarray(101325.0 * (1.0 - 2.25577e-5 * height) ** 5.25588)


def read_barometer(height: Array, t: Array, part: BarometerPart, rng: Rng) -> Array:
    """Pa that a barometer reports at heights (N) and instants (N)."""
    pressure = air_pressure(height) + part.offset * rng.standard_normal()
    pressure += part.wander * wander(t, part.memory, 1, rng)[:, 0]
    return np.asarray(pressure + part.noise * rng.standard_normal(len(t)))


def read_attitudes(true: Array, t: Array, part: AttitudePart, north: float, rng: Rng) -> Array:
    """What a device says of its attitudes `true` (N, 4) at instants `t`, (N, 4): sensor to its own world.

    That world is the walk's turned about the vertical by `north` rad and by the part's errors, a Gauss-Markov process
    about each axis that is as large at the start as later.
    """
    initial = np.exp(-(t - t[0]) / part.memory)[:, None] * rng.standard_normal(3)
    turned = (initial + wander(t, part.memory, 3, rng)) * (part.tilt, part.tilt, part.heading)
    angle = np.linalg.norm(turned, axis=1, keepdims=True)
    axis = 0.5 * np.sinc(angle / (2.0 * pi)) * turned  # sin(angle / 2) / angle
    about = np.array([[cos(0.5 * north), 0.0, 0.0, -sin(0.5 * north)]])
    return multiplied(multiplied(about, np.concatenate((np.cos(0.5 * angle), axis), axis=1)), true)


def samples_of(
    site: Site,
    t: Array,
    acc: NDArray[Any] | None,
    gyro: NDArray[Any] | None,
    pressure: NDArray[Any] | None,
    quat: NDArray[Any] | None = None,
    saturated: NDArray[np.bool_] | None = None,
) -> list[Sample]:
    """Samples taken at `t`, with the rows of what was measured."""
    vectors = [repeat(None) if one is None else map(tuple, one.tolist()) for one in (acc, gyro, pressure, quat)]
    full = repeat(False) if saturated is None else saturated.tolist()
    return [
        Sample(when, site, a, g, p, q, saturated=limit)
        for when, a, g, p, q, limit in zip(t.tolist(), *vectors, full, strict=False)
    ]
