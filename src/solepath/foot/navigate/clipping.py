"""Detection of clipping: the end of a sensor's range, and the clipped peak beyond it.

The range of many gyroscopes ends at 250 or 500 degrees/s. A foot exceeds this as its heel rises and again as its leg
swings. The impact of a heel-strike exceeds the 2 g of some accelerometers. The reading then stays at the end of the
range for D seconds. The clipped peak can be estimated, because the slopes at which the reading leaves the range (rise)
and comes back (fall) are visible. The area under the cubic through both ends with these slopes is
D^2 (rise + fall) / 12. The longer the clipping lasts and the more its slopes differ, the flatter the true motion of a
foot is. So the estimate is

    m = D^2 sqrt(rise fall) / (6 (1 + D / FLATTENING_TIME)).

On recorded feet, cut off at 250 degrees/s, its error is a third of m as a rule. reintegration.py uses m.

The end of a range is learnt: an axis that stays at its largest reading for D seconds is at its end, unless a smooth
maximum could look the same. Between slopes rise and fall a smooth maximum would be D sqrt(rise fall) / 4 high. The
numbers were chosen by hand and not swept."""

from __future__ import annotations

from math import sqrt
from typing import NamedTuple

from ...types import Vec3
from ...types.attrs import define, field, frozen

SAME_READING_SHARE = 0.025
"""Largest relative difference between readings that are all at the end of a range.

They differ because a calibration may mix the axes and subtract a bias."""
NEAR_END_RATIO = 0.85
"""Smallest ratio of the end of an axis' range to the largest reading of any axis; the ranges of the axes are alike."""
LARGEST_GROWTH = 1.5
"""Largest ratio by which one reading may raise the largest reading."""
STRIDE_DECAY = 0.97
"""Factor by which each stride reduces the largest reading, so that a wrong one is forgotten."""
FLATTENING_TIME = 0.25
"""Duration of clipping at which the estimate of the clipped peak is halved, s."""
LEAST_BULGE_RATIO = 3.0
"""Height of a smooth maximum above which equal readings show the end of a range, as a multiple of their scatter."""
PEAK_SIGMA_SHARE, MEASURED_SIGMA_SHARE = 1.0, 0.05
"""Parts of the standard deviation of m: as a share of m, and as a share of the integral that was measured meanwhile."""
LARGEST_PEAK = 1.0
"""Largest integral over a clipped peak, rad or m/s."""
LONGEST_CLIPPING = 0.5
"""Longest clipping, s; a reading that stays the same for longer is a fault or an even turn."""


@frozen
class SensorLimits:
    """The limits of a kind of sensor; integrals are in rad for a gyroscope, in m/s for an accelerometer."""

    least_end: float
    """Smallest reading that can be the end of a range, rad/s or m/s^2."""
    largest_slope: float
    """Largest slope of a foot's motion except at heel-strike, rad/s^2 or m/s^3."""
    negligible: float
    """Largest integral over a clipped peak that is ignored, rad or m/s; a smooth maximum gives as much."""


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
    age: float
    """Time from the return into the range to the last sample, s."""
    rise: float
    """Slope at which the axis left the range, rad/s^2 or m/s^3."""
    fall: float
    """Slope at which the axis came back into the range, rad/s^2 or m/s^3."""


@define
class ClippedAxis:
    """The clipping of one axis of a sensor."""

    top: float
    """Estimate of the upper end of the range from the largest reading, rad/s or m/s^2."""
    bottom: float
    """Estimate of the lower end of the range from the smallest reading, rad/s or m/s^2."""
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
    first_inside: float | None = None
    """First reading within the range after clipping, rad/s or m/s^2; None before it."""
    first_inside_dt: float = 0.0
    """Time from the last sample beyond the range to that of `first_inside`, s."""


@define
class Clipping:
    """Detects clipping of the three axes of a sensor.

    Latency: a clipped peak is known two samples after the return into the range."""

    limits: SensorLimits = GYROSCOPE
    axes: list[ClippedAxis] = field(init=False)
    largest: float = field(init=False)
    """Largest reading of any axis so far, which decays, rad/s or m/s^2."""
    near_end_square: float = field(init=False)
    """Square of the norm of a reading from which on an axis may be at the end of its range, (rad/s)^2 or (m/s^2)^2."""
    clipping: bool = field(default=False, init=False)
    """An axis is beyond its range, or was one sample ago."""

    def __attrs_post_init__(self) -> None:
        self.axes = [ClippedAxis(self.limits.least_end, -self.limits.least_end) for _ in range(3)]
        self._set_largest(self.limits.least_end)

    def end_stride(self) -> None:
        """Let the largest readings decay at the end of a stride."""
        self._set_largest(STRIDE_DECAY * self.largest)
        for axis in self.axes:
            if not axis.top_known:
                axis.top = max(self.limits.least_end, STRIDE_DECAY * axis.top)
            if not axis.bottom_known:
                axis.bottom = min(-self.limits.least_end, STRIDE_DECAY * axis.bottom)

    def reset(self) -> None:
        """Discard clipped peaks that a gap has interrupted."""
        self.clipping = False
        for axis in self.axes:
            axis.side = 0

    def update(
        self, dt: float, readings: Vec3, previous: Vec3, earlier: Vec3, earlier_dt: float, saturated: bool
    ) -> tuple[ClippedPeak, ...]:
        """Return the clipped peaks that become known with this sample.

        `readings` comes `dt` s after `previous`, which came `earlier_dt` s after `earlier`; all in rad/s or m/s^2.
        `saturated` is True when the device reports that a sensor is at the end of its range."""
        peaks: tuple[ClippedPeak, ...] = ()
        clipping = False
        for i in (0, 1, 2):
            axis, reading = self.axes[i], readings[i]
            if axis.side == 0:
                if abs(reading) > NEAR_END_RATIO * self.largest and not axis.bottom * (
                    1.0 - SAME_READING_SHARE
                ) < reading < axis.top * (1.0 - SAME_READING_SHARE):
                    _enter_clipping(
                        axis, dt, reading, previous[i], earlier[i], earlier_dt, saturated, self.limits.largest_slope
                    )
                    if abs(reading) > self.largest:
                        self._set_largest(min(abs(reading), LARGEST_GROWTH * self.largest))
            else:
                peak = _follow_clipping(axis, i, dt, reading, self.limits.largest_slope)
                if peak is not None and abs(peak.integral) > self.limits.negligible:
                    peaks = (*peaks, peak)
            clipping = clipping or axis.side != 0
        self.clipping = clipping
        return peaks

    def _set_largest(self, rate: float) -> None:
        self.largest = max(self.limits.least_end, rate)
        self.near_end_square = NEAR_END_RATIO * NEAR_END_RATIO * self.largest * self.largest


def _enter_clipping(
    axis: ClippedAxis,
    dt: float,
    reading: float,
    previous: float,
    earlier: float,
    earlier_dt: float,
    saturated: bool,
    largest_slope: float,
) -> None:
    sign = 1 if reading > 0.0 else -1
    reading, previous, earlier = sign * reading, sign * previous, sign * earlier
    end = axis.top if sign > 0 else -axis.bottom
    end_known = axis.top_known if sign > 0 else axis.bottom_known
    unchanged = reading * (1.0 - SAME_READING_SHARE) <= previous <= reading * (1.0 + SAME_READING_SHARE)
    if reading > end * (1.0 + SAME_READING_SHARE):
        end_known = saturated  # the range is larger than estimated
    end = max(end, min(reading, LARGEST_GROWTH * end))
    end_known = end_known or saturated
    if sign > 0:
        axis.top, axis.top_known = end, end_known
    else:
        axis.bottom, axis.bottom_known = -end, end_known
    if not (end_known or unchanged):
        return
    axis.side, axis.first_inside, axis.first_inside_dt = sign, None, 0.0
    axis.rise = _slope(previous - earlier, earlier_dt, largest_slope)
    if unchanged:
        axis.duration = dt
    else:
        axis.rise = max(_slope(reading - previous, dt, largest_slope), axis.rise)
        axis.duration = max(0.0, dt - (reading - previous) / axis.rise)


def _follow_clipping(axis: ClippedAxis, i: int, dt: float, reading: float, largest_slope: float) -> ClippedPeak | None:
    sign = axis.side
    reading *= sign
    end = axis.top if sign > 0 else -axis.bottom
    if reading > end * (1.0 + SAME_READING_SHARE):  # not the end of the range
        if sign > 0:
            axis.top, axis.top_known = min(reading, LARGEST_GROWTH * end), False
        else:
            axis.bottom, axis.bottom_known = -min(reading, LARGEST_GROWTH * end), False
        axis.side = 0
        return None
    if reading >= end * (1.0 - SAME_READING_SHARE):
        axis.duration += dt + axis.first_inside_dt
        axis.first_inside, axis.first_inside_dt = None, 0.0
        if axis.duration > LONGEST_CLIPPING:
            axis.side = 0
        return None
    if axis.first_inside is None:
        axis.first_inside, axis.first_inside_dt = reading, dt
        return None
    fall = max(
        _slope(end - axis.first_inside, axis.first_inside_dt, largest_slope),
        _slope(axis.first_inside - reading, dt, largest_slope),
    )
    if not (axis.top_known if sign > 0 else axis.bottom_known):
        if axis.duration * sqrt(axis.rise * fall) < 4.0 * LEAST_BULGE_RATIO * SAME_READING_SHARE * end:
            axis.side, axis.first_inside, axis.first_inside_dt = 0, None, 0.0
            return None
        if sign > 0:
            axis.top_known = True
        else:
            axis.bottom_known = True
    tail = min((end - axis.first_inside) / fall, axis.first_inside_dt)
    duration = axis.duration + axis.first_inside_dt - tail
    integral = min(
        duration * duration * sqrt(axis.rise * fall) / (6.0 * (1.0 + duration / FLATTENING_TIME)), LARGEST_PEAK
    )
    axis.side, axis.first_inside, axis.first_inside_dt = 0, None, 0.0
    return ClippedPeak(
        i,
        sign * integral,
        PEAK_SIGMA_SHARE * integral + MEASURED_SIGMA_SHARE * end * duration,
        duration,
        dt + tail,
        axis.rise,
        fall,
    )


def _slope(change: float, dt: float, largest_slope: float) -> float:
    return min(max(change / dt, 1.0), largest_slope) if dt > 0.0 else 1.0
