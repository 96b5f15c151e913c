"""Detection of clipping: where the range of a sensor ends, and the clipped peak beyond it.

Many gyroscopes end at 250 or 500 degrees/s. A foot exceeds this as its heel rises and again as its leg swings. The
impact of a heel-strike exceeds the 2 g of some accelerometers. The reading then stays at the end of the range. Part of
the clipped peak is known, because the slopes at which the reading leaves the range and comes back are visible. The area
under the cubic through both ends with these slopes is D^2 (rise + fall) / 12 for D seconds beyond the range. The longer
this lasts and the more its ends differ, the flatter the true motion of a foot is. So

    m = D^2 sqrt(rise fall) / (6 (1 + D / FLATTENING))

is used: on recorded feet, cut off at 250 degrees/s, it errs by a third of m as a rule. reintegration.py uses the
result. The end of a range is learnt: an axis that stays at its largest reading for D seconds is at its end, unless a
smooth maximum could do the same. Between such slopes a smooth maximum would rise by D sqrt(rise fall) / 4."""

from __future__ import annotations

from math import sqrt
from typing import NamedTuple

from ...types import Vec3
from ...types.attrs import define, field, frozen

SAME_READING = 0.025
"""Largest relative difference of readings at the end of a range.

A calibration may mix the axes and subtract a bias."""
NEAR_END = 0.85
"""Smallest ratio of the end of an axis' range to the largest rate, because the ranges of the axes are alike."""
MOST_GROWTH = 1.5
"""Largest ratio of a reading to the largest one before it."""
FADE = 0.97
"""Factor of the largest rate for each stride, so that a wrong reading is forgotten."""
FLATTENING = 0.25
"""Time constant in the equation of m, s."""
BULGE = 3.0
"""Smallest rise of a smooth maximum that shows the end of a range, as a multiple of the scatter of its readings."""
SPREAD, FLOOR = 1.0, 0.05
"""Standard deviation of m as a share of m, and as a share of the integral that was measured meanwhile."""
MOST = 1.0
"""Largest clipped peak, rad."""
LONGEST = 0.5
"""Longest clipping, s; a reading that stays the same for longer is a fault or an even turn."""


@frozen
class SensorLimits:
    """The initial limits of a kind of sensor.

    Integrals are in rad for a gyroscope, in m/s for an accelerometer."""

    least: float
    """Smallest end of a range, rad/s or m/s^2."""
    largest_slope: float
    """Largest slope of a foot's motion except at heel-strike, rad/s^2 or m/s^3."""
    negligible: float
    """Largest clipped peak that is ignored, rad or m/s: the effect of a smooth maximum."""


GYROSCOPE = SensorLimits(2.0, 400.0, 0.004)
ACCELEROMETER = SensorLimits(15.0, 4000.0, 0.03)


class ClippedPeak(NamedTuple):
    """The integral over the clipped peak of one axis."""

    axis: int
    """Index of the axis: 0, 1 or 2."""
    integral: float
    """Angle about the sensor's axis, rad; for an accelerometer the velocity along it, m/s."""
    sigma: float
    """Standard deviation of `integral`, rad or m/s."""
    duration: float
    """Time beyond the range, s."""
    ago: float
    """Time from the return into the range to the last sample, s."""
    rise: float
    """Slope at which the axis left the range, rad/s^2 or m/s^3."""
    fall: float
    """Slope at which the axis came back into the range, rad/s^2 or m/s^3."""


@define
class ClippedAxis:
    """The clipping of one axis of a sensor."""

    top: float
    """Largest reading so far, rad/s or m/s^2."""
    bottom: float
    """Smallest reading so far, rad/s or m/s^2."""
    top_known: bool = False
    """The upper end of the range is `top`."""
    bottom_known: bool = False
    """The lower end of the range is `bottom`."""
    side: int = 0
    """Side of the range: 1 above it, -1 below it, 0 within."""
    duration: float = 0.0
    """Time from leaving the range to the last sample beyond it, s."""
    rise: float = 0.0
    """Slope at which the axis left the range, rad/s^2 or m/s^3."""
    after: float | None = None
    """First sample within the range again, rad/s or m/s^2; None before it."""
    after_dt: float = 0.0
    """Time of that sample since the last one beyond the range, s."""


@define
class Clipping:
    """Detects clipping of the three axes of a sensor.

    Latency: a clipped peak is known two samples after the return into the range."""

    limits: SensorLimits = GYROSCOPE
    axes: list[ClippedAxis] = field(init=False)
    largest: float = field(init=False)
    """Largest reading of any axis, rad/s or m/s^2."""
    watch_square: float = field(init=False)
    """Square of the norm from which on an axis may be at the end of its range."""
    clipping: bool = field(default=False, init=False)
    """An axis is beyond its range, or was one sample ago."""

    def __attrs_post_init__(self) -> None:
        self.axes = [ClippedAxis(self.limits.least, -self.limits.least) for _ in range(3)]
        self._set_largest(self.limits.least)

    def end_stride(self) -> None:
        """Let the largest readings decay at the end of a stride."""
        self._set_largest(FADE * self.largest)
        for axis in self.axes:
            if not axis.top_known:
                axis.top = max(self.limits.least, FADE * axis.top)
            if not axis.bottom_known:
                axis.bottom = min(-self.limits.least, FADE * axis.bottom)

    def reset(self) -> None:
        """Discard clipped peaks before a gap, because they are unknown."""
        self.clipping = False
        for axis in self.axes:
            axis.side = 0

    def update(
        self, dt: float, now: Vec3, before: Vec3, earlier: Vec3, earlier_dt: float, saturated: bool
    ) -> tuple[ClippedPeak, ...]:
        """Return the clipped peaks that one sample completes.

        `now` comes `dt` s after `before`, which came `earlier_dt` s after `earlier`; all in rad/s or m/s^2.
        `saturated`: the device reports that a sensor is at the end of its range."""
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
        known = saturated  # the range is larger than estimated
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
    if a > end * (1.0 + SAME_READING):  # not the end of the range
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
