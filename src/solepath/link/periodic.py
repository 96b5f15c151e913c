"""Times of a stream without counters: the period to which each notification belongs.

SensorTags send neither sequence nor ticks. Their notifications are the slots of a period that the host wrote or that
the profile names. The slot number takes the place of ticks on the lower envelope (clock.py). A gap in the arrivals
means lost packets or late ones; the packets do not show which. The rules are:

- A gap of 1.5 periods or more means lost packets at once when the packet after it is later than its slot by 0.9
  periods or more (and five times the usual jitter).
- Otherwise packets were only late, unless eight in a row stay 0.9 periods behind: then the loss is reported at the
  eighth.
- A packet that comes half a period too early shows that a reported loss was none; its slot is not counted.

A radio may hold back anything for some connection events. With periods shorter than that, a gap is no evidence; only
packets that stay behind by as much, and for a third of a second, are a sign of loss. A smaller loss cannot be
distinguished from lateness, and the fit corrects it.

A period that was never written is estimated from the arrivals: they are clearly faster than the period, or there are
six gaps in a row."""

from __future__ import annotations

from math import floor

from ..types.attrs import define
from .clock import Clock
from .counters import SampleTimes

LOSS_GAP = 1.5
"""Periods between two arrivals, from which on a loss is possible."""
LATE_PERIODS = 0.9
"""Periods behind its slot, from which on a packet may belong to a later slot."""
LATE_JITTERS = 5.0
"""Mean jitters behind its slot, from which on a packet may belong to a later slot."""
REVISABLE_PACKETS = 12
"""Number of packets after a loss that may still show that there was none."""
MAX_AHEAD = 0.15
"""Seconds (and one period) by which an assigned time may be after the arrival."""
SETTLED_PACKETS = 40
"""Number of packets until the fit is good enough to judge lateness; before, only gaps count."""
SLIPPED_PACKETS, SLIPPED_FOR = 8, 0.32
"""Number of packets in a row, and s, that must stay behind before a slip is a loss."""
RADIO_DELAY = 0.04
"""Delay that a radio may cause at any time, s; with a shorter period a gap alone is no sign of loss."""
FAST_LEAD = 0.24
"""Seconds that arrivals must be ahead before the period is taken to be shorter (radio jitter is less)."""
WIDE_GAPS = 6
"""Number of gaps in a row before the period is taken to be longer."""
NEW_PHASE_SILENCE = 5.0
"""Silence after which the device may measure at a new phase, s; slots are then counted from the next packet."""


@define
class PeriodicClock:
    """The clock of a periodic characteristic, which has no counters.

    Times are assigned in order and never revised. Latency none."""

    period: float
    """Period in s, as written to the device or from its profile."""
    clock: Clock
    """Clock whose ticks are slots."""
    slot: float = 0.0
    """Slot of the newest packet."""
    arrived: float | None = None
    """Arrival of the newest packet, s; None before the first and after a change of period."""
    jitter: float = 0.0
    """Running mean of the packets' lateness, s."""
    slipped: int = 0
    """Number of packets in a row that were a period behind their slot."""
    slip: float = 0.0
    """Least delay of those packets behind their slots, s."""
    jitter_before_slip: float = 0.0
    """Jitter before the first of those packets, s."""
    revisable: int = 0
    """Number of packets for which the latest loss may still turn out to be none."""
    settled_packets: int = 0
    """Number of packets since the fit started, up to SETTLED_PACKETS."""
    rate_since: float = 0.0
    """Arrival from which the rate is estimated, s."""
    rate_count: int = 0
    """Number of packets since `rate_since`."""
    wide_gaps: int = 0
    """Number of gaps in a row."""
    wide_gaps_since: float = 0.0
    """Arrival before the first gap in the row, s."""

    def add_packet(self, arrival: float, counts_losses: bool = True) -> SampleTimes:
        """Assign a time to the notification that arrived at `arrival` (s, not before the previous one).

        With `counts_losses` False silence is legal (wake on motion) and is no evidence of losses."""
        if self.arrived is None:
            return self._restart(arrival, 0, arrival)
        gap = arrival - self.arrived
        period = self.period * (1.0 + self.clock.drift)
        t_missing = self.clock.preview_time(self.slot + 1.0)
        if gap > NEW_PHASE_SILENCE or (not counts_losses and gap > LOSS_GAP * period):
            lost = max(1, round(gap / period) - 1) if counts_losses else 0
            self.period = period
            return self._restart(arrival, lost, t_missing)
        if self._correct_period(arrival, gap):
            return self._restart(arrival, 0, t_missing)
        self.arrived = arrival
        behind = arrival - self.clock.fit_time(self.slot + 1.0)
        settled = self.settled_packets >= SETTLED_PACKETS
        if behind < -0.5 * period and (settled or self.revisable) or arrival - t_missing < -(MAX_AHEAD + period):
            self.revisable = self.slipped = 0
            return SampleTimes([self.clock.assign_time(self.slot + 0.25)])
        lost = self._count_lost(gap, behind, period)
        self.slot += 1.0 + lost
        self.settled_packets = min(self.settled_packets + 1, SETTLED_PACKETS)
        self.revisable = REVISABLE_PACKETS if lost else max(0, self.revisable - 1)
        if lost == 0 and (
            not self.revisable or behind >= (0.0 if settled else -0.3 * period)
        ):  # the fit does not use a slot that may be a wrong guess
            self.clock.observe(self.slot, arrival)
            if settled:
                late = max(0.0, min(4.0 * period, arrival - self.clock.fit_time(self.slot)))
                self.jitter += (late - self.jitter) / 16.0
        return SampleTimes([self.clock.assign_time(self.slot)], lost, t_missing)

    def set_period(self, period: float) -> None:
        """Set another period (s), which was written to the device; slots are counted from the next packet."""
        arrived = self.arrived
        self.period, self.arrived = period, None
        if arrived is None:
            self.clock = Clock(1.0 / period)

    def _count_lost(self, gap: float, behind: float, period: float) -> int:
        """Return the number of packets lost before this one."""
        gap_is_evidence = period >= RADIO_DELAY
        if self.settled_packets < SETTLED_PACKETS:  # lateness may still be a slow device; only the gap is evidence
            return (
                round(gap / period) - 1
                if gap_is_evidence and gap >= LOSS_GAP * period and behind >= 0.75 * period
                else 0
            )
        if (
            gap_is_evidence
            and gap >= LOSS_GAP * period
            and behind >= LATE_PERIODS * period
            and behind >= LATE_JITTERS * self.jitter
        ):
            self.slipped = 0
            return floor(behind / period + 1.0 - LATE_PERIODS)
        if behind < (LATE_PERIODS * period if gap_is_evidence else RADIO_DELAY):
            self.slipped = 0
            return 0
        if self.slipped == 0:
            self.slip, self.jitter_before_slip = behind, self.jitter
        self.slip = min(self.slip, behind)
        self.slipped += 1
        if self.slipped < max(SLIPPED_PACKETS, SLIPPED_FOR / period):
            return 0
        self.slipped, self.jitter = 0, self.jitter_before_slip
        return floor(self.slip / period + 1.0 - LATE_PERIODS)

    def _correct_period(self, arrival: float, gap: float) -> bool:
        """Correct the period if it is wrong, and return whether it was."""
        self.rate_count += 1
        expected, found = self.rate_count * self.period, arrival - self.rate_since
        if found < 0.6 * expected and expected - found > FAST_LEAD:
            self.period = max(0.01, round(found / self.rate_count, 2))
            return True
        if self.rate_count >= 50:  # a short memory, or a quick start would be averaged away
            self.rate_since, self.rate_count = arrival, 0
        if gap < 1.4 * self.period:
            self.wide_gaps = 0
            return False
        if self.wide_gaps == 0:
            self.wide_gaps_since = arrival - gap
        self.wide_gaps += 1
        if self.wide_gaps < WIDE_GAPS:
            return False
        self.period = round((arrival - self.wide_gaps_since) / self.wide_gaps, 2)
        return True

    def _restart(self, arrival: float, lost: int, t_missing: float) -> SampleTimes:
        """Count slots from here, in a new fit whose times come after those of the old one."""
        t_min = None if self.clock.last_x is None else self.clock.last_t + 0.5 * self.period
        self.clock = Clock(1.0 / self.period, t_min=t_min)
        self.clock.observe(0.0, arrival)
        self.slot, self.arrived = 0.0, arrival
        self.slipped = self.revisable = self.settled_packets = self.rate_count = self.wide_gaps = 0
        self.rate_since = arrival
        return SampleTimes([self.clock.assign_time(0.0)], lost, t_missing)


def make_periodic_clock(period: float) -> PeriodicClock:
    """Return a fresh clock with this nominal period, s."""
    return PeriodicClock(period, Clock(1.0 / period))
