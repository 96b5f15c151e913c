"""Finds the rests of a sensor in a hand, and the ways from one rest to the next.

A rest is a span in which all windows of half a second are still. Tedaldi, Pretto and Menegatti (2014, "A robust and
easy to implement method for IMU calibration without external equipments", ICRA) find rests by the variance of the
accelerometer alone, with a threshold from a first rest of 50 s. Here a person need not start with any rest: the limits
are those of a hand that holds something still, and the gyroscope is asked too, because its turn is what spoils a rest.
The bias of a gyroscope, which may be 20 degrees/s, is not a turn: it is the median rate of the still windows."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from attrs import evolve, frozen
from numpy.typing import NDArray

from ....calibration import CalibrationError
from ....types import Foot, Sample

Floats = NDArray[np.float64]

WINDOW = 0.5
"""Length of a window, s: several periods of the tremor of a hand, 8 to 12 Hz."""
SHORTEST_PAUSE = 1.0
"""Shortest rest, s, counted between the middles of its first and last window."""
STILL_ACC, STILL_GYRO = 0.5, 0.05
"""Largest standard deviation in a still window, m/s^2 and rad/s, each over all axes (chosen by hand).

A tremor of 0.5 m/s^2 at 8 Hz is less than 0.01 m/s^2 in the mean over three seconds. A hand that turns a sensor shows
ten times as much of both."""
STILL_RATE = 0.06
"""Largest mean rate beyond the bias in a still window, rad/s: 3.4 degrees/s."""
LONGEST_GAP = 3.5
"""Longest time between two samples on a way, in usual intervals: up to two lost samples in a row are interpolated."""
LEAST_CLIPPED, CLIPPED_RATE, SAME = 4, 2.0, 1e-6
"""Number of equal readings in a row, least rate, rad/s, and relative difference, that show the end of a range."""


@frozen(eq=False)
class Recorded:
    """The samples of one sensor."""

    t: Floats
    """Times, s, (N)."""
    acc: Floats
    """Specific force, m/s^2, (N, 3)."""
    gyro: Floats
    """Angular rate, rad/s, (N, 3)."""
    at_end: NDArray[np.bool_]
    """True where a sensor was at the end of its range, (N)."""

    def rows(self, rows: slice | NDArray[np.bool_]) -> Recorded:
        """Return some of the samples."""
        return Recorded(self.t[rows], self.acc[rows], self.gyro[rows], self.at_end[rows])

    @property
    def interval(self) -> float:
        """Usual time between two samples, s."""
        return float(np.median(np.diff(self.t)))


@frozen(eq=False)
class Pause:
    """One rest of a sensor."""

    start: float
    """Start of the rest, s."""
    end: float
    """End of the rest, s."""
    acc: Floats
    """Mean specific force, m/s^2, (3)."""
    acc_sigma: float
    """Standard deviation of each axis of `acc` by the scatter of the samples, m/s^2."""
    rate: Floats
    """Mean angular rate without the creep that gravity shows, rad/s, (3)."""
    creep: float
    """Mean angular rate across the vertical by gravity, rad/s."""
    level_sigma: float
    """Standard deviation of the components of `rate` across the vertical as a bias, rad/s."""
    upright_sigma: float
    """Standard deviation of the component of `rate` along the vertical as a bias, rad/s: no creep is seen there."""
    noise: float
    """Variance of one reading of the rate, mean of the axes, (rad/s)^2."""

    @property
    def middle(self) -> float:
        """Middle of the rest, s."""
        return 0.5 * (self.start + self.end)


@frozen(eq=False)
class WayBetween:
    """The samples from the middle of one rest to that of the next."""

    number: int
    """Index of the rest at which it starts."""
    t: Floats
    """Times, s, (N); the first and the last are the middles of the rests."""
    gyro: Floats
    """Angular rate, rad/s, (N, 3)."""
    angle: float
    """Angle that the sensor turned through, whatever the axis, rad."""
    density: float
    """Density of the white noise of the rate at the rests, rad/s/sqrt(Hz)."""
    spoilt: str = ""
    """Words for what makes the way useless; "" for a usable one."""


def recorded_of(samples: Sequence[Sample], foot: Foot) -> Recorded:
    """Return the samples of a foot's sensor with finite values; raise CalibrationError for fewer than two seconds."""
    rows = [
        (one.t, *one.acc, *one.gyro, one.saturated)
        for one in samples
        if one.site.foot is foot and one.acc is not None and one.gyro is not None
    ]
    table = np.array(rows, dtype=np.float64).reshape(-1, 8)
    table = table[np.isfinite(table).all(axis=1)]
    table = table[np.diff(np.maximum.accumulate(table[:, 0]), prepend=-np.inf) > 0.0]
    t, acc, gyro = table[:, 0], table[:, 1:4], table[:, 4:7]
    if len(t) < 8 or t[-1] - t[0] < 2.0:
        raise CalibrationError(f"the {foot} foot has too few samples of accelerometer and gyroscope")
    at_end = table[:, 7] > 0.0
    for axis in (*gyro.T, *-gyro.T):
        if axis.max() >= CLIPPED_RATE:
            for first, end in _runs(axis >= axis.max() * (1.0 - SAME)):
                at_end[first:end] |= end - first >= LEAST_CLIPPED
    return Recorded(t, acc, gyro, at_end)


def _runs(flags: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """Return the first index of every run of true flags, and the index after its last."""
    edges = np.flatnonzero(np.diff(flags.astype(np.int8), prepend=0, append=0)).tolist()
    return list(zip(edges[::2], edges[1::2], strict=True))


def find_pauses(recorded: Recorded) -> list[Pause]:
    """Return the rests in the order of time."""
    count = max(4, round(WINDOW / recorded.interval))
    acc, acc_variance = _windows(recorded.acc, count)
    rate, rate_variance = _windows(recorded.gyro, count)
    even = recorded.t[count - 1 :] - recorded.t[: len(rate)] < 1.5 * count * recorded.interval
    still = even & (acc_variance < STILL_ACC**2) & (rate_variance < STILL_GYRO**2)
    if not still.any():
        return []
    for _ in range(2):  # the median of what is still, then of what does not turn either
        bias = np.median(rate[still], axis=0)
        slow = still & (np.linalg.norm(rate - bias, axis=1) < STILL_RATE)
        still = slow if slow.any() else still
    steps = np.abs(np.diff(recorded.gyro, axis=0))
    step = float(np.min(steps, where=steps > 0.0, initial=steps.max()))
    middles = recorded.t[count // 2 : count // 2 + len(slow)]
    pauses = [
        _pause(recorded.rows(slice(first + count // 2, end + count // 2)), step)
        for first, end in _runs(slow)
        if middles[end - 1] - middles[first] >= SHORTEST_PAUSE
    ]
    # a hand that creeps in one rest does so in others, and seldom about a level axis alone
    usual = 0.5 * float(np.mean([rest.creep**2 for rest in pauses] or [0.0]))
    return [evolve(rest, upright_sigma=(0.5 * (rest.upright_sigma**2 + usual)) ** 0.5) for rest in pauses]


def _windows(values: Floats, count: int) -> tuple[Floats, Floats]:
    """Return mean and variance, summed over the axes, of every window of `count` rows."""
    middle = values.mean(axis=0)
    powers = np.stack((values - middle, (values - middle) ** 2))
    sums = np.cumsum(np.pad(powers, ((0, 0), (1, 0), (0, 0))), axis=1)
    mean, square = (sums[:, count:] - sums[:, :-count]) / count
    return mean + middle, np.sum(square - mean**2, axis=1)


def _pause(rest: Recorded, step: float) -> Pause:
    """Return a rest; its creep about the horizontal is seen by gravity, and that about the vertical is like it.

    Every reading is turned into the sensor frame in the middle of the rest. An even creep cancels, so the turn is that
    of the rates beyond their mean, which no bias changes. Rates that never change may be wrong by half a `step`."""
    t, half = rest.t, len(rest.t) // 2
    duration, rate = float(t[-1] - t[0]), rest.gyro.mean(axis=0)
    uneven = 0.5 * np.diff(t)[:, None] * (rest.gyro[1:] + rest.gyro[:-1] - 2.0 * rate)
    turned = np.concatenate((np.zeros((1, 3)), np.cumsum(uneven, axis=0)))
    acc = rest.acc + np.cross(turned - _interpolate(0.5 * (t[0] + t[-1]), t, turned), rest.acc)
    mean, sigma = acc.mean(axis=0), _block_variance(acc) ** 0.5
    size = float(np.linalg.norm(mean))
    change = acc[half:].mean(axis=0) - acc[:half].mean(axis=0)
    creep = -np.cross(mean, change) / (size * size) / (0.5 * duration)
    slow = float(np.linalg.norm(creep))
    variance = _block_variance(rest.gyro) or step * step / 12.0
    # the mean of a half has twice the variance of the whole mean
    level_variance = variance + (4.0 * sigma / (size * duration)) ** 2
    upright_variance = variance + 0.5 * slow * slow
    noise = float(np.mean(np.var(np.diff(rest.gyro, axis=0), axis=0))) / 2.0
    return Pause(
        float(t[0]), float(t[-1]), mean, sigma, rate - creep, slow, level_variance**0.5, upright_variance**0.5, noise
    )


def _interpolate(t: float | Floats, times: Floats, values: Floats) -> Floats:
    """Return vectors at other times."""
    return np.stack([np.interp(t, times, axis) for axis in values.T], axis=-1)


def _block_variance(values: Floats) -> float:
    """Return the variance of the mean of one axis by the scatter of its eight blocks, without their common slope."""
    blocks = np.array([block.mean(axis=0) for block in np.array_split(values, 8)])
    return float(np.mean(np.diff(blocks, axis=0) ** 2)) / 2.0 / 8.0


def find_ways(recorded: Recorded, pauses: Sequence[Pause]) -> list[WayBetween]:
    """Return the way from each rest to the next, also those that are spoilt."""
    density = float(np.sqrt(np.median([rest.noise for rest in pauses]) * recorded.interval))
    ways = []
    for number, (one, other) in enumerate(zip(pauses, pauses[1:], strict=False)):
        inside = (recorded.t > one.middle) & (recorded.t < other.middle)
        t = np.concatenate(([one.middle], recorded.t[inside], [other.middle]))
        gyro = _interpolate(t, recorded.t, recorded.gyro)
        turning = np.linalg.norm(gyro - 0.5 * (one.rate + other.rate), axis=1)
        turning[(t <= one.end) | (t >= other.start)] = 0.0
        spoilt = ""
        if np.diff(t).max() > LONGEST_GAP * recorded.interval:
            spoilt = "samples are lost"
        elif recorded.at_end[inside].any():
            spoilt = "a sensor was at the end of its range: turn more slowly, or choose a larger range"
        ways.append(WayBetween(number, t, gyro, float(np.trapezoid(turning, t)), density, spoilt))
    return ways
