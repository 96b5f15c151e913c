"""Conversion of device ticks to host seconds, with a line fitted below the packet arrivals.

A packet arrives at `offset + slope * ticks + delay`, and a radio's delay is always positive. Therefore the fitted line
lies below all arrivals. Among the lines below them, it is the one with the least sum of vertical distances: the edge of
the lower convex hull that spans the points' mean time (S. Moon, P. Skelly, D. Towsley, "Estimation and removal of clock
skew from network delay measurements", 1999). The numbers below are those of protocol/clock.md.

Memory is bounded. Device time is cut into windows. The fit keeps only the earliest arrival of each window, and at most
32 windows. When there are more, they are merged in pairs until windows are 16 s long; then the oldest is dropped.

A time is assigned once and never revised. Assigned times approach the line slowly (slewing): the time between two
neighbouring samples is changed by at most 0.5 %, so a first packet that came 50 ms late is corrected over 10 s. While
the error is above 0.25 s, up to 2 % is allowed. Assigned times strictly increase.

The times of two clocks are comparable only when both clocks are settled. A fit that starts with a late packet is behind
until slewing has removed the delay. A clock is settled when its times have been within 5 ms of the line for 5 s of
device time. Then two clocks of 100 packets a second agree within 5 ms, with up to 50 ms of radio jitter or connection
interval. The receiver cannot measure a delay that *every* packet of a device has. If the intervals between packets and
between the radio's connection events are nearly equal, this delay may for long be up to one connection interval."""

from __future__ import annotations

from copy import copy
from itertools import pairwise
from math import fsum, inf

from ..types.attrs import define, field

FIRST_WINDOW_LENGTH = 0.25
"""Length of a window when the fit starts, device seconds."""
LAST_WINDOW_LENGTH = 16.0
"""Largest length of a window, device seconds.

32 windows of this length cover about eight minutes, in which a crystal's temperature hardly changes."""
MAX_WINDOWS = 32
"""Largest number of windows that the fit keeps."""
MAX_DRIFT = 0.06
"""Largest relative deviation of the slope from nominal (some insoles run 4 % fast by design)."""
OTHER_RATE_TIME = 2.0
"""Time of arrivals after which a slope beyond MAX_DRIFT shows another rate, s; chosen by hand."""
MAX_SLEW, MAX_FAST_SLEW, LARGE_ERROR = 0.005, 0.02, 0.25
"""Largest relative slew, largest relative slew for a large error, and smallest large error (s)."""
SLEW_TIME = 2.0
"""Time constant with which a small error is corrected, s."""
MIN_INCREMENT = 1e-6
"""Smallest difference of two assigned times in a row, s."""
MAX_EARLY_ARRIVAL, EARLY_ARRIVAL_GROWTH = 0.5, 0.01
"""Largest time by which a packet may seem to arrive before it was measured, s, and its growth after the last window."""
SETTLED_ERROR, SETTLING_TIME = 0.005, 5.0
"""Largest distance of a settled clock's times from the line (s), and the time for which it must hold (device s)."""
JUMP_DELAY, STOPPED_DELAY, STOPPED_DURATION = 30.0, 1.0, 20.0
"""Delay that shows that the clock jumped, and delay and duration that show that the clock stood still, s.

No device holds packets back for JUMP_DELAY; a phone whose app is in the background does. The clock stood still when
every packet of STOPPED_DURATION seconds came later than STOPPED_DELAY."""


@define
class Clock:
    """The fit of one device clock to packet arrivals.

    The caller unwraps the ticks. It calls `observe` once for each packet, then `assign_time` for each of the packet's
    samples in order. There is no latency. The error of a settled clock is 5 ms plus the constant part of the radio's
    delay, which the receiver cannot measure."""

    rate: float
    """Nominal ticks per second."""
    origin: float = 0.0
    """Arrival of the first packet, s; residuals are relative to it, so that they keep all their digits."""
    first_tick: float = 0.0
    """Ticks of the first packet."""
    windows: list[tuple[float, float]] = field(factory=list)
    """Earliest arrival of each window: its device seconds since the first packet, and arrival minus device time, s."""
    window_length: float = FIRST_WINDOW_LENGTH
    """Length of a window now, device seconds."""
    window_start: float = 0.0
    """Device second at which the newest window starts."""
    drift: float = 0.0
    """Slope of the line minus 1; positive when the device's clock is slow."""
    offset: float = 0.0
    """Height of the line at the first packet, relative to `origin`, s."""
    other_slope: float = 0.0
    """Slope of the line minus 1 where it is surely beyond MAX_DRIFT, so that the rate is another one; else 0."""
    behind_since: float | None = None
    """Arrival since which every packet came later than STOPPED_DELAY, s; None if the newest one did not."""
    last_device_time: float | None = None
    """Newest sample that was assigned a time, device seconds since the first packet."""
    last_t: float = 0.0
    """Newest assigned time, s."""
    last_off_line_time: float = 0.0
    """Newest sample whose time was further than SETTLED_ERROR from the line, or the first sample, device seconds."""
    unsettled_until: float | None = None
    """Newest time assigned while the clock was unsettled, s; times up to it are not comparable with other clocks."""
    max_drift: float = MAX_DRIFT
    """Largest relative deviation of the slope from nominal."""
    t_min: float | None = None
    """Lower bound of the first assigned time, s; it keeps times in order when a fit follows another one."""

    def fit_time(self, ticks: float) -> float:
        """Return the time of `ticks` on the fitted line, s, without slewing; a later packet may change it."""
        return self.origin + self.offset + (ticks - self.first_tick) / self.rate * (1.0 + self.drift)

    def contradicts(self, ticks: float, arrival: float, held_back: bool = False) -> bool:
        """Return whether a packet measured at `ticks` that arrived at `arrival` (s) belongs to another clock.

        `held_back`: the device's counters go on without a break, so the receiver may have held the packet back."""
        if not self.windows:
            return False
        x = (ticks - self.first_tick) / self.rate
        delay = arrival - (self.origin + self.offset + x * (1.0 + self.drift))
        if delay < 0.0:
            return delay < -(MAX_EARLY_ARRIVAL + EARLY_ARRIVAL_GROWTH * max(0.0, x - self.windows[-1][0]))
        has_jumped = delay > JUMP_DELAY and not held_back
        behind_since = arrival if self.behind_since is None else self.behind_since
        return has_jumped or (delay > STOPPED_DELAY and arrival - behind_since > STOPPED_DURATION)

    def observe(self, ticks: float, arrival: float) -> None:
        """Update the fit with a packet whose last sample was measured at `ticks` and that arrived at `arrival` (s)."""
        if not self.windows:
            self.origin, self.first_tick = arrival, float(ticks)  # saved as a float; a 64-bit count would be rounded
            self.windows = [(0.0, 0.0)]
            return
        x = (ticks - self.first_tick) / self.rate
        r = arrival - self.origin - x
        height = r - self.offset - self.drift * x
        if height <= STOPPED_DELAY:
            self.behind_since = None
        elif self.behind_since is None:
            self.behind_since = arrival
        if x >= self.window_start + self.window_length:
            self.window_start = x
            self.windows.append((x, r))
            if len(self.windows) > MAX_WINDOWS:
                self._merge_windows()
            self._fit()
            return
        lowest_x, lowest_r = self.windows[-1]
        if height < lowest_r - self.offset - self.drift * lowest_x:
            self.windows[-1] = (x, r)
            if height < 0.0:
                self._fit()

    def assign_time(self, ticks: float, arrival: float = inf) -> float:
        """Return the time of a sample measured at `ticks`, s; call it once per sample, in order of ticks.

        It is not later than MAX_EARLY_ARRIVAL after `arrival`, s, however fast the ticks go."""
        x = (ticks - self.first_tick) / self.rate
        fitted = self.origin + self.offset + x * (1.0 + self.drift)
        if self.last_device_time is None:
            t = fitted if self.t_min is None else max(fitted, self.t_min)
            self.last_off_line_time = x
        else:
            dx = x - self.last_device_time
            t_unslewed = self.last_t + dx * (1.0 + self.drift)
            error = fitted - t_unslewed
            max_slew = dx * (MAX_SLEW if -LARGE_ERROR < error < LARGE_ERROR else MAX_FAST_SLEW)
            slew = error * (dx / SLEW_TIME) if dx < SLEW_TIME else error
            t = min(t_unslewed + max(-max_slew, min(max_slew, slew)), arrival + MAX_EARLY_ARRIVAL)
            if t <= self.last_t:  # the difference is below float resolution, or the ticks stand still
                t = self.last_t + MIN_INCREMENT
            if not -SETTLED_ERROR <= fitted - t <= SETTLED_ERROR:
                self.last_off_line_time = x
        if x - self.last_off_line_time < SETTLING_TIME:
            self.unsettled_until = t
        self.last_device_time, self.last_t = x, t
        return t

    def preview_time(self, ticks: float) -> float:
        """Return the time that `assign_time(ticks)` would assign, s, without assigning it."""
        return copy(self).assign_time(ticks)

    def _merge_windows(self) -> None:
        """Merge the windows in pairs, or drop the oldest window when windows have their largest length."""
        if self.window_length >= LAST_WINDOW_LENGTH:
            del self.windows[0]
            return
        self.window_length *= 2.0
        lowest = []
        for i in range(0, len(self.windows), 2):
            lowest.append(min(self.windows[i : i + 2], key=lambda point: point[1] - self.drift * point[0]))
        self.windows = lowest

    def _fit(self) -> None:
        """Fit the edge of the points' lower convex hull that spans their mean time."""
        points = self.windows
        hull: list[tuple[float, float]] = []
        for point in points:
            x, r = point
            while len(hull) >= 2:
                (x_a, r_a), (x_b, r_b) = hull[-2:]
                if (r_b - r_a) * (x - x_a) < (r - r_a) * (x_b - x_a):
                    break
                hull.pop()
            hull.append(point)
        middle, slope = fsum([x for x, _ in points]) / len(points), 0.0
        for (x_a, r_a), (x_b, r_b) in pairwise(hull):
            if x_b >= middle:
                slope = (r_b - r_a) / (x_b - x_a)
                break
        drift, self.other_slope = max(-self.max_drift, min(self.max_drift, slope)), 0.0
        # The uncertainty of the slope is four times the points' mean height above the line, divided by the span of
        # their times. Few points always lie close to a line, so `spare_points` enlarge it. A drift below its
        # uncertainty is reduced towards 0; a drift of 4 % is followed within about two seconds.
        spare_points, share = len(points) - 4, 0.0
        if spare_points > 0 and drift != 0.0:
            heights, span = [r - slope * x for x, r in points], points[-1][0] - points[0][0]
            error = 4.0 * (fsum(heights) / len(heights) - min(heights)) / span * (1.0 + 8.0 / spare_points)
            share = drift * drift / (drift * drift + error * error)
            if abs(slope) - error > MAX_DRIFT and span * (1.0 + slope) > OTHER_RATE_TIME:
                self.other_slope = slope
        drift *= share
        self.drift, self.offset = drift, min([r - drift * x for x, r in points])
