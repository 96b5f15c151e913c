"""Classification of a packet by the device's counters, and the times of its samples.

A packet is the next one, follows some lost ones, is a repetition, is late, or comes from a device that restarted its
counters (protocol/clock.md, "What a frame is")."""

from __future__ import annotations

from ..events import ClockReset, PacketsLost, Rejection
from ..types import Site
from ..types.attrs import define, frozen
from ..wire.error import WireError
from .clock import Clock

REMEMBERED_PACKETS = 64
"""Number of packets before the newest for which it is known whether they were accepted."""
MAX_OVERTAKEN = 2.0
"""Longest time by which a packet may be overtaken, in ticks and in delay, s.

An older packet is from a device that restarted its counters."""


def signed(difference: int, modulus: int) -> int:
    """Return the difference of two counters that wrap at `modulus`, nearest to zero."""
    half = modulus // 2
    return (difference + half) % modulus - half


@frozen
class PacketPosition:
    """The position of a packet relative to the newest one accepted."""

    sequence: int
    """Sequence number of the packet."""
    ticks: int
    """Ticks of its first sample, as sent; a new fit starts there."""
    interval: float
    """Ticks from one sample to the next, not necessarily a whole number."""
    samples: int
    """Number of samples in the packet."""
    sequence_difference: int = 0
    """Difference of the sequence numbers as sent, without the wraps in between."""
    packets_after: int = 0
    """Number of packets after the newest one accepted."""
    ticks_after: int = 0
    """Ticks after the newest packet accepted."""
    retransmitted: bool = False
    """True if the packet itself says that it was sent before."""


@frozen
class SampleTimes:
    """The times of the samples of a packet, and the losses or restart before it."""

    times: list[float]
    """Time of each sample, s."""
    lost: int = 0
    """Number of packets before this one that never came."""
    t_missing: float = 0.0
    """Time of the first lost packet, s."""
    restarted: bool | None = None
    """None within a fit; when a new fit started, whether the device's counters restarted as well."""

    def make_events(self, site: Site, channel: str, arrival: float) -> list[PacketsLost | ClockReset]:
        """Return the events that come before the packet's samples, in order."""
        events: list[PacketsLost | ClockReset] = []
        if self.lost:
            t = self.t_missing
            events.append(PacketsLost(t=t, known_at=max(arrival, t), site=site, channel=channel, count=self.lost))
        if self.restarted is not None:
            t = self.times[0]
            events.append(ClockReset(t=t, known_at=max(arrival, t), site=site, restarted=self.restarted))
        return events


@define
class PacketRun:
    """The packets of one device in the order of its counters, on one clock."""

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

    def count_packets(self, sequence: int, modulus: int, expected: float) -> tuple[int, int]:
        """Return the sequence difference nearest to zero, and the packets after the newest one.

        The second is the true difference: of all that the wrapping counter allows, the one nearest to `expected`."""
        half = modulus // 2
        d = (sequence - self.sequence + half) % modulus - half
        return d, d + modulus * round((expected - d) / modulus)

    def accept(self, new: PacketPosition, rate: float, arrival: float, new_fit: bool = False) -> SampleTimes:
        """Accept a packet that arrived at `arrival`, s, from a device with `rate` ticks a second.

        WireError, and nothing has changed, when it is a duplicate or late. `new_fit`: it belongs to another fit,
        whatever its counters are."""
        packet_ticks = float(new.interval * new.samples)
        clock, lost, t_missing, restarted = self.clock, 0, 0.0, None
        if clock is None:
            clock = self._start_clock(new.ticks, rate, None)
        else:
            m, e = new.packets_after, new.ticks_after
            if e <= 0 or m <= 0:
                self._reject_repeated(clock, new, arrival)
            last = self.ticks + e + packet_ticks - new.interval
            if e <= 0 or m <= 0 or new_fit or clock.rate != rate or clock.contradicts(last, arrival):
                restarted = not 1 <= new.sequence_difference <= REMEMBERED_PACKETS
                clock = self._start_clock(new.ticks, rate, clock.last_t + self.interval / clock.rate)
            else:
                if m > 1:
                    lost, t_missing = m - 1, clock.preview_time(self.ticks + self.packet_ticks)
                self.ticks += e
                self.accepted_bits = (
                    (self.accepted_bits << m | 1) & (1 << REMEMBERED_PACKETS) - 1 if m < REMEMBERED_PACKETS else 1
                )
        self.after_reconnection = False
        self.sequence, self.interval, self.packet_ticks = new.sequence, float(new.interval), packet_ticks
        clock.observe(self.ticks + packet_ticks - new.interval, arrival)
        times = []
        for j in range(new.samples):
            times.append(clock.assign_time(self.ticks + j * self.interval))
        return SampleTimes(times, lost, t_missing, restarted)

    def _start_clock(self, ticks: int, rate: float, t_min: float | None) -> Clock:
        """Start a new clock at `ticks`; its first time is not before `t_min`, s."""
        self.clock = Clock(rate, t_min=t_min)
        self.ticks, self.accepted_bits = ticks, 1
        return self.clock

    def _reject_repeated(self, clock: Clock, new: PacketPosition, arrival: float) -> None:
        """Raise WireError when a packet that is not newer came already or was overtaken; else the device restarted."""
        m, e = new.packets_after, new.ticks_after
        same_run = abs(m * self.packet_ticks - e) <= 2 * self.packet_ticks
        accepted = same_run and -REMEMBERED_PACKETS < m <= 0 and bool(self.accepted_bits >> -m & 1)
        if new.retransmitted and e < 0:
            if accepted:
                raise WireError(Rejection.DUPLICATE, f"sent again, and it came already, {-m} before the newest")
            raise WireError(Rejection.LATE, f"sent again, {-m} packets old")
        overtaken = (
            not self.after_reconnection
            and same_run
            and e >= -MAX_OVERTAKEN * clock.rate
            and arrival - clock.fit_time(self.ticks + e) <= MAX_OVERTAKEN + self.packet_ticks / clock.rate
        )
        if m == 0 and e == 0:
            raise WireError(Rejection.DUPLICATE, "the newest packet again")
        if not overtaken or m > 0:
            return
        if accepted:
            raise WireError(Rejection.DUPLICATE, f"a packet that came already, {-m} before the newest")
        raise WireError(Rejection.LATE, f"{-m} packets behind the newest")
