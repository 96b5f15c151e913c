"""Where a sensor's range ends, and what it did not see there.

Many gyroscopes end at 250 or 500 degrees/s, which a foot exceeds as its heel rises and again as its leg swings; and
the blow of a heel-strike is more than the 2 g of some accelerometers. The reading then stands at the end of the range.
How much is missed is known in part: the reading leaves the range and comes back to it as steeply as it is seen to.
Under the cubic through both ends with these slopes lie D^2 (rise + fall) / 12 for D seconds beyond the range; the
longer it lasts and the less alike its ends are, the flatter is what a foot really does, and so

    m = D^2 sqrt(rise fall) / (6 (1 + D / FLAT))

is taken: on recorded feet, cut off at 250 degrees/s, a third of m off as a rule. reintegration.py says what follows. Where
the range ends is learnt: an axis that stands at its largest reading for D seconds is at its end, unless that is no more
than what a smooth maximum does. Between ends as steep as those, it would rise by D sqrt(rise fall) / 4.
"""

from __future__ import annotations

from math import sqrt
from typing import NamedTuple

from ...types import Vec3
from ...types.attrs import define, field, frozen

SAME_READING = 0.025
"""Readings at the end of a range differ by less than this share of it: calibrations mix the axes, and a bias is off."""
NEAR_END = 0.85
"""The ends of the axes' ranges are alike: none is nearer than this share of the largest rate."""
MOST_GROWTH = 1.5
"""No reading is believed to be more than so many times the largest before it."""
FADE = 0.97
"""What is left, a step later, of the largest rate, so that what was broken is forgotten."""
FLATTENING = 0.25
"""s, as in m."""
BULGE = 3.0
"""An end of a range is believed when a smooth maximum would rise by so many times what readings there differ by."""
SPREAD, FLOOR = 1.0, 0.05
"""What m is wrong by, as a share of it, and as a share of what was seen meanwhile."""
MOST = 1.0
"""No end of a range hides more, rad."""
LONGEST = 0.5
"""A reading that stands for longer than this is broken, or turns evenly, s."""


@frozen
class SensorLimits:
    """What is known of a kind of sensor before anything was seen of it; in rad of a gyroscope, in m/s of an
    accelerometer."""

    least: float
    """No range ends below this, rad/s or m/s^2."""
    largest_slope: float
    """What a foot does changes no faster, but when it strikes, rad/s^2 or m/s^3."""
    negligible: float
    """Less than this that was missed is nothing, rad or m/s: what a smooth maximum comes to."""


GYROSCOPE = SensorLimits(2.0, 400.0, 0.004)
ACCELEROMETER = SensorLimits(15.0, 4000.0, 0.03)


class ClippedPeak(NamedTuple):
    """What one axis did not see."""

    axis: int
    integral: float
    """About the sensor's axis, rad; of an accelerometer, along it, m/s."""
    sigma: float
    duration: float
    """How long it was beyond the range, s;"""
    ago: float
    """and how long before the last sample it came back to it, s."""
    rise: float
    fall: float
    """How steeply it left the range and came back, rad/s^2."""


@define
class ClippedAxis:
    """One axis of the gyroscope."""

    top: float
    """The largest reading seen, and the least, rad/s or m/s^2."""
    bottom: float
    top_known: bool = False
    """It cannot say more than `top`;"""
    bottom_known: bool = False
    """nor less than `bottom`."""
    side: int = 0
    """1: above the range now, -1: below it, 0: within."""
    duration: float = 0.0
    """From when it left the range to the last sample beyond it, s."""
    rise: float = 0.0
    """How steeply it left, rad/s^2."""
    after: float | None = None
    """The first sample within the range again, rad/s, and how long after the last one beyond it, s:"""
    after_dt: float = 0.0


@define
class Clipping:
    """Three axes. Latency: what was missed is known two samples after the range is entered again."""

    limits: SensorLimits = GYROSCOPE
    axes: list[ClippedAxis] = field(init=False)
    largest: float = field(init=False)
    """The largest reading of any axis."""
    watch_square: float = field(init=False)
    """Square of what is measured from which on an axis may be at its end."""
    clipping: bool = field(default=False, init=False)
    """An axis is beyond its range, or was a sample ago."""

    def __attrs_post_init__(self) -> None:
        self.axes = [ClippedAxis(self.limits.least, -self.limits.least) for _ in range(3)]
        self._set_largest(self.limits.least)

    def end_stride(self) -> None:
        """A step ended."""
        self._set_largest(FADE * self.largest)
        for axis in self.axes:
            if not axis.top_known:
                axis.top = max(self.limits.least, FADE * axis.top)
            if not axis.bottom_known:
                axis.bottom = min(-self.limits.least, FADE * axis.bottom)

    def reset(self) -> None:
        """There was a gap: what was missed before it is not known."""
        self.clipping = False
        for axis in self.axes:
            axis.side = 0

    def update(
        self, dt: float, now: Vec3, before: Vec3, earlier: Vec3, earlier_dt: float, saturated: bool
    ) -> tuple[ClippedPeak, ...]:
        """One rate, rad/s, `dt` s after `before`, which was `earlier_dt` after `earlier`; `saturated`: the device says
        that a sensor is at its end. Returns what turned out to have been missed."""
        found: tuple[ClippedPeak, ...] = ()
        clipping = False
        for i in (0, 1, 2):
            axis, a = self.axes[i], now[i]
            if axis.side == 0:
                if abs(a) > NEAR_END * self.largest and not axis.bottom * (1.0 - SAME_READING) < a < axis.top * (
                    1.0 - SAME_READING
                ):
                    _enter_clipping(
                        axis, dt, a, before[i], earlier[i], earlier_dt, saturated, self.limits.largest_slope
                    )
                    if abs(a) > self.largest:
                        self._set_largest(min(abs(a), MOST_GROWTH * self.largest))
            else:
                peak = _follow_clipping(axis, i, dt, a, self.limits.largest_slope)
                if peak is not None and abs(peak.integral) > self.limits.negligible:
                    found = (*found, peak)
            clipping = clipping or axis.side != 0
        self.clipping = clipping
        return found

    def _set_largest(self, rate: float) -> None:
        self.largest = max(self.limits.least, rate)
        self.watch_square = NEAR_END * NEAR_END * self.largest * self.largest


def _enter_clipping(
    axis: ClippedAxis,
    dt: float,
    a: float,
    before: float,
    earlier: float,
    earlier_dt: float,
    saturated: bool,
    largest_slope: float,
) -> None:
    sign = 1 if a > 0.0 else -1
    a, before, earlier = sign * a, sign * before, sign * earlier
    end = axis.top if sign > 0 else -axis.bottom
    known = axis.top_known if sign > 0 else axis.bottom_known
    stands = a * (1.0 - SAME_READING) <= before <= a * (1.0 + SAME_READING)
    if a > end * (1.0 + SAME_READING):
        known = saturated  # it can say more than was thought
    end = max(end, min(a, MOST_GROWTH * end))
    known = known or saturated
    if sign > 0:
        axis.top, axis.top_known = end, known
    else:
        axis.bottom, axis.bottom_known = -end, known
    if not (known or stands):
        return
    axis.side, axis.after, axis.after_dt = sign, None, 0.0
    axis.rise = _slope(before - earlier, earlier_dt, largest_slope)
    if stands:
        axis.duration = dt
    else:
        axis.rise = max(_slope(a - before, dt, largest_slope), axis.rise)
        axis.duration = max(0.0, dt - (a - before) / axis.rise)


def _follow_clipping(axis: ClippedAxis, i: int, dt: float, a: float, largest_slope: float) -> ClippedPeak | None:
    sign = axis.side
    a *= sign
    end = axis.top if sign > 0 else -axis.bottom
    if a > end * (1.0 + SAME_READING):  # it was not the end
        if sign > 0:
            axis.top, axis.top_known = min(a, MOST_GROWTH * end), False
        else:
            axis.bottom, axis.bottom_known = -min(a, MOST_GROWTH * end), False
        axis.side = 0
        return None
    if a >= end * (1.0 - SAME_READING):
        axis.duration += dt + axis.after_dt
        axis.after, axis.after_dt = None, 0.0
        if axis.duration > LONGEST:
            axis.side = 0
        return None
    if axis.after is None:
        axis.after, axis.after_dt = a, dt
        return None
    fall = max(_slope(end - axis.after, axis.after_dt, largest_slope), _slope(axis.after - a, dt, largest_slope))
    if not (axis.top_known if sign > 0 else axis.bottom_known):
        if axis.duration * sqrt(axis.rise * fall) < 4.0 * BULGE * SAME_READING * end:
            axis.side, axis.after, axis.after_dt = 0, None, 0.0
            return None
        if sign > 0:
            axis.top_known = True
        else:
            axis.bottom_known = True
    tail = min((end - axis.after) / fall, axis.after_dt)
    duration = axis.duration + axis.after_dt - tail
    integral = min(duration * duration * sqrt(axis.rise * fall) / (6.0 * (1.0 + duration / FLATTENING)), MOST)
    axis.side, axis.after, axis.after_dt = 0, None, 0.0
    return ClippedPeak(
        i, sign * integral, SPREAD * integral + FLOOR * end * duration, duration, dt + tail, axis.rise, fall
    )


def _slope(more: float, dt: float, largest_slope: float) -> float:
    return min(max(more / dt, 1.0), largest_slope) if dt > 0.0 else 1.0
