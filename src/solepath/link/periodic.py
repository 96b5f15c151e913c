"""Times of a stream whose notifications have no counters, from a fixed period.

SensorTags send neither sequence numbers nor ticks. They measure once a period, which the host wrote or the profile
names. Time is counted in slots of one period; each notification belongs to one slot. Slot numbers replace ticks in the
fit (clock.py). After a gap in the arrivals, packets were lost or are late, and a packet does not show which. The rules
and their numbers are those of protocol/clock.md, "Devices without counters":

- A gap of at least 1.5 periods is a loss at once when the next packet is behind its slot by at least 0.9 periods and
  by at least five times the mean lateness.
- Otherwise the packets are late. But if eight packets in a row are 0.9 periods behind, the eighth reports a loss.
- A packet that is half a period too early shows that a reported loss was wrong; it does not take a new slot.

A radio may hold packets back for some connection events, up to 40 ms. If the period is shorter, a gap does not show a
loss: only packets that stay at least two periods, or 40 ms, behind for 0.32 s do. If connection events are a whole
number of periods apart, a clock that drifts past them moves all packets by one period, so one period is no evidence. A
loss of one packet that does not add up to two looks like lateness, and the fit corrects it. Times cannot show a loss
that is always the same: a stream without one packet of 200 is that of a clock that is 0.5 % slow.

A period that was not recorded is estimated from the arrivals, when these are clearly faster than the assumed period or
have six wide gaps in a row."""

from __future__ import annotations

from math import floor

from ..types.attrs import define, field
from .clock import Clock
from .counters import MIN_GAP, SampleTimes

MIN_LATE_PERIODS, MIN_UNSETTLED_LATE_PERIODS = 0.9, 0.75
"""Smallest delay behind its slot at which a packet may belong to a later slot, periods: of a settled and a new fit."""
MIN_LATE_JITTERS = 5.0
"""Smallest delay behind its slot at which a packet may belong to a later slot, in units of the mean lateness."""
MIN_EARLY_PERIODS, EARLY_SLOT = 0.5, 0.25
"""Smallest lead of a packet that shows that none was lost, and distance of its time from the last slot, periods."""
MAX_EARLY_ARRIVAL = 0.15
"""Largest time by which an assigned time may be after the arrival, s; one period is added."""
REVISABLE_PACKETS = 12
"""Number of packets after a reported loss that may still show that no packet was lost."""
SETTLED_PACKETS = 40
"""Number of packets after which the fit is good enough to measure lateness; until then only gaps show a loss."""
SLIPPED_PACKETS, SLIPPED_DURATION = 8, 0.32
"""Number of packets in a row, and duration (s), that must be behind their slots to show a loss without a gap."""
MAX_RADIO_DELAY, SLIPPED_PERIODS = 0.04, 2.0
"""Largest delay that a radio may cause at any time, s; if the period is shorter, a gap does not show a loss.

Then packets that stay behind by this delay do, or by so many periods, if that is less."""
MIN_FAST_LEAD, MAX_FAST_SHARE = 0.24, 0.6
"""Smallest lead of arrivals, s (above radio jitter), and largest share of expected time, that show a shorter period."""
WIDE_GAP_PERIODS, MIN_WIDE_GAPS = 1.4, 6
"""Smallest gap that is wide, periods, and number of wide gaps in a row that shows a longer period."""


@define
class PeriodicClock:
    """The clock of a stream without counters; it assigns times in order, without latency, and never revises them."""

    period: float
    """Period in s, as written to the device or from its profile."""
    clock: Clock = field(factory=lambda: Clock(1.0))
    """Fit of slot numbers to arrivals, which starts with the first packet."""
    slot: float = 0.0
    """Slot number of the newest packet."""
    newest_arrival: float | None = None
    """Arrival of the newest packet, s; None before the first, and after a change of period or a new connection."""
    jitter: float = 0.0
    """Running mean of the packets' lateness, s."""
    slipped_packets: int = 0
    """Number of packets in a row that were behind their slots."""
    slip_delay: float = 0.0
    """Least delay of those packets behind their slots, s."""
    jitter_before_slip: float = 0.0
    """Value of `jitter` before the first of those packets, s."""
    revisable_packets: int = 0
    """Number of further packets that may show that no packet was lost when a loss was last reported."""
    settled_packets: int = 0
    """Number of packets since the fit started, up to SETTLED_PACKETS."""
    rate_start: float = 0.0
    """Arrival at which the present estimate of the period started, s."""
    rate_packets: int = 0
    """Number of packets since `rate_start`."""
    wide_gaps: int = 0
    """Number of wide gaps in a row."""
    wide_gaps_start: float = 0.0
    """Arrival before the first of those gaps, s."""

    def add_packet(self, arrival: float, longest_loss: float) -> SampleTimes:
        """Return the time of the notification that arrived at `arrival` (s, not before the previous one).

        After a silence that is longer than `longest_loss`, s, the slots restart, because the device may have restarted
        its timer: it was absent. The limit is 0 while the device may be silent (wake on motion)."""
        if self.newest_arrival is None:
            return self._restart(arrival)
        gap = arrival - self.newest_arrival
        period = self.period * (1.0 + self.clock.drift)
        last_t = self.clock.last_t
        if gap > max(longest_loss, MIN_GAP * period):
            self.period = period
            return self._restart(arrival)
        if self._correct_period(arrival, gap):
            return self._restart(arrival)
        self.newest_arrival = arrival
        delay = arrival - self.clock.fit_time(self.slot + 1.0)
        settled = self.settled_packets >= SETTLED_PACKETS
        if (
            delay < -MIN_EARLY_PERIODS * period
            and (settled or self.revisable_packets)
            or arrival - self.clock.preview_time(self.slot + 1.0) < -(MAX_EARLY_ARRIVAL + period)
        ):
            self.revisable_packets = self.slipped_packets = 0
            return SampleTimes([self.clock.assign_time(self.slot + EARLY_SLOT)])
        lost_count = self._count_lost(gap, delay, period)
        self.slot += 1.0 + lost_count
        self.settled_packets = min(self.settled_packets + 1, SETTLED_PACKETS)
        self.revisable_packets = REVISABLE_PACKETS if lost_count else max(0, self.revisable_packets - 1)
        may_be_wrong = self.slipped_packets or (self.revisable_packets and delay < (0.0 if settled else -0.3 * period))
        if lost_count == 0 and not may_be_wrong:  # the fit does not use a slot that may be a wrong guess
            self.clock.observe(self.slot, arrival)
            if settled:
                late = max(0.0, min(4.0 * period, arrival - self.clock.fit_time(self.slot)))
                self.jitter += (late - self.jitter) / 16.0
        return SampleTimes([self.clock.assign_time(self.slot)], lost_count, last_t if lost_count else None)

    def set_period(self, period: float) -> None:
        """Set a period (s) that was written to the device; slots restart with the next packet, if it is another one."""
        if period != self.period:
            self.period, self.newest_arrival = period, None

    def _count_lost(self, gap: float, delay: float, period: float) -> int:
        """Return the number of packets lost before a packet that is `delay` s behind its slot, after `gap` s."""
        gap_is_evidence = period >= MAX_RADIO_DELAY
        shows_loss = gap_is_evidence and gap >= MIN_GAP * period
        if self.settled_packets < SETTLED_PACKETS:  # lateness may still be a slow device; only the gap is evidence
            return round(gap / period) - 1 if shows_loss and delay >= MIN_UNSETTLED_LATE_PERIODS * period else 0
        lost_count = floor(delay / period + 1.0 - MIN_LATE_PERIODS)
        is_late = delay >= MIN_LATE_PERIODS * period
        shows_loss = shows_loss and is_late and delay >= MIN_LATE_JITTERS * self.jitter
        if shows_loss or not (is_late if gap_is_evidence else delay >= min(MAX_RADIO_DELAY, SLIPPED_PERIODS * period)):
            self.slipped_packets = 0
            return lost_count if shows_loss else 0
        if self.slipped_packets == 0:
            self.slip_delay, self.jitter_before_slip = delay, self.jitter
        self.slip_delay = min(self.slip_delay, delay)
        self.slipped_packets += 1
        if self.slipped_packets < max(SLIPPED_PACKETS, SLIPPED_DURATION / period):
            return 0
        self.slipped_packets, self.jitter = 0, self.jitter_before_slip
        return floor(self.slip_delay / period + 1.0 - MIN_LATE_PERIODS)

    def _correct_period(self, arrival: float, gap: float) -> bool:
        self.rate_packets += 1
        expected_time, elapsed = self.rate_packets * self.period, arrival - self.rate_start
        if elapsed < MAX_FAST_SHARE * expected_time and expected_time - elapsed > MIN_FAST_LEAD:
            self.period = max(0.01, round(elapsed / self.rate_packets, 2))
            return True
        if self.rate_packets >= 50:  # a short memory, because older packets would hide a change of the period
            self.rate_start, self.rate_packets = arrival, 0
        if gap < WIDE_GAP_PERIODS * self.period:
            self.wide_gaps = 0
            return False
        if self.wide_gaps == 0:
            self.wide_gaps_start = arrival - gap
        self.wide_gaps += 1
        if self.wide_gaps < MIN_WIDE_GAPS:
            return False
        self.period = round((arrival - self.wide_gaps_start) / self.wide_gaps, 2)
        return True

    def _restart(self, arrival: float) -> SampleTimes:
        """Restart the slots with this packet, in a new fit whose times come after those of the old fit."""
        last_t = None if self.clock.last_device_time is None else self.clock.last_t
        self.clock = Clock(1.0 / self.period, t_min=None if last_t is None else last_t + 0.5 * self.period)
        self.clock.observe(0.0, arrival)
        self.slot, self.newest_arrival = 0.0, arrival
        self.slipped_packets = self.revisable_packets = self.settled_packets = self.rate_packets = self.wide_gaps = 0
        self.rate_start = arrival
        t = self.clock.assign_time(0.0)
        is_gap = last_t is not None and t - last_t > MIN_GAP * self.period
        return SampleTimes([t], gap_start=last_t if is_gap else None)
