"""Classification of a packet by the device's counters, and the times of its samples.

A packet is the next one, follows lost packets, is a duplicate, is late, or comes from a device that restarted its
counters (protocol/clock.md, "What a frame is", has the numbers below). A packet run is the packets between two such
restarts."""

from __future__ import annotations

from ..events import ClockReset, Rejection, SampleGap
from ..types import Site
from ..types.attrs import define
from ..wire.error import WireError
from .clock import Clock

REMEMBERED_PACKETS = 64
"""Number of the newest packets for which it is remembered whether they were accepted."""
MIN_GAP = 1.5
"""Smallest time from one sample to the next that is a gap, intervals; one tick is added, as ticks are whole."""
MAX_LEAD_AFTER_LOSS = 0.1
"""Largest time by which a packet that follows lost ones may be ahead of the fit, s: above the error of a new fit, whose
first packet a radio delayed by some connection events."""
MAX_OVERTAKING_TIME = 2.0
"""Longest time by which a packet may be overtaken, s, by the device's ticks and by the delay of its arrival.

An older packet shows that the device restarted its counters."""

STEADY_NUMBERS = 6
"""Number of packets that show what the numbers of a device count."""
SAMPLE_NUMBERS = (
    "the number goes up by {0} with each notification of {0} samples, so it counts samples: give sequence=number // {0}"
    " in the reader and sequence={1} in the Driver, or count notifications in the device"
)
STEP_NUMBERS = (
    "the number goes up by {0} with each notification, so nothing is lost in between: count notifications in the device"
)
REPEATED_NUMBERS = (
    "the same number comes with several notifications, whose values differ: count every notification in the device, or "
    "give no sequence"
)
ROUND_NUMBERS = (
    "the number goes from {0} to {1}, not through all {2} values that were declared: give sequence={3} in the Driver"
)
MAX_RADIO_DELAY = 0.04
"""Largest delay that a radio may cause at any time, s."""
BACKLOG_PACE = 1.5
"""Smallest ratio of the pace of packets that were held back to their own, chosen by hand: a radio that has many to
deliver is several times as fast."""
ON_TIME = 1.5
"""Time after the newest packet, in packets, within which one that starts the numbers again is the next one."""


def signed_difference(difference: int, modulus: int) -> int:
    """Return the value nearest to zero that equals `difference` modulo `modulus`, at which the counters wrap."""
    half = modulus // 2
    return (difference + half) % modulus - half


@define
class Numbering:
    """What the sequence numbers of a declared device count, if they do not count its packets.

    A number that goes up by the number of samples in a packet from the first packet on counts samples; by another
    constant step, something else. A number that comes with other values than before does not count every packet. None
    of them is a loss or a copy of a packet. Each is said once, when `STEADY_NUMBERS` packets have shown it.

    Numbers that start again from the number from which they did before, on time, have that round, whatever was
    declared."""

    newest: int = 0
    """Number of the newest accepted packet, as sent."""
    step: int = 0
    """Difference of the numbers of two packets in a row, if it is not 1; 0 before the second packet."""
    steps: int = 0
    """Number of differences of one step, until it is known to be constant; -1 once one was no multiple of it."""
    top: int = -1
    """Number from which the numbers started again last, as sent; -1 if they went through all values."""
    bottom: int = 0
    """Number at which they start, if they have a round of their own."""
    round: int = 0
    """Number of packets from `bottom` to `top`, if that is another than was declared; else 0."""
    repeats: int = 0
    """Number of packets that repeated a number, until that is known to be no accident."""
    has_stepped: bool = False
    """The newest number was another one than the number before."""

    def count_packets(self, number: int, modulus: int, samples: int, expected: float, is_copy: bool) -> tuple[int, int]:
        """Return how many packets after the newest one a packet is, and the packets in a round of the counter.

        `expected`: that number by the time from one to the other. `is_copy`: it has the values of the newest one."""
        if self.round and self.bottom <= number <= self.top:
            modulus = self.round
        elif number < self.newest == self.top and expected < ON_TIME:
            return 1, modulus
        difference = signed_difference(number - self.newest, modulus)
        if difference == 0:
            return int(not is_copy), modulus
        step = self.step
        if step == 0:  # a second packet that comes when the next one is due is the next one, whatever its number is
            step = difference if difference > 1 and expected < 0.5 * (1 + difference) else samples
        may_be_steps = self.steps >= 0 and step > 1 and difference % step == 0
        if may_be_steps or self.steps >= STEADY_NUMBERS:
            return difference // step, max(1, modulus // step)
        return difference, modulus

    def accept(self, number: int, modulus: int, samples: int, packets: int, is_first: bool) -> str:
        """Take the number of a packet that was accepted; return what the numbers count, in words, when it is known.

        `packets`: how many packets after the newest one it is."""
        difference, before, what = signed_difference(number - self.newest, self.round or modulus), self.newest, ""
        self.newest = number
        if is_first:
            return what
        if self.round and not self.bottom <= number <= self.top:
            self.round = 0
        step = self.step if self.steps >= STEADY_NUMBERS else 1
        if number < before and not self.round:
            count, is_known = before - number + step, before == self.top and packets == 1
            self.top, self.bottom = (-1 if count == modulus else before), number
            if is_known and count != modulus:
                self.round, what = count, ROUND_NUMBERS.format(before, number, modulus, count)
        if difference == 0 and self.repeats < STEADY_NUMBERS:
            self.repeats += 1
            what = REPEATED_NUMBERS if self.repeats == STEADY_NUMBERS else ""
        elif difference and self.has_stepped and self.repeats < STEADY_NUMBERS:
            self.repeats = 0
        self.has_stepped = difference != 0
        if difference and 0 <= self.steps < STEADY_NUMBERS:
            if self.step == 0 and packets:
                self.step = difference // packets
            is_step = self.step > 1 and difference % self.step == 0
            self.steps = self.steps + (difference == self.step) if is_step else -1
            if self.steps == STEADY_NUMBERS:
                is_samples = self.step == samples
                what = (SAMPLE_NUMBERS if is_samples else STEP_NUMBERS).format(self.step, modulus // self.step)
        return what


@define
class PacketPosition:
    """The position of a packet in the counters of its device, relative to the newest accepted packet."""

    sequence: int
    """Sequence number of the packet."""
    ticks: int
    """Ticks of the packet's first sample, as sent; a new fit starts there."""
    interval: float
    """Ticks from one sample to the next, which may be a fraction."""
    samples: int
    """Number of samples in the packet."""
    sequence_difference: int = 0
    """Difference of the sequence numbers as sent, nearest to zero; whole rounds of the counter are not counted."""
    packets_after: int = 0
    """Number of packets from the newest accepted packet to this one, whole rounds counted; 1 for the next packet."""
    ticks_after: int = 0
    """Ticks from the newest accepted packet to this one."""
    retransmitted: bool = False
    """True if the packet itself says that it was sent before."""


@define
class SampleTimes:
    """The times of the samples of a packet, and the gap or the restart before the packet."""

    times: list[float]
    """Time of each sample, s."""
    lost_count: int = 0
    """Number of samples that were lost directly before the packet."""
    gap_start: float | None = None
    """Time of the newest sample before the packet, s, if there is a gap between them; None without a gap."""
    restarted: bool | None = None
    """True when a new fit started because the counters restarted, False for other new fits; None without a new fit."""

    def make_events(self, site: Site, arrival: float) -> list[SampleGap | ClockReset]:
        """Return the events that come before the packet's samples, in order."""
        events: list[SampleGap | ClockReset] = []
        t, start = self.times[0], self.gap_start
        if self.restarted is not None:
            events.append(ClockReset(t=t, known_at=max(arrival, t), site=site, restarted=self.restarted))
        if start is not None:
            known_at, count = max(arrival, start), self.lost_count
            events.append(SampleGap(t=start, known_at=known_at, site=site, duration=t - start, count=count))
        return events


@define
class Backlog:
    """Packets that a phone held back during a silence and then delivers faster than they were measured.

    They were measured one after another during the silence. Packets that come at their own pace were not."""

    since: float | None = None
    """Arrival since which their pace is measured, s; None while nothing was held back."""
    packets: int = 0
    """Number of packets after that one."""

    def hold(self, arrival: float) -> None:
        """Take a packet that arrived at `arrival`, s, after a silence, as the first that was held back."""
        self.since, self.packets = arrival, 0

    def is_over(self, arrival: float, period: float) -> bool:
        """Take the next packet; return whether packets arrive at their own pace again, one each `period` s."""
        elapsed = arrival - (arrival if self.since is None else self.since)
        self.packets += 1
        if elapsed <= MAX_RADIO_DELAY:
            return False
        is_over = self.packets * period < BACKLOG_PACE * elapsed
        self.since, self.packets = None if is_over else arrival, 0
        return is_over


@define
class PacketRun:
    """The accepted packets of one device in the order of its counters, on one clock."""

    clock: Clock | None = None
    """Clock of the device; None before the first packet."""
    sequence: int = 0
    """Sequence number of the newest packet accepted."""
    ticks: int = 0
    """Unwrapped ticks of the newest packet's first sample."""
    interval: float = 1.0
    """Ticks between the newest packet's samples."""
    packet_ticks: float = 1.0
    """Ticks that the newest packet covers."""
    accepted_bits: int = 0
    """Bit field; bit b is set when the packet b before the newest was accepted."""
    after_reconnection: bool = False
    """True until the first packet after a reconnection; counters that go back have then restarted."""

    def count_packets(self, sequence: int, modulus: int, ticks_after: float) -> tuple[int, int]:
        """Return the sequence difference nearest to zero, and the number of packets after the newest one.

        The counter wraps at `modulus`, so the number may include whole rounds: it is the possible value that is nearest
        to the number of packets that `ticks_after` suggests, the ticks from the newest packet to this one."""
        half = modulus // 2
        difference = (sequence - self.sequence + half) % modulus - half
        return difference, difference + modulus * round((ticks_after / self.packet_ticks - difference) / modulus)

    def accept(self, position: PacketPosition, rate: float, arrival: float, new_fit: bool = False) -> SampleTimes:
        """Accept a packet that arrived at `arrival`, s, from a device with `rate` ticks a second.

        A duplicate or late packet raises WireError and changes nothing. `new_fit`: start a new fit with this packet,
        whatever its counters are."""
        packet_ticks = float(position.interval * position.samples)
        clock, lost_count, last_t, restarted = self.clock, 0, None, None
        if clock is None:
            clock = self._start_clock(position.ticks, rate, None)
        else:
            packets, ticks, last_t = position.packets_after, position.ticks_after, clock.last_t
            # Sequence and ticks agree on how far the packet is from the newest one.
            same_run = abs(packets * self.packet_ticks - ticks) <= 2 * self.packet_ticks
            held_back = same_run and not self.after_reconnection
            if (ticks <= 0 or packets <= 0) and not new_fit:
                self._reject_repeated(clock, position, arrival, same_run)
            last = self.ticks + ticks + packet_ticks - position.interval
            # samples that were lost took their time: a counter that gets ahead of it was reset or set
            is_ahead = packets > 1 and clock.fit_time(last) - arrival > MAX_LEAD_AFTER_LOSS
            other_clock = is_ahead or clock.rate != rate or clock.contradicts(last, arrival, held_back)
            if ticks <= 0 or packets <= 0 or new_fit or other_clock:
                restarted = not 1 <= position.sequence_difference <= REMEMBERED_PACKETS
                clock = self._start_clock(position.ticks, rate, last_t + self.interval / clock.rate)
            else:
                lost_count = (packets - 1) * position.samples
                self.ticks += ticks
                self.accepted_bits = (
                    (self.accepted_bits << packets | 1) & (1 << REMEMBERED_PACKETS) - 1
                    if packets < REMEMBERED_PACKETS
                    else 1
                )
        self.after_reconnection = False
        self.sequence, self.interval, self.packet_ticks = position.sequence, float(position.interval), packet_ticks
        clock.observe(self.ticks + packet_ticks - position.interval, arrival)
        times = []
        for j in range(position.samples):
            times.append(clock.assign_time(self.ticks + j * self.interval, arrival))
        if last_t is not None and not lost_count and (times[0] - last_t) * rate <= MIN_GAP * self.interval + 1.0:
            last_t = None
        return SampleTimes(times, lost_count, last_t, restarted)

    def _start_clock(self, ticks: int, rate: float, t_min: float | None) -> Clock:
        self.clock = Clock(rate, t_min=t_min)
        self.ticks, self.accepted_bits = ticks, 1
        return self.clock

    def _reject_repeated(self, clock: Clock, position: PacketPosition, arrival: float, same_run: bool) -> None:
        """Raise WireError if a packet that is not newer is a duplicate or late; return if the device restarted."""
        packets, ticks = position.packets_after, position.ticks_after
        was_accepted = same_run and -REMEMBERED_PACKETS < packets <= 0 and bool(self.accepted_bits >> -packets & 1)
        if position.retransmitted and ticks < 0:
            if was_accepted:
                raise WireError(Rejection.DUPLICATE, f"sent again, and it came already, {-packets} before the newest")
            raise WireError(Rejection.LATE, f"sent again, {-packets} packets old")
        overtaken = (
            not self.after_reconnection
            and same_run
            and ticks >= -MAX_OVERTAKING_TIME * clock.rate
            and arrival - clock.fit_time(self.ticks + ticks) <= MAX_OVERTAKING_TIME + self.packet_ticks / clock.rate
        )
        if packets == 0 and ticks == 0:
            raise WireError(Rejection.DUPLICATE, "the newest packet again")
        if not overtaken or packets > 0:
            return
        if was_accepted:
            raise WireError(Rejection.DUPLICATE, f"a packet that came already, {-packets} before the newest")
        raise WireError(Rejection.LATE, f"{-packets} packets behind the newest")
