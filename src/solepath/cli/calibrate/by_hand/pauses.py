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
    rows = [one for one in samples if one.site.foot is foot and one.acc is not None and one.gyro is not None]
    t = np.array([one.t for one in rows], dtype=np.float64)
    acc = np.array([one.acc for one in rows], dtype=np.float64).reshape(-1, 3)
    gyro = np.array([one.gyro for one in rows], dtype=np.float64).reshape(-1, 3)
    at_end = np.array([one.saturated for one in rows], dtype=np.bool_)
    good = np.isfinite(t) & np.isfinite(acc).all(axis=1) & np.isfinite(gyro).all(axis=1)
    if len(t):
        good &= np.concatenate(([True], t[1:] > np.maximum.accumulate(t)[:-1]))
    t, acc, gyro, at_end = t[good], acc[good], gyro[good], at_end[good]
    if len(t) < 8 or t[-1] - t[0] < 2.0:
        raise CalibrationError(f"the {foot.value} foot has too few samples of accelerometer and gyroscope")
    return Recorded(t, acc, gyro, at_end | _clipped(gyro))


def _clipped(gyro: Floats) -> NDArray[np.bool_]:
    """Return where a rate stays at the largest value of its axis, as at the end of a range."""
    clipped = np.zeros(len(gyro), dtype=np.bool_)
    for axis in (*gyro.T, *-gyro.T):
        if axis.max() < CLIPPED_RATE:
            continue
        for first, end in _runs(axis >= axis.max() * (1.0 - SAME)):
            clipped[first:end] |= end - first >= LEAST_CLIPPED
    return clipped


def _runs(flags: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """Return the first index of every run of true flags, and the index after its last."""
    edges = np.flatnonzero(np.diff(np.concatenate(([0], flags.astype(np.int8), [0])))).tolist()
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
    step = _smallest_step(recorded.gyro)
    middles = recorded.t[count // 2 : count // 2 + len(slow)]
    pauses = []
    for first, end in _runs(slow):
        if middles[end - 1] - middles[first] >= SHORTEST_PAUSE:
            rows = slice(first + count // 2, end + count // 2)
            pauses.append(_pause(recorded.t[rows], recorded.acc[rows], recorded.gyro[rows], step))
    # a hand that creeps in one rest does so in others, and seldom about a level axis alone
    usual = 0.5 * float(np.mean([rest.creep**2 for rest in pauses])) if pauses else 0.0
    return [evolve(rest, upright_sigma=(0.5 * (rest.upright_sigma**2 + usual)) ** 0.5) for rest in pauses]


def _windows(values: Floats, count: int) -> tuple[Floats, Floats]:
    """Return mean and variance, summed over the axes, of every window of `count` rows."""
    centred = values - values.mean(axis=0)
    sums = np.concatenate((np.zeros((1, 3)), np.cumsum(centred, axis=0)))
    squares = np.concatenate(([0.0], np.cumsum(np.sum(centred**2, axis=1))))
    means = (sums[count:] - sums[:-count]) / count
    variance = (squares[count:] - squares[:-count]) / count - np.sum(means**2, axis=1)
    return means + values.mean(axis=0), np.maximum(variance, 0.0)


def _smallest_step(values: Floats) -> float:
    """Return the smallest change from one reading to the next of any axis, as of a digit; 0 if all readings agree."""
    steps = np.abs(np.diff(values, axis=0))
    return float(np.min(steps, where=steps > 0.0, initial=float(steps.max(initial=0.0))))


def _pause(t: Floats, acc: Floats, gyro: Floats, step: float) -> Pause:
    """Return a rest; its creep about the horizontal is seen by gravity, and that about the vertical is like it.

    Every reading is turned into the sensor frame in the middle of the rest. An even creep cancels, so the turn is that
    of the rates beyond their mean, which no bias changes. Rates that never change may be wrong by half a `step`."""
    half, duration = len(t) // 2, float(t[-1] - t[0])
    rate = gyro.mean(axis=0)
    uneven = 0.5 * np.diff(t)[:, None] * (gyro[1:] + gyro[:-1] - 2.0 * rate)
    turned = np.concatenate((np.zeros((1, 3)), np.cumsum(uneven, axis=0)))
    at_middle = np.array([np.interp(0.5 * (t[0] + t[-1]), t, axis) for axis in turned.T])
    acc = acc + np.cross(turned - at_middle, acc)
    mean, sigma = acc.mean(axis=0), _block_variance(acc) ** 0.5
    size = float(np.linalg.norm(mean))
    change = acc[half:].mean(axis=0) - acc[:half].mean(axis=0)
    creep = -np.cross(mean, change) / (size * size) / (0.5 * duration)
    variance = _block_variance(gyro) or step * step / 12.0
    # the mean of a half has twice the variance of the whole mean
    level = (variance + (4.0 * sigma / (size * duration)) ** 2) ** 0.5
    slow = float(np.linalg.norm(creep))
    return Pause(
        float(t[0]), float(t[-1]), mean, sigma, rate - creep, slow, level, (variance + 0.5 * slow * slow) ** 0.5
    )


def _block_variance(values: Floats) -> float:
    """Return the variance of the mean of one axis by the scatter of its eight blocks, without their common slope."""
    blocks = np.array([block.mean(axis=0) for block in np.array_split(values, 8)])
    differences = np.diff(blocks, axis=0)
    return float(np.mean(differences**2)) / 2.0 / 8.0


def find_ways(recorded: Recorded, pauses: Sequence[Pause]) -> list[WayBetween]:
    """Return the way from each rest to the next, also those that are spoilt."""
    noise = [
        float(np.mean(np.var(np.diff(recorded.gyro[_inside(recorded, rest)], axis=0), axis=0))) / 2.0 for rest in pauses
    ]
    density = float(np.sqrt(np.median(noise) * recorded.interval)) if pauses else 0.0
    ways = []
    for number, (one, other) in enumerate(zip(pauses, pauses[1:], strict=False)):
        inside = (recorded.t > one.middle) & (recorded.t < other.middle)
        t = np.concatenate(([one.middle], recorded.t[inside], [other.middle]))
        gyro = np.stack([np.interp(t, recorded.t, axis) for axis in recorded.gyro.T], axis=1)
        turning = np.linalg.norm(gyro - 0.5 * (one.rate + other.rate), axis=1)
        turning = np.where((t > one.end) & (t < other.start), turning, 0.0)
        angle = float(np.trapezoid(turning, t))
        spoilt = ""
        if np.diff(t).max() > LONGEST_GAP * recorded.interval:
            spoilt = "samples are lost"
        elif recorded.at_end[inside].any():
            spoilt = "a sensor was at the end of its range: turn more slowly, or choose a larger range"
        ways.append(WayBetween(number, t, gyro, angle, density, spoilt))
    return ways


def _inside(recorded: Recorded, rest: Pause) -> NDArray[np.bool_]:
    return (recorded.t >= rest.start) & (recorded.t <= rest.end)
