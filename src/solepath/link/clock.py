"""Conversion of device ticks to host seconds, with a line fitted below the packet arrivals.

A packet arrives at `offset + slope * ticks + delay`, and radio delay is only ever positive. Therefore the fitted line
does not pass through the middle of the arrivals: it stays below all of them. Of all lines under the points, the fit is
the one with the least sum of distances. It is the edge of the lower convex hull above the points' mean (S. Moon, P.
Skelly, D. Towsley, "Estimation and removal of clock skew from network delay measurements", 1999).

Memory is bounded. The fit keeps only the earliest arrival of each window of device time, and at most 32 windows. When
there are more, windows are merged in pairs until a window is 16 s long; from then on the oldest window is dropped.

Times are assigned once and never revised. They follow the line by slewing, so that the time between two neighbouring
samples stays true within 0.5 % (the cost: a first packet that came 50 ms late is corrected over 10 s), unless the error
is above 0.25 s, when up to 2 % is allowed. Times strictly increase.

Two clocks are comparable only when both are settled. A fit that starts with a late packet, as at the start of a stream
or after a device restart, lags until slewing has removed the delay. A clock is settled when its times have been within
5 ms of the line for 5 s of device time. Over radios of up to 50 ms of jitter, or connection intervals up to 50 ms, two
settled clocks of 100 packets a second then agree within 5 ms. A delay that *every* packet of one device has cannot be
seen at the receiving end. Where packets are nearly as far apart as the radio's connection events, that delay is up to
one interval, until the two have drifted past one another."""

from __future__ import annotations

from copy import copy

from ..types.attrs import define, field

FIRST_WINDOW = 0.25
"""Length of a window while the fit is young, device seconds; only its earliest arrival is kept."""
LAST_WINDOW = 16.0
"""Length of a window once the fit is old, device seconds.

32 of them are about eight minutes, which is short beside a change of temperature."""
MAX_WINDOWS = 32
"""Number of windows that the fit keeps at most."""
MAX_DRIFT = 0.06
"""Largest deviation of the slope from nominal that the fit accepts (some insoles run 4 % fast by design)."""
MAX_SLEW, MAX_SLEW_FAR, FAR_OFF = 0.005, 0.02, 0.25
"""Largest relative slew, the largest slew far off the line, and the error (s) above which the latter holds."""
SLEW_TIME = 2.0
"""Time constant in s with which a small error is slewed away."""
MAX_AHEAD = 0.5
"""Time by which a packet may seem to arrive before it was measured, s.

A packet cannot arrive before it was measured, but the fit may be wrong by this much, not more."""
SETTLED_ERROR, SETTLED_FOR = 0.005, 5.0
"""Largest distance of a settled clock's times from the line, s, and device seconds for which it must hold."""
JUMP_DELAY, STOPPED_DELAY, STOPPED_FOR = 30.0, 1.0, 20.0
"""Delay (s) that no device buffers; and the delay and duration (s) that show a clock that stood still.

A packet later than JUMP_DELAY belongs to another clock. So does one when every packet for STOPPED_FOR seconds was later
than STOPPED_DELAY."""


@define
class Clock:
    """The fit of one device clock to packet arrivals.

    The caller unwraps the ticks. After `observe(ticks, arrival)` for a packet, `assign_time(ticks)` gives the time of
    each of its samples in order. Latency none. The error is 5 ms once the first packet's delay is slewed away, plus the
    constant part of the radio's delay, which cannot be seen from one end."""

    rate: float
    """Nominal ticks per second."""
    origin: float = 0.0
    """Arrival of the first packet, s; residuals are taken from here to keep numbers small."""
    first_tick: float = 0.0
    """Ticks of the first packet."""
    xs: list[float] = field(factory=list)
    """Time of each window's earliest arrival, device seconds since the first packet."""
    rs: list[float] = field(factory=list)
    """Residual of each window's earliest arrival: arrival minus device time, s."""
    window: float = FIRST_WINDOW
    """Present length of a window, device seconds."""
    window_start: float = 0.0
    """Device second at which the newest window starts."""
    drift: float = 0.0
    """Slope of the line minus 1."""
    offset: float = 0.0
    """Height of the line at x = 0, s."""
    behind_since: float | None = None
    """Arrival since which every packet was more than STOPPED_DELAY late, s; None when the newest was not."""
    last_x: float | None = None
    """Device seconds of the newest time assigned."""
    last_t: float = 0.0
    """The newest time assigned, s."""
    last_off_line: float = 0.0
    """Device seconds of the newest time that was further than SETTLED_ERROR from the line, or of the first time."""
    unsettled_until: float | None = None
    """Newest time assigned while the clock was unsettled, s; times up to it are not comparable with other clocks."""
    t_min: float | None = None
    """Lower bound of the first time assigned, s; a fit that follows another keeps the order of times."""

    def fit_time(self, ticks: float) -> float:
        """Return the time of `ticks` on the fitted line, s; it is not slewed and may still change."""
        x = (ticks - self.first_tick) / self.rate
        return self.origin + self.offset + x * (1.0 + self.drift)

    def contradicts(self, ticks: float, arrival: float) -> bool:
        """Return whether a packet measured at `ticks` that arrived at `arrival` (s) belongs to another clock.

        Changes nothing."""
        if not self.xs:
            return False
        x = (ticks - self.first_tick) / self.rate
        delay = arrival - (self.origin + self.offset + x * (1.0 + self.drift))
        if delay < 0.0:
            return delay < -(MAX_AHEAD + 0.01 * max(0.0, x - self.xs[-1]))
        if delay > JUMP_DELAY:
            return True
        return delay > STOPPED_DELAY and self.behind_since is not None and arrival - self.behind_since > STOPPED_FOR

    def observe(self, ticks: float, arrival: float) -> None:
        """Update the fit with a packet whose newest sample is of `ticks` and that arrived at `arrival` (s)."""
        if not self.xs:
            self.origin, self.first_tick = arrival, float(ticks)  # a float, as it is saved: a count may have 64 bits
            self.xs, self.rs = [0.0], [0.0]
            return
        x = (ticks - self.first_tick) / self.rate
        r = arrival - self.origin - x
        above = r - self.offset - self.drift * x
        if above > STOPPED_DELAY:
            if self.behind_since is None:
                self.behind_since = arrival
        else:
            self.behind_since = None
        if x >= self.window_start + self.window:
            self.window_start = x
            self.xs.append(x)
            self.rs.append(r)
            if len(self.xs) > MAX_WINDOWS:
                self._thin()
            self._fit()
        elif above < self.rs[-1] - self.offset - self.drift * self.xs[-1]:
            self.xs[-1], self.rs[-1] = x, r
            if above < 0.0:
                self._fit()

    def assign_time(self, ticks: float) -> float:
        """Return the time of a sample measured at `ticks`, s; call it once per sample, in order of ticks."""
        x = (ticks - self.first_tick) / self.rate
        fitted = self.origin + self.offset + x * (1.0 + self.drift)
        if self.last_x is None:
            t = fitted if self.t_min is None else max(fitted, self.t_min)
        else:
            dx = x - self.last_x
            t_unslewed = self.last_t + dx * (1.0 + self.drift)
            error = fitted - t_unslewed
            limit = dx * (MAX_SLEW if -FAR_OFF < error < FAR_OFF else MAX_SLEW_FAR)
            slew = error * (dx / SLEW_TIME) if dx < SLEW_TIME else error
            t = t_unslewed + max(-limit, min(limit, slew))
            if t <= self.last_t:  # below float resolution, or ticks that stand still
                t = self.last_t + 1e-6
        if self.last_x is None or not -SETTLED_ERROR <= fitted - t <= SETTLED_ERROR:
            self.last_off_line = x
        if x - self.last_off_line < SETTLED_FOR:
            self.unsettled_until = t
        self.last_x, self.last_t = x, t
        return t

    def preview_time(self, ticks: float) -> float:
        """Return the time that `assign_time(ticks)` would assign, s. Changes nothing."""
        return copy(self).assign_time(ticks)

    def _thin(self) -> None:
        """Merge the windows in pairs, or drop the oldest when windows have their last length."""
        if self.window >= LAST_WINDOW:
            del self.xs[0], self.rs[0]
            return
        self.window *= 2.0
        heights = [r - self.drift * x for x, r in zip(self.xs, self.rs, strict=True)]
        lower = [i if heights[i] <= heights[i + 1] else i + 1 for i in range(0, len(heights) - 1, 2)]
        if len(heights) % 2:
            lower.append(len(heights) - 1)
        self.xs = [self.xs[i] for i in lower]
        self.rs = [self.rs[i] for i in lower]

    def _fit(self) -> None:
        """Fit the line to the windows' earliest arrivals."""
        xs, rs = self.xs, self.rs
        span = xs[-1] - xs[0]
        drift = max(-MAX_DRIFT, min(MAX_DRIFT, _support_slope(xs, rs)))
        heights = [r - drift * x for x, r in zip(xs, rs, strict=True)]
        # Uncertainty of the slope: the minima's mean height over the line, tilted across the span. Few points lie
        # close to any line, hence `free`. A drift no larger than its uncertainty stays near nominal; a device that is
        # 4 % off is followed within about two seconds.
        free = len(xs) - 4
        drift_error = (
            4.0 * (sum(heights) / len(heights) - min(heights)) / span * (1.0 + 8.0 / free) if free > 0 else 0.0
        )
        drift *= drift * drift / (drift * drift + drift_error * drift_error) if free > 0 and drift != 0.0 else 0.0
        heights = [r - drift * x for x, r in zip(xs, rs, strict=True)]
        self.drift, self.offset = drift, min(heights)


def _support_slope(xs: list[float], rs: list[float]) -> float:
    """Return the slope of the edge of the points' lower convex hull above their mean x. xs must increase."""
    hull: list[int] = []
    for i, (x, r) in enumerate(zip(xs, rs, strict=True)):
        while len(hull) >= 2:
            a, b = hull[-2], hull[-1]
            if (rs[b] - rs[a]) * (x - xs[a]) < (r - rs[a]) * (xs[b] - xs[a]):
                break
            hull.pop()
        hull.append(i)
    middle = sum(xs) / len(xs)
    for a, b in zip(hull, hull[1:], strict=False):
        if xs[b] >= middle:
            return (rs[b] - rs[a]) / (xs[b] - xs[a])
    return 0.0
