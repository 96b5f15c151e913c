"""Checks of the times of samples, and of sensors that repeat their values."""

from __future__ import annotations

from collections.abc import Sequence
from operator import eq

from ...events import Defect
from ...types import Vec3
from ...types.attrs import define
from .finding import Finding

LONGEST_INTERVAL = 0.5
"""Longest usual interval between two samples of a foot, s; a longer one shows another unit of time."""
SHORTEST_INTERVAL = 1.0 / 5000.0
"""Shortest usual interval between two samples of a foot, s; a shorter one shows another unit of time."""
TIME_BLOCKS = 2
"""Number of successive blocks that show another unit of time before it is reported."""
SLOW_BLOCKS = 3
"""Number of successive blocks of motion at too low a rate before it is reported."""
LEAST_RATE = 18.0
"""Rate, samples a second, below which a walk is not followed; the slowest of the five published systems has 20."""
UNITS_OF_TIME = ((1e3, "milliseconds"), (1e6, "microseconds"), (1e9, "nanoseconds"))
"""Usual units of time, with their number in a second."""
BURST_STEP = 0.25
"""Part of the mean interval below which the usual interval is one within a burst of samples."""
BURST_BLOCKS, EXAMINED_BLOCKS = 3, 8
"""Number of blocks with bursts before they are reported, and number of first blocks in which they are searched."""
REPEAT_SAMPLES, REPEAT_SHARE = 160, 0.1
"""Number of samples in motion after which repeats are judged, and share of them above which they are reported."""
REPEAT_RATE = 0.5
"""Angular rate of a sample in motion, rad/s: in steps of 0.1 rad/s, those of an 8-bit gyroscope, it hardly repeats."""
SKIPPED_BLOCKS = 3
"""Number of blocks of motion that are not searched for repeats after each that is, in a sensor that had none so far."""
STUCK_SHARE = 0.9
"""Share of repeats in motion above which a sensor does not measure at all."""


@define
class RateCheck:
    """Looks at the intervals between samples, and at values that are exactly those of the sample before."""

    t: float | None = None
    """Time of the last sample of the block before, s; None before any."""
    strange_blocks: int = 0
    """Number of successive blocks whose times cannot be in s."""
    slow_blocks: int = 0
    """Number of successive blocks of motion with too low a rate."""
    blocks: int = 0
    """Number of blocks in which bursts were searched."""
    burst_blocks: int = 0
    """Number of them with bursts."""
    moving: int = 0
    """Number of samples in motion since repeats were judged last."""
    acc_repeats: int = 0
    """Number of them whose specific force is that of the sample before."""
    gyro_repeats: int = 0
    """Number of them whose angular rate is that of the sample before."""
    had_none: bool = False
    """Flag: repeats were judged, and there were few of them."""
    skips: int = 0
    """Number of blocks of motion that are not searched for repeats before the next one that is."""

    def add_times(self, times: Sequence[float], moves: bool, least_rate: float) -> Finding | None:
        """Add the times of a block, s; return a wrong unit, or a rate that is too low, once some blocks show it."""
        t, self.t = self.t, times[-1]
        interval = (times[-1] - times[0]) / (len(times) - 1) if t is None else (times[-1] - t) / len(times)
        if interval >= SHORTEST_INTERVAL and interval * least_rate < 1.0:
            self.strange_blocks = self.slow_blocks = 0
            return self._find_bursts(times, interval) if self.blocks < EXAMINED_BLOCKS else None
        steps = sorted([b - a for a, b in zip(times, times[1:], strict=False)])
        interval = steps[len(steps) // 2]
        if interval > LONGEST_INTERVAL and not moves:
            return None  # some devices send less while they lie still
        if not SHORTEST_INTERVAL <= interval <= LONGEST_INTERVAL:
            self.strange_blocks += 1
            self.slow_blocks = 0
            return wrong_time_unit(interval) if self.strange_blocks >= TIME_BLOCKS else None
        self.strange_blocks = 0
        if moves and interval * least_rate >= 1.0:
            self.slow_blocks += 1
            if self.slow_blocks >= SLOW_BLOCKS:
                rate = 1.0 / interval
                text = f"{rate:.3g} samples a second are too few to see every impact of a foot: choose 50 or more"
                return Finding(Defect.LOW_RATE, text, spoils=False)
        return None

    def _find_bursts(self, times: Sequence[float], interval: float) -> Finding | None:
        """Return that the samples of a block come in bursts, once some blocks show it; `interval`, s, is the mean."""
        self.blocks += 1
        steps = sorted([b - a for a, b in zip(times, times[1:], strict=False)])
        self.burst_blocks += steps[len(steps) // 2] < BURST_STEP * interval
        if self.burst_blocks < BURST_BLOCKS:
            return None
        text = "the samples come in bursts, with the time of the packet that brought them: give each sample the time at"
        return Finding(Defect.BURSTS, f"{text} which it was measured")

    def add_values(self, accs: Sequence[Vec3], gyros: Sequence[Vec3]) -> Finding | None:
        """Add a block of motion; return which sensor repeats its values, if one does."""
        if self.skips:
            self.skips -= 1
            return None
        self.skips = SKIPPED_BLOCKS if self.had_none else 0
        # while a foot stands, the values of a coarse or silent sensor repeat by themselves
        least = REPEAT_RATE * REPEAT_RATE
        fast = [x * x + y * y + z * z > least for x, y, z in gyros[1:]]
        self.acc_repeats += [a and b for a, b in zip(fast, map(eq, accs, accs[1:]), strict=False)].count(True)
        self.gyro_repeats += [a and b for a, b in zip(fast, map(eq, gyros, gyros[1:]), strict=False)].count(True)
        self.moving += fast.count(True)
        if self.moving < REPEAT_SAMPLES:
            return None
        limit = REPEAT_SHARE * self.moving
        acc_repeats, gyro_repeats = self.acc_repeats > limit, self.gyro_repeats > limit
        name = "the accelerometer repeats" if self.acc_repeats > self.gyro_repeats else "the gyroscope repeats"
        is_stuck = max(self.acc_repeats, self.gyro_repeats) > STUCK_SHARE * self.moving
        self.moving = self.acc_repeats = self.gyro_repeats = 0
        self.had_none = not (acc_repeats or gyro_repeats)
        if self.had_none:
            return None
        if is_stuck:
            text = f"{name} the same values while the foot moves: it is stuck; restart the sensor"
            return Finding(Defect.REPEATED, text)
        text = f"{'both sensors repeat' if acc_repeats and gyro_repeats else name} values: samples come more often than"
        return Finding(Defect.REPEATED, f"{text} it measures; choose the rate at which it measures", spoils=False)


def wrong_time_unit(interval: float) -> Finding:
    """Return the finding of a median interval of `interval`, in the unit of the times, that cannot be in s."""
    for count, name in UNITS_OF_TIME:
        if SHORTEST_INTERVAL <= interval / count <= LONGEST_INTERVAL and interval > 1.0:
            text = f"the times look like {name}, one sample each {interval:.4g}: divide them by {count:g}"
            return Finding(Defect.TIME_UNIT, text)
    return Finding(Defect.TIME_UNIT, f"one sample each {interval:.4g} s cannot be: the times must be in seconds")
