"""Checks of the size of gravity and of angular rates, which show other units and gravity that was removed."""

from __future__ import annotations

from collections.abc import Sequence
from math import dist, fsum, inf, log2
from operator import and_, eq, sub
from typing import NamedTuple

from ...events import Defect, StrideTaken
from ...types import Vec3
from ...types.attrs import define, field
from ...types.vector import GRAVITY, dot
from .stances import Finding

# Detection of a sensor whose range is too small for the motion, from peaks that end at the same value.

SAME = 1e-4
"""Relative difference within which two values are the same end of a range; peaks differ by more."""
LEAST_BLOCKS, LEAST_PAIRS = 3, 5
"""Number of blocks with, and of pairs of neighbours among, samples at the end of a range that show clipping.

Of 378 recordings of a foot, none of a sensor that does not clip has more than one pair in 20 s of walking."""
SPOILING_SHARE = 0.01
"""Share of the recent samples at the end of a range above which a track cannot be trusted."""
RECENT_SAMPLES = 2000
"""Number of samples after which the share is computed from the later half alone: a wearer may walk slowly first."""

Extremes = list[float]
"""Largest value of x, of -x, of y, of -y, of z and of -z, m/s^2 or rad/s."""


class RangeKind(NamedTuple):
    """The properties of a kind of sensor."""

    name: str
    """Name in sentences."""
    unit: str
    """Unit in sentences."""
    least: float
    """Smallest end of a range that counts; a smaller value is gravity, or the noise of a foot at rest."""


ACCELEROMETER = RangeKind("accelerometer", "m/s^2", 12.0)
"""An accelerometer, m/s^2."""
GYROSCOPE = RangeKind("gyroscope", "rad/s", 2.0)
"""A gyroscope, rad/s."""


def find_extremes(values: Sequence[Vec3]) -> Extremes:
    """Return the extremes of every other sample of a block, among which is one of any two neighbours at an end."""
    extremes: Extremes = []
    for axis in zip(*values[::2], strict=True):
        extremes += max(axis), -min(axis)
    return extremes


@define
class ChannelEnd:
    """One end of the range of one axis: the largest value so far, and how often it came."""

    largest: float = 0.0
    """Largest value so far, m/s^2 or rad/s."""
    samples: int = 0
    """Number of samples at `largest`."""
    pairs: int = 0
    """Number of neighbours that are both at `largest`."""
    blocks: int = 0
    """Number of blocks with samples at `largest`."""
    first: int = 0
    """Number of samples before those of which `samples` are counted."""
    cut_at: float = 0.0
    """Value at which peaks were seen to be cut off, m/s^2 or rad/s; 0 before."""


@define
class RangeCheck:
    """Looks at the largest and the smallest value of each axis of one sensor."""

    ends: list[ChannelEnd] = field(factory=lambda: [ChannelEnd() for _ in range(6)])
    """Ends of the ranges: upper and lower end of x, then of y, then of z."""
    samples: int = 0
    """Number of samples so far."""

    @property
    def cut_at(self) -> list[float]:
        """The ends at which peaks are cut off, m/s^2 or rad/s; infinite where none are."""
        return [end.cut_at or inf for end in self.ends]

    @property
    def cuts_off(self) -> bool:
        """Return whether peaks are cut off."""
        return min(self.cut_at) < inf

    def add(self, kind: RangeKind, values: Sequence[Vec3], extremes: Extremes) -> Finding | None:
        """Add a block of samples with its `find_extremes`; return an end of the range that cuts off peaks, if any."""
        found = None
        for i, (end, extreme) in enumerate(zip(self.ends, extremes, strict=True)):
            if extreme > kind.least and extreme >= end.largest * (1.0 - SAME):
                axis, sign = i // 2, -1.0 if i % 2 else 1.0
                if self._add_block(end, [sign * value[axis] for value in values]):
                    found = end
        self.samples += len(values)
        if found is None:
            return None
        share = found.samples / (self.samples - found.first)
        if self.samples - found.first > RECENT_SAMPLES:
            found.samples, found.first = found.samples // 2, (found.first + self.samples) // 2
        percent = f"{100.0 * share:.0f}" if share >= 0.1 else f"{100.0 * share:.2g}"
        text = f"the {kind.name} cuts off peaks at {found.largest:.3g} {kind.unit}, in {percent} % of samples"
        return Finding(Defect.CLIPPED, f"{text}: choose a larger range, if it has one", spoils=share > SPOILING_SHARE)

    def _add_block(self, end: ChannelEnd, channel: list[float]) -> bool:
        """Add a block that reaches the end of the range; return whether it now is seen to cut off peaks."""
        extreme = max(channel)
        if extreme > end.largest * (1.0 + SAME):
            end.largest, end.samples, end.pairs, end.blocks, end.first = extreme, 0, 0, 0, self.samples
        limit = end.largest * (1.0 - SAME)
        at_end = [value >= limit for value in channel]
        end.blocks += 1
        end.samples += at_end.count(True)
        end.pairs += [*map(and_, at_end, at_end[1:])].count(True)
        is_end = end.blocks >= LEAST_BLOCKS and end.pairs >= LEAST_PAIRS
        if is_end:
            end.cut_at = end.largest
        return is_end


# Checks of the times of samples, and of sensors that repeat their values.

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

    def add_times(self, times: Sequence[float], moves: bool) -> Finding | None:
        """Add the times of a block, s; return a wrong unit, or a rate that is too low, once some blocks show it."""
        t, self.t = self.t, times[-1]
        interval = (times[-1] - times[0]) / (len(times) - 1) if t is None else (times[-1] - t) / len(times)
        if interval >= SHORTEST_INTERVAL and interval * LEAST_RATE < 1.0:
            self.strange_blocks = self.slow_blocks = 0
            return self._find_bursts(times, interval) if self.blocks < EXAMINED_BLOCKS else None
        interval = _usual_interval(times)
        if interval > LONGEST_INTERVAL and not moves:
            return None  # some devices send less while they lie still
        if not SHORTEST_INTERVAL <= interval <= LONGEST_INTERVAL:
            self.strange_blocks += 1
            self.slow_blocks = 0
            return wrong_time_unit(interval) if self.strange_blocks >= TIME_BLOCKS else None
        self.strange_blocks = 0
        if not moves or interval * LEAST_RATE < 1.0:
            return None
        self.slow_blocks += 1
        if self.slow_blocks < SLOW_BLOCKS:
            return None
        rate = 1.0 / interval
        text = f"{rate:.3g} samples a second are too few to see every impact of a foot: choose 50 or more"
        return Finding(Defect.LOW_RATE, text, spoils=False)

    def _find_bursts(self, times: Sequence[float], interval: float) -> Finding | None:
        """Return that the samples of a block come in bursts, once some blocks show it; `interval`, s, is the mean."""
        self.blocks += 1
        self.burst_blocks += _usual_interval(times) < BURST_STEP * interval
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
        fast = [dot(gyro, gyro) > REPEAT_RATE * REPEAT_RATE for gyro in gyros[1:]]
        self.acc_repeats += [*map(and_, fast, map(eq, accs, accs[1:]))].count(True)
        self.gyro_repeats += [*map(and_, fast, map(eq, gyros, gyros[1:]))].count(True)
        self.moving += fast.count(True)
        if self.moving < REPEAT_SAMPLES:
            return None
        acc, gyro = self.acc_repeats / self.moving, self.gyro_repeats / self.moving
        self.moving = self.acc_repeats = self.gyro_repeats = 0
        self.had_none = max(acc, gyro) <= REPEAT_SHARE
        if self.had_none:
            return None
        name = "the accelerometer repeats" if acc > gyro else "the gyroscope repeats"
        text = (
            f"{'both sensors repeat' if min(acc, gyro) > REPEAT_SHARE else name} values: samples come more often than"
        )
        return Finding(Defect.REPEATED, f"{text} it measures; choose the rate at which it measures", spoils=False)


def _usual_interval(times: Sequence[float]) -> float:
    """Return the median of the intervals between samples."""
    steps: list[float] = sorted(map(sub, times[1:], times))
    return steps[len(steps) // 2]


def wrong_time_unit(interval: float) -> Finding:
    """Return the finding of a median interval of `interval`, in the unit of the times, that cannot be in s."""
    for count, name in UNITS_OF_TIME:
        if SHORTEST_INTERVAL <= interval / count <= LONGEST_INTERVAL and interval > 1.0:
            text = f"the times look like {name}, one sample each {interval:.4g}: divide them by {count:g}"
            return Finding(Defect.TIME_UNIT, text)
    return Finding(Defect.TIME_UNIT, f"one sample each {interval:.4g} s cannot be: the times must be in seconds")


# Check of an insole's values against the strides of its foot, which shows another unit or too coarse values.

STRIDES = 6
"""Number of strides after which the contacts of a foot are judged."""
LONGEST_STANCE = 0.6
"""Longest time between two strides that follow each other, s."""
MOST_CONTACTS = 1.75
"""Number of heel-strikes a stride above which the load contradicts the motion."""
LEAST_LOAD, LARGEST_LOAD = 40.0, 4000.0
"""Mean load of a foot on the ground, N, of an insole that covers part of the sole of a child, and of a heavy runner."""


@define
class LoadCheck:
    """Counts the heel-strikes of a foot in its strides, and adds up its load on the ground."""

    strides: int = 0
    """Number of strides since they were judged last."""
    contacts: int = 0
    """Number of heel-strikes in these strides."""
    new_contacts: int = 0
    """Number of heel-strikes since the last stride."""
    t_end: float | None = None
    """End of the last stride, s; None before any."""
    loaded: int = 0
    """Number of strides with a load."""
    load_sum: float = 0.0
    """Sum of their mean loads on the ground, N or in the unit of the samples."""

    def add_stride(self, stride: StrideTaken, in_newtons: bool) -> Finding | None:
        """Add a stride; return wrong values of the insole, if these strides show them."""
        follows = self.t_end is not None and 0.0 <= stride.t_start - self.t_end < LONGEST_STANCE
        new_contacts, self.new_contacts, self.t_end = self.new_contacts, 0, stride.t_end
        if not follows:  # the wearer stood or stepped in place, which is no stride
            return None
        self.strides += 1
        self.contacts += new_contacts
        if stride.features.contact_load is not None:
            self.loaded += 1
            self.load_sum += stride.features.contact_load
        if self.strides < STRIDES:
            return None
        strides, contacts, loaded, load_sum = self.strides, self.contacts, self.loaded, self.load_sum
        self.strides = self.contacts = self.loaded = 0
        self.load_sum = 0.0
        if 2 * loaded < strides:
            return None
        if contacts > MOST_CONTACTS * strides:
            text = f"the insole shows {contacts} contacts in {strides} strides: its values are noise, or too coarse for"
            return Finding(Defect.PRESSURE_UNIT, f"{text} the load of a foot; check their unit and range")
        load = load_sum / loaded
        if in_newtons and not LEAST_LOAD <= load <= LARGEST_LOAD:
            text = f"the insole shows {load:.3g} N on the foot that carries the wearer: check the unit of its values"
            return Finding(Defect.PRESSURE_UNIT, f"{text} and its calibration")
        return None


TOLERANCE = 0.15
"""Relative deviation from 1 g of the specific force in stance or at rest above which it is wrong.

Of the sensors in 378 recordings of a foot, the worst reads 1.08 g."""
LEAST_GRAVITY, LEAST_SCALE = 0.3, 0.05
"""Part of 1 g below which gravity is missing in a foot that walks, and below which it is in a foot at rest."""
MOVING_GYRO, ENOUGH_BLOCKS = 1.0, 6
"""Largest angular rate in a block of a foot that moves, rad/s, and number of such blocks that show how it moves."""
STANCES = 6
"""Number of stances whose median is judged."""
MOST_STANCES = 11
"""Largest number of stances that are kept."""
STILL_MOTION = 0.3
"""Motion in stance (stances.py) up to which a specific force of more than 1 g is no motion, rad/s."""
STILL_ACC = 0.6
"""Largest range of an axis of a foot at rest, m/s^2; chosen by hand."""
LARGEST_LIFT, LONGEST_LIFT_START = 0.3, 3.0
"""Change of the specific force in a lift, as a part of 1 g, and time that a lift takes to start or stop, s, at most."""
STILL_TIME = 0.6
"""Least duration of a rest that is judged, s."""
IN_G, LARGEST_IN_RUN = 1.0, 2.0
"""Specific force of a foot at rest, and the largest in a stance of a runner, in units of g."""
WALKING_RANGE = 9.0
"""Mean range of an axis in a block of motion above which a foot walks in m/s^2; in units of g it is 1 to 3."""
FASTEST_RATE = 45.0
"""Angular rate of an axis, rad/s, that no foot reaches; the fastest kicks have about 35."""
FAST_BLOCKS = 2
"""Number of blocks with a faster rate before it is reported."""
SHAKEN_ACC, IDLE_GYRO = 10.0, 0.25
"""Range of an axis in a block, m/s^2, of a foot that walks, and angular rate, rad/s, that it always exceeds.

A foot at rest stays below the latter."""
IDLE_BLOCKS, IDLE_CHANGE = 6, 3.0
"""Number of blocks of a foot that walks without any angular rate before it is reported, and least change of the mean
specific force from one such block to the next, m/s^2: gravity turns in a foot that walks, not in a car."""


@define
class GravityCheck:
    """Looks at the specific force in stance and at rest, and at the largest angular rates."""

    stances: list[float] = field(factory=list)
    """Norm of the specific force in each of the newest stances, m/s^2."""
    still_since: float | None = None
    """Start of the rest that lasts, s; None in motion."""
    wrong_since: float | None = None
    """Time since which a foot at rest has another specific force than 1 g, s; None while it has 1 g."""
    rested: bool = False
    """Flag: a foot at rest had 1 g, whatever its stances show."""
    moving_blocks: int = 0
    """Number of blocks of motion."""
    range_sum: float = 0.0
    """Sum of the ranges of the specific force in them, m/s^2."""
    fast_blocks: int = 0
    """Number of blocks with an angular rate that no foot has."""
    idle_blocks: int = 0
    """Number of blocks of a shaken foot without any angular rate, in which gravity turns."""
    idle_force: Vec3 | None = None
    """Mean specific force of the newest block without an angular rate, m/s^2; None after one with."""

    def add_stance(self, acc: Vec3, motion: float) -> Finding | None:
        """Add the mean specific force of a stance, m/s^2, and its motion, rad/s; return the defect that stances show.

        A foot that turns in stance, as a runner's, has more than 1 g, never much less."""
        norm = dot(acc, acc) ** 0.5
        if motion > STILL_MOTION and (
            norm > (1.0 + TOLERANCE) * GRAVITY or (1.0 + TOLERANCE < norm / IN_G < LARGEST_IN_RUN and not self._walks)
        ):
            return None
        self.stances = [*self.stances[1 - MOST_STANCES :], norm]
        if not self.knows_stances or self.rested:
            return None
        norms = sorted(self.stances)
        middle, quarter = norms[len(norms) // 2], len(norms) // 4
        # with the accelerometer mended, most stances must read the same, as those of a foot that carries somebody
        alike = norms[-1 - quarter] - norms[quarter] < TOLERANCE * middle or middle < LEAST_GRAVITY * GRAVITY
        return self._judge(middle, "in stance") if alike else None

    @property
    def knows_stances(self) -> bool:
        """Return whether enough stances were seen to judge them."""
        return len(self.stances) >= STANCES

    def add_block(
        self, t: float, t_end: float, accs: Sequence[Vec3], acc_range: float, gyro_peak: float
    ) -> Finding | None:
        """Add a block from `t` to `t_end`, s; return the defect that it shows, if any.

        `acc_range` is the largest range of an axis, m/s^2, and `gyro_peak` the largest angular rate, rad/s."""
        if gyro_peak > FASTEST_RATE:
            self.fast_blocks += 1
            if self.fast_blocks >= FAST_BLOCKS:
                return Finding(
                    Defect.GYRO_UNIT,
                    f"angular rates of {gyro_peak:.0f} rad/s are faster than any foot: they look like degrees a second"
                    " (multiply them by pi / 180), or the range of the gyroscope is declared several times too large",
                )
            return None
        if gyro_peak > IDLE_GYRO:
            self.still_since = self.wrong_since = None
            self.idle_blocks, self.idle_force = 0, None
            if gyro_peak > MOVING_GYRO:
                self.moving_blocks += 1
                self.range_sum += acc_range
            return None
        if acc_range > SHAKEN_ACC:
            x, y, z = [fsum(axis) / len(accs) for axis in zip(*accs, strict=True)]
            before, self.idle_force = self.idle_force, (x, y, z)
            self.idle_blocks += before is not None and dist(before, (x, y, z)) > IDLE_CHANGE
            if self.idle_blocks >= IDLE_BLOCKS:
                return Finding(
                    Defect.GYRO_UNIT,
                    "the gyroscope reads almost nothing while the foot moves: switch it on, and give it in rad/s",
                )
        if acc_range > STILL_ACC:
            self.still_since = self.wrong_since = None
            return None
        if self.still_since is None:
            self.still_since = t
        if t_end - self.still_since < STILL_TIME:
            return None
        x, y, z = [sorted(axis)[len(axis) // 2] for axis in zip(*accs, strict=True)]
        norm = dot((x, y, z), (x, y, z)) ** 0.5
        finding = self._judge(norm, "at rest")
        if finding is None:
            self.rested = self.rested or abs(norm / GRAVITY - 1.0) <= TOLERANCE
            self.wrong_since = None
            return None
        if self.wrong_since is None:
            self.wrong_since = t
        may_be_lift = abs(norm / GRAVITY - 1.0) < LARGEST_LIFT and t_end - self.wrong_since < LONGEST_LIFT_START
        return None if may_be_lift else finding

    @property
    def _walks(self) -> bool:
        """Return whether the specific force changes as that of a foot which walks, in m/s^2."""
        return self.range_sum > WALKING_RANGE * self.moving_blocks

    def _judge(self, norm: float, when: str) -> Finding | None:
        """Return the defect of an accelerometer that reads `norm` `when` the foot stands; None if it reads 1 g."""
        ratio = norm / GRAVITY
        if abs(ratio - 1.0) <= TOLERANCE:
            return None
        if LEAST_SCALE <= ratio < LEAST_GRAVITY and self.moving_blocks < ENOUGH_BLOCKS:
            return None  # only motion shows whether gravity is missing or all of the specific force is small
        if abs(norm - IN_G) <= TOLERANCE * IN_G and not self._walks:
            text = f"the accelerometer reads {norm:.2f} {when}: it is in g; multiply it by 9.80665"
            return Finding(Defect.ACC_UNIT, text)
        text = f"the accelerometer reads {norm:.2f} m/s^2 {when}, not 9.81"
        times = round(log2(1.0 / ratio)) if ratio > 0.0 else 0
        if ratio < LEAST_GRAVITY and (self._walks or ratio < LEAST_SCALE):
            text = f"{text}: gravity was removed, or the sensor is off; send what it measures itself, with gravity"
            return Finding(Defect.NO_GRAVITY, text)
        if abs(times) in (1, 2, 3) and abs(ratio * 2.0**times - 1.0) <= TOLERANCE:
            text = f"{text}: the sensor's range is {2.0**times:g} times the range that is assumed"
            return Finding(Defect.WRONG_SCALE, text)
        return Finding(Defect.WRONG_SCALE, f"{text}: multiply it by {1.0 / ratio:.3g}")
