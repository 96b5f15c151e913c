"""Covariances of the bias filter from a sensor at rest, section V-A of Bebek et al. 2010.

"One-hour-long motionless sensor data were collected to estimate the covariances" Sigma_w and Sigma_v, "so that w and v
would approximately be white". The Allan variance of a recording at rest separates the two (IEEE Std 952). Noise of the
density d contributes d^2 / (2 tau) to the variance of means over tau, and a bias that walks by K in the root of a
second contributes K^2 tau / 3. What flickers in between, the bias instability, contributes a constant. The filter has
no state for it, so it counts as a walk that is as large at the longest tau.

Minutes show the density; the walk needs the hour. The longest tau is a ninth of the recording, where the Allan variance
of nine means is still known to a third."""

from __future__ import annotations

from collections.abc import Iterable
from math import sqrt

import numpy as np
from numpy.typing import NDArray

from ...calibration import Calibration, CalibrationError, RestNoise
from ...types import Foot, Sample
from ...types.attrs import frozen
from ...types.vector import GRAVITY

Values = NDArray[np.float64]

SHORTEST_REST = 120.0
"""Shortest recording, s: its longest tau is 13 s, where the noise of a chip no longer hides its walk (assumed)."""
MEANS_AT_LONGEST = 9
"""Number of means over the longest tau."""
LARGEST_ACC_MOVE, LARGEST_RATE = 0.2, 0.1
"""Largest change of the specific force over the means of single seconds, m/s^2, and largest mean angular rate apart
from the bias, rad/s, of a sensor that lies still (assumed: a tilt of one degree, and a turn by hand)."""
LARGEST_GRAVITY_ERROR, LARGEST_RATE_BIAS = 1.0, 0.5
"""Largest error of gravity, m/s^2, and largest bias of a gyroscope, rad/s, of a sensor that lies still.

Recorded sensors at rest read 9.5 to 10.5 m/s^2. The gyroscope of the SensorTag CC2541 may have 20 degrees/s by its data
sheet."""
LONGEST_GAP = 3.0
"""Longest time between two samples that is no gap, in usual intervals."""


@frozen
class RestFit:
    """The noise of the sensor on one foot, with the Allan deviation from which it was fitted."""

    foot: Foot
    noise: RestNoise
    duration: float
    """Duration of the recording without a gap, s."""
    acc_instability: float
    """Least Allan deviation of the accelerometer, m/s^2."""
    gyro_instability: float
    """Least Allan deviation of the gyroscope, rad/s."""


def rest_noise(recorded: Iterable[Sample], foot: Foot | None = None) -> tuple[RestFit, ...]:
    """Return the noise of every foot's sensor, or of that of `foot`, from samples recorded at rest.

    Raises CalibrationError when there are no inertial samples, when they last less than `SHORTEST_REST`, or when the
    sensor moved."""
    samples: dict[Foot, list[Sample]] = {one: [] for one in Foot}
    for sample in recorded:
        if sample.site.foot is not None and sample.acc is not None and sample.gyro is not None:
            samples[sample.site.foot].append(sample)
    feet = [one for one in Foot if samples[one] and foot in (None, one)]
    if not feet:
        raise CalibrationError("no foot's accelerations and angular rates in the recording")
    return tuple([_fit_foot(one, samples[one]) for one in feet])


def rest_calibration(fits: Iterable[RestFit]) -> Calibration:
    """Return the calibration that holds the noise of these sensors."""
    return Calibration(rest={fit.foot: fit.noise for fit in fits})


def _fit_foot(foot: Foot, samples: list[Sample]) -> RestFit:
    t = np.array([sample.t for sample in samples])
    acc = np.array([sample.acc for sample in samples])
    gyro = np.array([sample.gyro for sample in samples])
    interval = float(np.median(np.diff(t))) if len(t) > 1 else 0.0
    if interval <= 0.0:
        raise CalibrationError(f"the {foot.value} foot has too few samples")
    piece = _longest_piece(t, LONGEST_GAP * interval)
    t, acc, gyro = t[piece], acc[piece], gyro[piece]
    duration = float(t[-1] - t[0])
    if duration < SHORTEST_REST:
        raise CalibrationError(
            f"the {foot.value} foot has {duration:.0f} s without a gap; {SHORTEST_REST:.0f} s of rest are the least, "
            "an hour is better"
        )
    _check_rest(foot, t, acc, gyro, max(1, round(1.0 / interval)))
    tau, acc_variance = allan_variance(acc, interval)
    _, gyro_variance = allan_variance(gyro, interval)
    noise = RestNoise(*fit_noise(tau, acc_variance), *fit_noise(tau, gyro_variance), 1.0 / interval)
    return RestFit(foot, noise, duration, sqrt(float(acc_variance.min())), sqrt(float(gyro_variance.min())))


def _longest_piece(t: Values, longest: float) -> slice:
    breaks = [0, *(np.flatnonzero(np.diff(t) > longest) + 1).tolist(), len(t)]
    start, end = max(zip(breaks, breaks[1:], strict=False), key=lambda piece: piece[1] - piece[0])
    return slice(start, end)


def _check_rest(foot: Foot, t: Values, acc: Values, gyro: Values, count: int) -> None:
    """Raise CalibrationError if a mean over `count` samples, one second, shows a motion."""
    seconds = len(t) // count
    means, rates = (values[: seconds * count].reshape(seconds, count, 3).mean(axis=1) for values in (acc, gyro))
    moved = np.abs(means - np.median(means, axis=0)).max(axis=1)
    turned = np.abs(rates - np.median(rates, axis=0)).max(axis=1)
    gravity = float(np.linalg.norm(means.mean(axis=0)))
    if abs(gravity - GRAVITY) > LARGEST_GRAVITY_ERROR or np.abs(rates.mean(axis=0)).max() > LARGEST_RATE_BIAS:
        raise CalibrationError(
            f"the sensor of the {foot.value} foot reads {gravity:.1f} m/s^2 and turns by up to "
            f"{np.abs(rates.mean(axis=0)).max():.2g} rad/s on average: it must lie still, off the foot"
        )
    motion = np.flatnonzero((moved > LARGEST_ACC_MOVE) | (turned > LARGEST_RATE))
    if len(motion):
        at = float(t[motion[0] * count] - t[0])
        raise CalibrationError(
            f"the sensor of the {foot.value} foot moved {at:.0f} s after the start: it must lie still, off the foot"
        )


def allan_variance(values: Values, interval: float) -> tuple[Values, Values]:
    """Return averaging times tau, s, and the Allan variance of (N, 3) samples, averaged over the axes.

    Times double from one interval to a ninth of the recording; means overlap by all but a sample."""
    sums = np.concatenate((np.zeros((1, 3)), np.cumsum(values - values.mean(axis=0), axis=0)))
    counts, variances = [], []
    count = 1
    while count * MEANS_AT_LONGEST <= len(values):
        means = (sums[count:] - sums[:-count]) / count
        variances.append(float(0.5 * np.mean((means[count:] - means[:-count]) ** 2)))
        counts.append(count)
        count *= 2
    return interval * np.array(counts, dtype=np.float64), np.array(variances)


def fit_noise(tau: Values, variance: Values) -> tuple[float, float]:
    """Return the density, u/sqrt(Hz), and the walk, u/sqrt(s), that an Allan variance, u^2, shows at its two ends.

    The shortest tau shows the density. What its noise does not explain at the longest tau is a walk. CalibrationError
    is raised when the variance at the shortest tau is 0: the noise is below the sensor's resolution."""
    white, longest = float(variance[0] * tau[0]), float(tau[-1])
    if white <= 0.0:
        raise CalibrationError("a sensor at rest reads the same all the time: its noise is below its resolution")
    return sqrt(2.0 * white), sqrt(3.0 * max(float(variance[-1]) - white / longest, 0.0) / longest)
