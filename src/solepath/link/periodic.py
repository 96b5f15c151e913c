"""A stream without counters: which period each notification belongs to, and when that was.

SensorTags send neither sequence nor ticks. Their notifications are the slots of a period that the host wrote or that
the profile names; the slot number takes the place of ticks on the lower envelope (clock.py), and a hole in the arrivals
is lost packets or late ones. Nothing on the wire tells which, so:

- a hole of 1.5 periods or more that leaves a packet 0.9 periods or more (and five times the usual jitter) later than
  its slot is lost packets at once;
- otherwise packets were only late, unless eight in a row stay 0.9 periods behind: then the loss is said at the eighth;
- a packet that comes half a period too early says that a loss was none; its slot is not counted.

A radio may hold back anything for some connection events. So with periods shorter than that a hole says nothing; only
packets that stay behind by as much, and for a third of a second, are a sign of loss. A smaller loss cannot be told from
lateness, and the fit makes it good.

A period that was never written is found by itself: arrivals clearly faster than the period, or six holes in a row.
"""

from __future__ import annotations

from math import floor

from ..types.attrs import define
from .clock import Clock
from .counters import Taken

HOLE = 1.5
"""Periods between two arrivals, from which on a loss is possible."""
LATE = 0.9
"""Periods behind its slot, from which on a packet may be one of a later slot."""
QUIET = 5.0
"""The same in mean jitters."""
DOUBTFUL = 12
"""Packets after a loss that may still show that there was none."""
AHEAD = 0.15
"""Seconds (and one period) by which a time given out may be after the arrival."""
SETTLED = 40
"""Packets until the fit is good enough to judge lateness by; before, only holes count."""
SLIPPED, SLIPPED_FOR = 8, 0.32
"""Packets in a row that stay behind before a slip is a loss, and s for which they do."""
RADIO = 0.04
"""What a radio may hold back at any time, s; with a shorter period a hole is no sign of loss by itself."""
FAST = 0.24
"""Seconds that arrivals must be ahead before the period is taken to be shorter (radio jitter is less)."""
WIDE = 6
"""Holes in a row before the period is taken to be longer."""
NEW_PHASE = 5.0
"""Seconds of silence after which the device may have begun to measure anew: slots are counted from there."""


@define
class Periodic:
    """Times of a periodic characteristic. `period`: s, as written to the device or from its profile.

    `arrive(a)` assigns the time of the notification that arrived at `a`, s; in order, never revised. Latency none.
    """

    period: float
    clock: Clock
    slot: float = 0.0
    """Slot of the newest packet."""
    arrived: float | None = None
    """Its arrival, s."""
    jitter: float = 0.0
    """Running mean of how late packets are, s."""
    slipped: int = 0
    """Packets in a row that were a period behind their slot."""
    slip: float = 0.0
    """The least that they were behind, s."""
    calm: float = 0.0
    """The jitter before them, s."""
    doubtful: int = 0
    """Packets for which the latest loss may still turn out to be none."""
    settled: int = 0
    """Packets since the fit began, up to SETTLED."""
    began: float = 0.0
    """Arrival from which the rate is watched, s."""
    count: int = 0
    """Packets since then."""
    wide: int = 0
    """Holes in a row."""
    wide_since: float = 0.0
    """Arrival before the first of them, s."""

    def arrive(self, arrival: float, counts_losses: bool = True) -> Taken:
        """The notification that arrived at `arrival` (s, not before the one before it).

        With `counts_losses` False silence is legal (wake on motion) and says nothing about losses.
        """
        if self.arrived is None:
            return self._begin(arrival, 0, arrival)
        hole = arrival - self.arrived
        period = self.period * (1.0 + self.clock.drift)
        t_missing = self.clock.expected(self.slot + 1.0)
        if hole > NEW_PHASE or (not counts_losses and hole > HOLE * period):
            lost = max(1, round(hole / period) - 1) if counts_losses else 0
            self.period = period
            return self._begin(arrival, lost, t_missing)
        if self._other_rate(arrival, hole):
            return self._begin(arrival, 0, t_missing)
        self.arrived = arrival
        behind = arrival - self.clock.fitted(self.slot + 1.0)
        settled = self.settled >= SETTLED
        if behind < -0.5 * period and (settled or self.doubtful) or arrival - t_missing < -(AHEAD + period):
            self.doubtful = self.slipped = 0
            return Taken([self.clock.time(self.slot + 0.25)])
        lost = self._lost(hole, behind, period)
        self.slot += 1.0 + lost
        self.settled = min(self.settled + 1, SETTLED)
        self.doubtful = DOUBTFUL if lost else max(0, self.doubtful - 1)
        if lost == 0 and (
            not self.doubtful or behind >= (0.0 if settled else -0.3 * period)
        ):  # a slot that may be a wrong guess teaches nothing
            self.clock.observe(self.slot, arrival)
            if settled:
                late = max(0.0, min(4.0 * period, arrival - self.clock.fitted(self.slot)))
                self.jitter += (late - self.jitter) / 16.0
        return Taken([self.clock.time(self.slot)], lost, t_missing)

    def change(self, period: float) -> None:
        """Another period (s) was written to the device; slots are counted anew from the next packet."""
        arrived = self.arrived
        self.period, self.arrived = period, None
        if arrived is None:
            self.clock = Clock(1.0 / period)

    def _lost(self, hole: float, behind: float, period: float) -> int:
        tells = period >= RADIO
        if self.settled < SETTLED:  # how far behind cannot be told from a slow device yet; the hole alone must do
            return round(hole / period) - 1 if tells and hole >= HOLE * period and behind >= 0.75 * period else 0
        if tells and hole >= HOLE * period and behind >= LATE * period and behind >= QUIET * self.jitter:
            self.slipped = 0
            return floor(behind / period + 1.0 - LATE)
        if behind < (LATE * period if tells else RADIO):
            self.slipped = 0
            return 0
        if self.slipped == 0:
            self.slip, self.calm = behind, self.jitter
        self.slip = min(self.slip, behind)
        self.slipped += 1
        if self.slipped < max(SLIPPED, SLIPPED_FOR / period):
            return 0
        self.slipped, self.jitter = 0, self.calm
        return floor(self.slip / period + 1.0 - LATE)

    def _other_rate(self, arrival: float, hole: float) -> bool:
        """Whether the period was wrong; then it is put right."""
        self.count += 1
        expected, found = self.count * self.period, arrival - self.began
        if found < 0.6 * expected and expected - found > FAST:
            self.period = max(0.01, round(found / self.count, 2))
            return True
        if self.count >= 50:  # a short memory, or a quick start would be averaged away
            self.began, self.count = arrival, 0
        if hole < 1.4 * self.period:
            self.wide = 0
            return False
        if self.wide == 0:
            self.wide_since = arrival - hole
        self.wide += 1
        if self.wide < WIDE:
            return False
        self.period = round((arrival - self.wide_since) / self.wide, 2)
        return True

    def _begin(self, arrival: float, lost: int, t_missing: float) -> Taken:
        """Count slots from here, in a new fit whose times come after those of the old one."""
        times_from = None if self.clock.last_x is None else self.clock.last_t + 0.5 * self.period
        self.clock = Clock(1.0 / self.period, floor=times_from)
        self.clock.observe(0.0, arrival)
        self.slot, self.arrived = 0.0, arrival
        self.slipped = self.doubtful = self.settled = self.count = self.wide = 0
        self.began = arrival
        return Taken([self.clock.time(0.0)], lost, t_missing)


def periodic(period: float) -> Periodic:
    """A fresh stream with this nominal period, s."""
    return Periodic(period, Clock(1.0 / period))
