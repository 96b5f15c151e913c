"""What the counters of a device say of a packet (protocol/clock.md, "What a frame is"): next, some lost before it,
repeated, late, or begun anew; and when its samples were taken."""

from __future__ import annotations

from ..events import ClockReset, PacketsLost, Rejection
from ..types import Site
from ..types.attrs import define, frozen
from ..wire.error import WireError
from .clock import Clock

REMEMBERED_PACKETS = 64
"""Packets of which it is known whether they were accepted."""
MAX_OVERTAKEN = 2.0
"""Seconds that a packet may be overtaken, in ticks and in delay; an older one is of a device that began anew."""


def signed(difference: int, modulus: int) -> int:
    """The difference of two counters that wrap at `modulus`, nearest to zero."""
    half = modulus // 2
    return (difference + half) % modulus - half


@frozen
class PacketPosition:
    """A packet's place: `m` packets and `e` ticks after the newest one, with `samples` every `interval` ticks,
    which need not be a whole number of them.

    `d`: difference of its sequence as sent, before wraps were counted. `ticks`: of its first sample, as sent; a new
    fit begins there. `retransmitted`: it says itself that it was sent before.
    """

    sequence: int
    ticks: int
    interval: float
    samples: int
    sequence_difference: int = 0
    packets_after: int = 0
    ticks_after: int = 0
    retransmitted: bool = False


@frozen
class SampleTimes:
    """When the samples of a packet were taken, s. `lost` packets before it never came, the first of them at
    `t_missing`, s. `restarted`: None within a fit; when a new one began, whether the device counts from anew as well.
    """

    times: list[float]
    lost: int = 0
    t_missing: float = 0.0
    restarted: bool | None = None

    def make_events(self, site: Site, channel: str, arrival: float) -> list[PacketsLost | ClockReset]:
        """What is to be said before its samples, in order."""
        found: list[PacketsLost | ClockReset] = []
        if self.lost:
            t = self.t_missing
            found.append(PacketsLost(t=t, known_at=max(arrival, t), site=site, channel=channel, count=self.lost))
        if self.restarted is not None:
            t = self.times[0]
            found.append(ClockReset(t=t, known_at=max(arrival, t), site=site, restarted=self.restarted))
        return found


@define
class PacketRun:
    """Packets of one device in the order of its counters, on one clock."""

    clock: Clock | None = None
    sequence: int = 0
    """Of the newest packet accepted."""
    ticks: int = 0
    """Unwrapped ticks of its first sample."""
    interval: float = 1.0
    """Ticks between its samples."""
    packet_ticks: float = 1.0
    """Ticks that it covers."""
    accepted_bits: int = 0
    """Bit b: the packet b before the newest was accepted."""
    after_reconnection: bool = False
    """No packet came yet since the device was connected again: counters that go back have begun anew."""

    def count_packets(self, sequence: int, modulus: int, expected: float) -> tuple[int, int]:
        """(signed difference of the sequence, packets after the newest one): the true difference is that one of all
        which the wrapping counter allows that is nearest to `expected`."""
        half = modulus // 2
        d = (sequence - self.sequence + half) % modulus - half
        return d, d + modulus * round((expected - d) / modulus)

    def accept(self, new: PacketPosition, rate: float, arrival: float, new_fit: bool = False) -> SampleTimes:
        """Accept a packet that arrived at `arrival`, s, from a device with `rate` ticks a second.

        WireError, and nothing has changed, when it is a duplicate or late. `new_fit`: it is of another fit, whatever its
        counters say.
        """
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
                self.accepted_bits = (self.accepted_bits << m | 1) & (1 << REMEMBERED_PACKETS) - 1 if m < REMEMBERED_PACKETS else 1
        self.after_reconnection = False
        self.sequence, self.interval, self.packet_ticks = new.sequence, float(new.interval), packet_ticks
        clock.observe(self.ticks + packet_ticks - new.interval, arrival)
        times = []
        for j in range(new.samples):
            times.append(clock.assign_time(self.ticks + j * self.interval))
        return SampleTimes(times, lost, t_missing, restarted)

    def _start_clock(self, ticks: int, rate: float, floor: float | None) -> Clock:
        self.clock = Clock(rate, t_min=floor)
        self.ticks, self.accepted_bits = ticks, 1
        return self.clock

    def _reject_repeated(self, clock: Clock, new: PacketPosition, arrival: float) -> None:
        """WireError when a packet that is not newer is one that came already or was overtaken; else it began anew."""
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
