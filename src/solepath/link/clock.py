"""Device ticks to host seconds: a line under the arrivals.

A packet arrives at `offset + slope * ticks + delay`, and radio delay is only ever positive. So the line that fits is
not the one through the middle of the arrivals but the highest one that stays below all of them: of all lines under
the points the one with the least sum of distances, which is the edge of the lower convex hull above the points' mean
(S. Moon, P. Skelly, D. Towsley, "Estimation and removal of clock skew from network delay measurements", 1999).

Memory is bounded: of each window of device time only the earliest arrival is kept, at most 32 of them; when there
are more the windows pair up, until a window is 16 s, and from then on the oldest is forgotten.

Times are assigned once and never revised. They follow the line by slewing, so that the time between two neighbouring
samples stays true within 0.5 % (the cost: a first packet that came 50 ms late is made good over 10 s), unless the
error is above 0.25 s, when up to 2 % is allowed. They strictly increase.

Two clocks can only be compared once both are settled: a fit that began with a late packet, as at the start of a stream
and after a device began anew, is behind until that is slewed away. A clock is settled when its times have been within
5 ms of the line for 5 s of device time. Over radios of up to 50 ms of jitter, or connection intervals up to 50 ms, two
settled clocks of 100 packets a second then agree within 5 ms. Nobody at this end can see what keeps *every* packet of
one device late: where packets are nearly as far apart as the radio's connection events, that is up to one interval,
until the two have drifted past one another.
"""

from __future__ import annotations

from copy import copy

from ..types.attrs import define, field

FIRST_WINDOW = 0.25
"""Device seconds of which only the earliest arrival is kept, while the fit is young."""
LAST_WINDOW = 16.0
"""The same once it is old: 32 of them are about eight minutes, short beside a change of temperature."""
MAX_WINDOWS = 32
MAX_DRIFT = 0.06
"""A slope further from nominal than this is not believed (some insoles run 4 % fast by design)."""
MAX_SLEW, MAX_SLEW_FAR, FAR_OFF = 0.005, 0.02, 0.25
"""Largest relative slew; the same when the error (s) is above FAR."""
SLEW_TIME = 2.0
"""Time constant in s with which a small error is slewed away."""
MAX_AHEAD = 0.5
"""A packet cannot arrive before it was measured; the fit may be wrong by this many s, not more."""
SETTLED_ERROR, SETTLED_FOR = 0.005, 5.0
"""s that the times of a settled clock are from the line at the most, and device seconds for which they have been."""
JUMP_DELAY, STOPPED_DELAY, STOPPED_FOR = 30.0, 1.0, 20.0
"""A delay (s) that no device buffers; and one that, kept up for so long (s), is a clock that stood still."""


@define
class Clock:
    """Fits one device clock to arrivals. `rate` is the nominal ticks per second; ticks must be unwrapped by the caller.

    After `observe(ticks, arrival)` for a packet, `time(ticks)` assigns the time of each of its samples in order.
    Latency none; error 5 ms after the time it takes to slew the first packet's delay away, plus the constant part of
    the radio's delay, which nobody can see from one end.
    """

    rate: float
    origin: float = 0.0
    """Arrival of the first packet, s; residuals are taken from here to keep numbers small."""
    first_tick: float = 0.0
    xs: list[float] = field(factory=list)
    """Device seconds since the first packet of each window's earliest arrival."""
    rs: list[float] = field(factory=list)
    """Arrival minus device seconds of the same points, s."""
    window: float = FIRST_WINDOW
    window_start: float = 0.0
    """Device second at which the newest window began."""
    drift: float = 0.0
    """Slope of the line minus 1."""
    offset: float = 0.0
    """Height of the line at x = 0, s."""
    behind_since: float | None = None
    """Arrival since which every packet was more than BEHIND late."""
    last_x: float | None = None
    """Device seconds of the newest time assigned."""
    last_t: float = 0.0
    """The newest time assigned, s."""
    last_off_line: float = 0.0
    """Device seconds of the newest time that was further than WITHIN from the line, or the first."""
    unsettled_until: float | None = None
    """The newest time assigned while the clock was not settled, s; until then it is not to be compared with others."""
    t_min: float | None = None
    """The first time assigned is not before this: a fit that follows another keeps the order of times."""

    def fit_time(self, ticks: float) -> float:
        """Where the line puts `ticks`, s: unslewed, may still change."""
        x = (ticks - self.first_tick) / self.rate
        return self.origin + self.offset + x * (1.0 + self.drift)

    def contradicts(self, ticks: float, arrival: float) -> bool:
        """Whether a packet measured at `ticks` that arrived at `arrival` must be of another clock. Changes nothing."""
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
        """Learn from a packet whose newest sample was measured at `ticks` and that arrived at `arrival` (s)."""
        if not self.xs:
            self.origin, self.first_tick = arrival, float(ticks)  # as it is saved: a count may have 64 bits
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
        """The time of a sample measured at `ticks`, s; call once per sample, in order of ticks."""
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
        """What `time(ticks)` would assign. Changes nothing."""
        return copy(self).assign_time(ticks)

    def _thin(self) -> None:
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
        xs, rs = self.xs, self.rs
        span = xs[-1] - xs[0]
        drift = max(-MAX_DRIFT, min(MAX_DRIFT, _support_slope(xs, rs)))
        heights = [r - drift * x for x, r in zip(xs, rs, strict=True)]
        # How far the slope can be trusted: the minima's mean height over the line, tilted across the span; few points
        # lie close to any line, hence `free`. A drift no larger than its doubt stays near nominal, a device 4 % off
        # is believed within about two seconds.
        free = len(xs) - 4
        drift_error = (
            4.0 * (sum(heights) / len(heights) - min(heights)) / span * (1.0 + 8.0 / free) if free > 0 else 0.0
        )
        drift *= (
            drift * drift / (drift * drift + drift_error * drift_error) if free > 0 and drift != 0.0 else 0.0
        )
        heights = [r - drift * x for x, r in zip(xs, rs, strict=True)]
        self.drift, self.offset = drift, min(heights)


def _support_slope(xs: list[float], rs: list[float]) -> float:
    """Slope of the edge of the points' lower convex hull above their mean x. xs must increase."""
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
