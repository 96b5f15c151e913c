"""Times of a stream whose notifications have no counters: their rate is their count over time.

SensorTags, the Thingy:52 and most boards of one's own send neither sequence numbers nor ticks. They measure once a
period, which the host wrote or the profile names, and which may be wrong. Time is counted in slots of one period; each
notification belongs to one slot. Slot numbers replace ticks in the fit (clock.py). The rules and their numbers are
those of protocol/clock.md, "Devices without counters":

- The period is the time over the count, whatever was written: arrivals that get ahead of their slots, or fall behind
  them, by a quarter of a second more than a clock may, show another period. It is looked at again after 1 s and 3 s.
  Gaps that stand out from the others say nothing about it. A smaller difference shows in the line below the arrivals of
  those that come at their own pace, as for a device that counts. A loss of a constant share is another rate.
- A value that repeats the one before, far sooner than the period, is a copy of it, if values that are a period apart
  differ, or if its slot is still to come. A sensor at rest repeats its values, too.
- A gap of at least 1.5 periods is a loss at once when the gap before it was about a period, and when the packet is
  behind its slot by at least 0.9 periods and by at least five times the mean lateness.
- Otherwise the packets are late. But if eight packets in a row are 0.9 periods behind, the eighth reports a loss.
- A packet that is half a period too early shows that a reported loss was wrong; it does not take a new slot.

A radio may hold packets back for some connection events, up to 40 ms. If the period is shorter, a gap does not show a
loss: only packets that stay at least two periods, or 40 ms, behind for 0.32 s do, after 3 s, when the rate is known. In
bursts, they stay behind the packet before a gap that stood out, and do not fall behind further: those of a slower
device do. If connection events are a whole number of periods apart, a clock that drifts past them moves
all packets by one period, so one period is no evidence. A loss of one packet that does not add up to two looks like
lateness, and the fit corrects it."""

from __future__ import annotations

from binascii import crc32
from math import floor

from ..events import Defect, DefectFound, Limitation, Rejection
from ..types import Site
from ..types.attrs import define, field
from ..wire.error import WireError
from .clock import MAX_DRIFT, MIN_INCREMENT, Clock
from .counters import MAX_RADIO_DELAY, MIN_GAP, Backlog, SampleTimes

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
SLIPPED_PERIODS = 2.0
"""Number of periods by which packets that stay behind show a loss if the period is shorter than MAX_RADIO_DELAY.

A gap does not show it then. They also show it if they stay behind by MAX_RADIO_DELAY, if that is less."""
MAX_HELD_PERIOD = 2.0 * MAX_RADIO_DELAY
"""Largest period of a device whose packet after a silence may be the first that a phone held back, s.

That packet is placed right after the newest one. If the silence was an absence, it is wrong: one sample in ten a second
would be a large part of the steps that it shows."""
WRONG_PERIOD_TIME, WRONG_PERIOD_GAPS = 0.24, 2.5
"""Time by which arrivals get ahead of their slots or fall behind them when the period is wrong, s, above radio jitter;
for long gaps, in usual gaps."""
SUSPICIOUS_TIME = 0.08
"""Delay of arrivals behind their slots, without gaps that stand out, from which on it may be the period, s."""
LOOK_AGAIN = (1.0, 3.0)
"""Times since the fit began at which the period is compared with the time over the count, s: a burst of 60 ms is then 6
and 2 % of it. The first one only follows a correction. Until the last, a radio's delay shows no loss."""
LONG_GAP = 0.06
"""Usual gap above which those times are longer in proportion, s."""
WRONG_SHARE = 0.02
"""Smallest relative difference of the two that is corrected; the fit follows smaller ones (clock.py)."""
COPY_PERIODS = 0.25
"""Largest distance of a value that may be a copy of the one before, periods."""
MEMORY = 1.0 / 16.0
"""Weight of the newest packet in running means and the like."""
STEADY_SHARE = 0.25
"""Largest distance from whole periods by which the delay grows from one half of those packets to the other; in bursts,
largest growth, in lost times."""
STAND_OUT = 1.75
"""Smallest ratio of a gap to usual ones with which it stands out: lost bursts double it, and memory and jitter shorten
the usual one by a third."""
GAP_MEMORY = 1.0 / 16.0
"""Share of the usual gap that is forgotten with each gap of that length, and less with shorter ones, as in a burst.

With 1/8, fewer losses in bursts are found; with 1/24, a wrong rate is known later."""
MIN_REGULAR = 0.4
"""Share of gaps of about a period, above which packets come one by one, not in bursts.

An exponential jitter of half a period leaves 0.6 of them; bursts of a radio leave none."""
MAX_PERIOD_DRIFT = MIN_GAP - 1.0
"""Largest relative deviation from the period that the fit follows: beyond it, each gap would look like a loss."""
CATCH_UP_SHARE = 0.4
"""Largest share of a period by which assigned times catch up in each slot after a correction of the period."""
LEAST_RATE, OTHER_RATE = 5.0, 0.1
"""Smallest rate that shows a step, which lasts half a second, Hz; and relative difference from the rate that was said
above which it is reported, more than clocks differ and a radio loses."""
SAME_SILENCE = 0.2
"""Largest relative difference of two silences in a row with one packet in between that are the period."""


@define
class PeriodicClock:
    """The clock of a stream without counters; it assigns times in order, without latency, and never revises them."""

    period: float
    """Period in s, as written to the device, from its profile, or as counted."""
    clock: Clock = field(factory=lambda: Clock(1.0))
    """Fit of slot numbers to arrivals, which starts with the first packet."""
    pace: Clock = field(factory=lambda: Clock(1.0))
    """Fit of the number of gaps that show no loss to their total time: its slope shows another rate."""
    pace_count: float = 0.0
    """That number since the fit started."""
    holes: float = 0.0
    """Total time of the gaps that may show a loss, s."""
    slot: float = 0.0
    """Slot number of the newest packet."""
    declared_period: float | None = None
    """Period that was written to the device, or that its profile has, s; None before the first packet."""
    rate_reported: bool = False
    """Flag: a rate that is another, or too low, was reported."""
    newest_arrival: float | None = None
    """Arrival of the newest packet, s; None before the first, and after a change of period or a new connection."""
    last_t: float | None = None
    """Newest assigned time, s."""
    backlog: Backlog = field(factory=Backlog)
    """Packets that came after a silence, until they come at their own pace."""
    catch_up: float = 0.0
    """Time by which assigned times are behind the fit since the period was corrected, s."""
    jitter: float = 0.0
    """Running mean of the packets' lateness, s."""
    slipped_packets: int = 0
    """Number of packets in a row that were behind their slots."""
    slip_start: float = 0.0
    """Arrival of the first of those packets, s."""
    slip_base: float = 0.0
    """Delay of the packet before those packets, if packets come in bursts, s: their delay is counted from there."""
    slip_delay: float = 0.0
    """Least delay of those packets behind their slots, s; of the second half of those that a loss needs."""
    first_delay: float = 0.0
    """Least delay of the first half of those packets that a loss needs, s."""
    slip_gap: float = 0.0
    """Widest gap before those packets, s."""
    jitter_before_slip: float = 0.0
    """Value of `jitter` before the first of those packets, s."""
    revisable_packets: int = 0
    """Number of further packets that may show that no packet was lost when a loss was last reported."""
    settled_packets: int = 0
    """Number of packets since the fit started, up to SETTLED_PACKETS."""
    behind: float = 0.0
    """Time by which arrivals are behind the count of slots, s, above the least that was so lately."""
    ahead: float = 0.0
    """Time that arrivals gained on the count of slots, s."""
    stand_out: float = 0.0
    """Part of `behind` that came with gaps that stood out, s."""
    count_start: float = 0.0
    """Arrival since which slots are counted to find the period, s."""
    count: float = 0.0
    """Number of those slots."""
    looks: int = len(LOOK_AGAIN)
    """Number of times of LOOK_AGAIN that are over."""
    widest_gap: float = 0.0
    """Widest gap of late, s."""
    usual_gap: float = 0.0
    """Second widest gap of late, s."""
    mean_gap: float = 0.0
    """Running mean of the gaps without losses, s."""
    last_gap: float = 0.0
    """Newest gap, s."""
    regular: float = 0.0
    """Share of gaps of about a period."""
    unsure: int = 0
    """Number of slots left out after gaps in a row, which are reported as lost if the period is right."""
    last_value: int = -1
    """Checksum of the newest value; -1 before the first."""
    repeats: float = 0.5
    """Share of values that repeat the one before them though they came at their own pace."""

    def add_packet(self, arrival: float, longest_loss: float, value: bytes = b"") -> SampleTimes:
        """Return the time of the notification of `value` that arrived at `arrival` (s, not before the previous one).

        A copy raises WireError and changes nothing. After a silence that is longer than `longest_loss`, s, the slots
        restart, because the device may have restarted its timer: it was absent. The limit is 0 while the device may be
        silent (wake on motion)."""
        period, checksum = self.period * (1.0 + self.clock.drift), crc32(value)
        gap = 0.0 if self.newest_arrival is None else arrival - self.newest_arrival
        is_near = gap < COPY_PERIODS * period
        if value and checksum == self.last_value and is_near and self._is_copy(arrival, period):
            raise WireError(Rejection.DUPLICATE, "the newest value again, sooner than the device measures")
        if not is_near:
            self.repeats += (float(checksum == self.last_value) - self.repeats) * MEMORY
        self.last_value = checksum
        if self.declared_period is None:
            self.declared_period = self.period
        if self.newest_arrival is None:
            return self._restart(arrival)
        if gap > max(longest_loss, MIN_GAP * period):
            is_period = self.slot == 0.0 and abs(gap - self.last_gap) < SAME_SILENCE * gap
            self.period, self.last_gap = gap if is_period else period, gap
            if longest_loss == 0.0 or self.last_t is None or self.period > MAX_HELD_PERIOD:
                sample_times = self._restart(arrival)
                self.behind = self.stand_out = self.widest_gap = gap  # what was held back meanwhile may come at once
                return sample_times
            self.backlog.hold(arrival)
            return self._follow(arrival, period)
        if self.backlog.since is not None:
            return self._take_held_back(arrival, period)
        self.newest_arrival = arrival
        delay = arrival - self.clock.fit_time(self.slot + 1.0)
        settled = self.settled_packets >= SETTLED_PACKETS
        is_early = (
            delay < -MIN_EARLY_PERIODS * period
            and (settled or self.revisable_packets > 0)
            or arrival - self.clock.preview_time(self.slot + 1.0) < -(MAX_EARLY_ARRIVAL + period)
        )
        skipped = 0 if is_early else self._count_lost(arrival, gap, delay, period)
        follows_period = period < MAX_RADIO_DELAY or gap < MIN_GAP * period or self._is_regular(self.last_gap, period)
        # after a gap that was none of the period, another one may be the period: what it hides is reported later
        self.unsure = 0 if is_early else self.unsure + (0 if follows_period or skipped == 0 else skipped)
        lost_count = skipped if follows_period else 0
        if self._is_regular(gap, period):
            lost_count, self.unsure = lost_count + self.unsure, 0
        if (counted := self._count_period(arrival, gap, period, lost_count)) is not None:
            return self._refit(arrival, counted)
        last_t = self.last_t
        if is_early:
            self.revisable_packets = self.slipped_packets = 0
            return SampleTimes([self._assign(self.slot + EARLY_SLOT)])
        self.slot += 1.0 + skipped
        self.settled_packets = min(self.settled_packets + 1, SETTLED_PACKETS)
        self.revisable_packets = REVISABLE_PACKETS if skipped else max(0, self.revisable_packets - 1)
        may_be_wrong = (settled and self.slipped_packets) or (
            self.revisable_packets and delay < (0.0 if settled else -0.3 * period)
        )
        if skipped == 0 and not may_be_wrong:  # the fit does not use a slot that may be a wrong guess
            self.clock.observe(self.slot, arrival)
            if settled:
                late = max(0.0, min(4.0 * period, arrival - self.clock.fit_time(self.slot)))
                self.jitter += (late - self.jitter) * MEMORY
        return SampleTimes([self._assign(self.slot)], lost_count, last_t if lost_count else None)

    def set_period(self, period: float) -> None:
        """Set a period (s) that was written to the device; slots restart with the next packet, if it is another one."""
        self.declared_period = period
        if period != self.period:
            self.period, self.newest_arrival, self.looks, self.usual_gap = period, None, len(LOOK_AGAIN), 0.0

    def report_rate(self, samples: int, site: Site, t: float) -> list[DefectFound | Limitation]:
        """Return, once and when the rate is known, that it is too low, or another one than was said.

        `samples`: number of samples of a packet. `t`: arrival of the newest, s."""
        is_known = self.slot >= SLIPPED_PACKETS and self.slot * self.period >= LOOK_AGAIN[-1]
        if self.rate_reported or self.declared_period is None or not is_known:
            return []
        period = self.period * (1.0 + self.clock.drift) / samples
        if self.looks < len(LOOK_AGAIN) and period < 1.0 / LEAST_RATE:
            return []
        digits = 2 if period * LEAST_RATE > 1.0 else 3
        count = f"{1.0 / period:.{digits}g} samples a second" if period < 0.95 else "one sample a second"
        if period > 1.05:
            count = f"one sample in {period:.2g} s"
        if period * LEAST_RATE > 1.0:
            self.rate_reported = True
            what = f"{count}; set the period of the sensor: a step shows in ten samples a second or more"
            return [DefectFound(t=t, site=site, defect=Defect.LOW_RATE, what=what)]
        declared = self.declared_period / samples
        if abs(declared / period - 1.0) <= OTHER_RATE:
            return []
        self.rate_reported = True
        return [other_rate(site, t, count, 1.0 / declared)]

    def _is_copy(self, arrival: float, period: float) -> bool:
        """Return whether a value that repeats the newest one, directly after it, is the same measurement."""
        is_early = arrival - self.clock.fit_time(self.slot + 1.0) < -MIN_EARLY_PERIODS * period
        return self.repeats < 0.5 or is_early

    def _count_lost(self, now: float, gap: float, delay: float, period: float) -> int:
        """Return the number of packets lost before one that arrived `now`, `delay` s behind its slot, after `gap` s."""
        gap_is_evidence = period >= MAX_RADIO_DELAY
        shows_loss = gap_is_evidence and gap >= MIN_GAP * max(period, self.mean_gap)
        if self.settled_packets < SETTLED_PACKETS and shows_loss:  # lateness may still be a slow device
            is_late = delay >= MIN_UNSETTLED_LATE_PERIODS * period and self.ahead < WRONG_PERIOD_GAPS * period
            return round(gap / period) - 1 if is_late else 0
        lost_count = floor(delay / period + 1.0 - MIN_LATE_PERIODS)
        is_late = delay >= MIN_LATE_PERIODS * period
        if shows_loss and is_late and delay >= MIN_LATE_JITTERS * self.jitter:
            self.slipped_packets = 0
            return lost_count
        in_bursts, is_new = self.regular < MIN_REGULAR, not gap_is_evidence and now - self.clock.origin < LOOK_AGAIN[-1]
        must_stand_out = in_bursts or is_new
        if self.slipped_packets == 0:
            if (in_bursts and is_new) or (must_stand_out and self._excess(gap, period) < MAX_RADIO_DELAY):
                return 0
            self.slip_base = delay - (gap - period) if must_stand_out else 0.0
            self.slip_start, self.slip_delay, self.slip_gap = now, delay - self.slip_base, 0.0
            self.jitter_before_slip = self.jitter
        delay -= self.slip_base
        if not (is_late if gap_is_evidence else delay >= min(MAX_RADIO_DELAY, SLIPPED_PERIODS * period)):
            self.slipped_packets = 0
            return 0
        needed = max(SLIPPED_PACKETS, SLIPPED_DURATION / period)
        if self.slipped_packets < needed / 2.0 <= self.slipped_packets + 1:
            self.first_delay, self.slip_delay = self.slip_delay, delay
        self.slip_gap = max(self.slip_gap, gap)
        self.slip_delay = min(self.slip_delay, delay)
        self.slipped_packets += 1
        is_short = in_bursts and now - self.slip_start < SLIPPED_DURATION
        suspicious = max(SUSPICIOUS_TIME, self.usual_gap, MIN_GAP * period)
        if self.slipped_packets < needed or is_short or self.behind - self.stand_out > suspicious:
            return 0
        self.slipped_packets, self.jitter = 0, self.jitter_before_slip
        growth, lost_time = self.slip_delay - self.first_delay, min(self.first_delay, self.slip_delay)
        if must_stand_out:
            lost_time = (
                min(lost_time, self._excess(self.slip_gap, period)) if growth <= STEADY_SHARE * lost_time else 0.0
            )
        elif STEADY_SHARE < growth / period < 1.0 - STEADY_SHARE or self.slip_gap < MIN_GAP * period:
            return 0  # the delay grows, though not by whole packets, or without a gap: the device is slower
        return max(0, floor(lost_time / period + 1.0 - MIN_LATE_PERIODS))

    def _is_regular(self, gap: float, period: float) -> bool:
        return MIN_EARLY_PERIODS * period <= gap <= MIN_GAP * period

    def _excess(self, gap: float, period: float) -> float:
        """Return the time by which a gap is longer than usual ones, s; 0 if it does not stand out."""
        usual = max(self.usual_gap, period)
        return gap - usual if gap > STAND_OUT * usual else 0.0

    def _count_period(self, arrival: float, gap: float, period: float, lost_count: int) -> float | None:
        """Return the period as counted when the one in use is wrong, s; None when it may be right."""
        kept = 1.0 - GAP_MEMORY * min(1.0, gap / max(self.usual_gap, period))
        self.usual_gap, self.widest_gap = self.usual_gap * kept, self.widest_gap * kept
        excess = self._excess(self.widest_gap, period)
        self.usual_gap = max(self.usual_gap, min(gap, self.widest_gap))
        self.widest_gap = max(self.widest_gap, gap)
        self.stand_out += self._excess(self.widest_gap, period) - excess
        self.regular += (float(self._is_regular(gap, period)) - self.regular) * MEMORY
        self.last_gap, slots = gap, 1.0 + (lost_count if period >= MAX_RADIO_DELAY else 0)
        self.count += slots
        self.mean_gap += (gap / slots - self.mean_gap) * (MEMORY if self.mean_gap else 1.0)
        if period < MAX_RADIO_DELAY or self.regular < MIN_REGULAR or gap < MIN_GAP * period:
            self.pace_count += 1.0
            self.pace.observe(self.pace_count, arrival - self.holes)
        else:  # whether packets are lost in it or not
            self.holes += gap
        step, allowed = gap - slots * period, MAX_DRIFT * slots * period
        self.ahead = max(0.0, self.ahead + max(0.0, -self.behind - step) - allowed)
        self.behind = max(0.0, self.behind + step - allowed)
        self.stand_out = max(0.0, min(self.stand_out - (slots - 1.0) * period, self.behind))
        limit = max(WRONG_PERIOD_TIME, WRONG_PERIOD_GAPS * max(period, self.usual_gap))
        elapsed = arrival - self.count_start
        coarseness = max(1.0, self.usual_gap / LONG_GAP)
        starts_burst = gap >= 0.5 * self.usual_gap  # from one start of a burst to another, the count is exact
        is_due = self.looks < len(LOOK_AGAIN) and elapsed >= coarseness * LOOK_AGAIN[self.looks]
        is_wrong = max(self.ahead, self.behind - self.stand_out) > limit and elapsed >= WRONG_PERIOD_TIME
        fitted = self.period * (1.0 + self.pace.other_slope)
        lag = self.clock.fit_time(self.slot) - self.clock.last_t
        if self.pace.other_slope and (abs(fitted / period - 1.0) > WRONG_SHARE or lag > MAX_EARLY_ARRIVAL + period):
            return fitted
        if starts_burst and (is_wrong or is_due):
            counted = (elapsed - self.stand_out) / self.count
            self.looks = min(self.looks + 1, len(LOOK_AGAIN)) if is_due else 0
            is_other = abs(counted / period - 1.0) > max(WRONG_SHARE, 0.25 * self.usual_gap / elapsed)
            return counted if is_other or is_wrong else None
        if self.behind <= period and self.ahead == 0.0:
            self.stand_out = 0.0
            if self.looks == len(LOOK_AGAIN):
                self.count_start, self.count = arrival, 0.0
        return None

    def _assign(self, slot: float) -> float:
        """Return the time of a slot; what a wrong period has cost is caught up by less than half a period a slot."""
        limit, t_min = CATCH_UP_SHARE * self.period, self.last_t
        self.catch_up -= max(-limit, min(limit, self.catch_up))
        t = self.clock.assign_time(slot) - self.catch_up
        self.last_t = t if t_min is None else max(t, t_min + MIN_INCREMENT)
        return self.last_t

    def _take_held_back(self, arrival: float, period: float) -> SampleTimes:
        """Return the time of a packet after a silence: what was held back fills it, and a gap is what is left.

        Then a new fit starts, because the device may have restarted its timer."""
        is_over, rest = self.backlog.is_over(arrival, period), arrival - (self.last_t or 0.0) - period
        if not is_over and rest > -MAX_EARLY_ARRIVAL:
            return self._follow(arrival, period)
        if rest > max(MAX_RADIO_DELAY, MIN_GAP * period):
            return self._restart(arrival)
        self.backlog.since = None
        return self._refit(arrival, self.period)

    def _follow(self, arrival: float, period: float) -> SampleTimes:
        """Return the time one period after the newest, for a packet that may have been held back."""
        self._start_fit(arrival, None)
        self.last_t = arrival if self.last_t is None else self.last_t + period
        return SampleTimes([self.last_t])

    def _refit(self, arrival: float, period: float) -> SampleTimes:
        """Start a fit with another period, whose times go on after those of the old one."""
        next_t = (arrival if self.last_t is None else self.last_t) + period
        self.period = period
        self._start_fit(arrival, None)
        self.catch_up = arrival - next_t
        return SampleTimes([self._assign(0.0)])

    def _restart(self, arrival: float) -> SampleTimes:
        """Restart the slots with this packet, in a new fit whose times come after those of the old fit."""
        last_t, self.backlog.since = self.last_t, None
        self._start_fit(arrival, None if last_t is None else last_t + 0.5 * self.period)
        self.catch_up = 0.0
        t = self._assign(0.0)
        is_gap = last_t is not None and t - last_t > MIN_GAP * self.period
        return SampleTimes([t], gap_start=last_t if is_gap else None)

    def _start_fit(self, arrival: float, t_min: float | None) -> None:
        self.clock = Clock(1.0 / self.period, max_drift=MAX_PERIOD_DRIFT, t_min=t_min)
        self.clock.observe(0.0, arrival)
        self.pace, self.pace_count, self.holes = Clock(1.0 / self.period), 0.0, 0.0
        self.pace.observe(0.0, arrival)
        self.slot, self.newest_arrival, self.count_start = 0.0, arrival, arrival
        self.slipped_packets = self.revisable_packets = self.settled_packets = self.unsure = 0
        self.behind = self.ahead = self.stand_out = self.count = 0.0


def other_rate(site: Site, t: float, arriving: str, declared: float, digits: int = 3) -> Limitation:
    """Return that others arrive, in words, than the number a second that was declared, which has so many digits."""
    what = f"{arriving} arrive, not the {declared:.{digits}g} that were set: sample times go by what arrives"
    return Limitation(t=t, site=site, what=what)
