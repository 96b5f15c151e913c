"""What the counters of a device say of a packet (protocol/clock.md, "What a frame is"): next, some lost before it,
repeated, late, or begun anew; and when its samples were taken."""

from __future__ import annotations

from ..events import ClockReset, PacketsLost, Rejection
from ..types import Site
from ..types.attrs import define, frozen
from ..wire.error import WireError
from .clock import Clock

REMEMBERED = 64
"""Packets of which it is known whether they were accepted."""
OVERTAKEN = 2.0
"""Seconds that a packet may be overtaken, in ticks and in delay; an older one is of a device that began anew."""


def signed(difference: int, modulus: int) -> int:
    """The difference of two counters that wrap at `modulus`, nearest to zero."""
    half = modulus // 2
    return (difference + half) % modulus - half


@frozen
class Counted:
    """A packet's place: `m` packets and `e` ticks after the newest one, with `samples` every `interval` ticks,
    which need not be a whole number of them.

    `d`: difference of its sequence as sent, before wraps were counted. `ticks`: of its first sample, as sent; a new
    fit begins there. `again`: it says itself that it was sent before.
    """

    sequence: int
    ticks: int
    interval: float
    samples: int
    d: int = 0
    m: int = 0
    e: int = 0
    again: bool = False


@frozen
class Taken:
    """When the samples of a packet were taken, s. `lost` packets before it never came, the first of them at
    `t_missing`, s. `restarted`: None within a fit; when a new one began, whether the device counts from anew as well.
    """

    times: list[float]
    lost: int = 0
    t_missing: float = 0.0
    restarted: bool | None = None

    def events(self, site: Site, channel: str, arrival: float) -> list[PacketsLost | ClockReset]:
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
    covers: float = 1.0
    """Ticks that it covers."""
    seen: int = 0
    """Bit b: the packet b before the newest was accepted."""
    fresh: bool = False
    """No packet came yet since the device was connected again: counters that go back have begun anew."""

    def packets(self, sequence: int, modulus: int, expected: float) -> tuple[int, int]:
        """(signed difference of the sequence, packets after the newest one): the true difference is that one of all
        which the wrapping counter allows that is nearest to `expected`."""
        half = modulus // 2
        d = (sequence - self.sequence + half) % modulus - half
        return d, d + modulus * round((expected - d) / modulus)

    def take(self, new: Counted, rate: float, arrival: float, anew: bool = False) -> Taken:
        """Accept a packet that arrived at `arrival`, s, from a device with `rate` ticks a second.

        WireError, and nothing has changed, when it is a duplicate or late. `anew`: it is of another fit, whatever its
        counters say.
        """
        covers = float(new.interval * new.samples)
        clock, lost, t_missing, restarted = self.clock, 0, 0.0, None
        if clock is None:
            clock = self._begin(new.ticks, rate, None)
        else:
            m, e = new.m, new.e
            if e <= 0 or m <= 0:
                self._refuse_repeated(clock, new, arrival)
            last = self.ticks + e + covers - new.interval
            if e <= 0 or m <= 0 or anew or clock.rate != rate or clock.jumped(last, arrival):
                restarted = not 1 <= new.d <= REMEMBERED
                clock = self._begin(new.ticks, rate, clock.last_t + self.interval / clock.rate)
            else:
                if m > 1:
                    lost, t_missing = m - 1, clock.expected(self.ticks + self.covers)
                self.ticks += e
                self.seen = (self.seen << m | 1) & (1 << REMEMBERED) - 1 if m < REMEMBERED else 1
        self.fresh = False
        self.sequence, self.interval, self.covers = new.sequence, float(new.interval), covers
        clock.observe(self.ticks + covers - new.interval, arrival)
        times = []
        for j in range(new.samples):
            times.append(clock.time(self.ticks + j * self.interval))
        return Taken(times, lost, t_missing, restarted)

    def _begin(self, ticks: int, rate: float, floor: float | None) -> Clock:
        self.clock = Clock(rate, floor=floor)
        self.ticks, self.seen = ticks, 1
        return self.clock

    def _refuse_repeated(self, clock: Clock, new: Counted, arrival: float) -> None:
        """WireError when a packet that is not newer is one that came already or was overtaken; else it began anew."""
        m, e = new.m, new.e
        same_run = abs(m * self.covers - e) <= 2 * self.covers
        accepted = same_run and -REMEMBERED < m <= 0 and bool(self.seen >> -m & 1)
        if new.again and e < 0:
            if accepted:
                raise WireError(Rejection.DUPLICATE, f"sent again, and it came already, {-m} before the newest")
            raise WireError(Rejection.LATE, f"sent again, {-m} packets old")
        overtaken = (
            not self.fresh
            and same_run
            and e >= -OVERTAKEN * clock.rate
            and arrival - clock.fitted(self.ticks + e) <= OVERTAKEN + self.covers / clock.rate
        )
        if m == 0 and e == 0:
            raise WireError(Rejection.DUPLICATE, "the newest packet again")
        if not overtaken or m > 0:
            return
        if accepted:
            raise WireError(Rejection.DUPLICATE, f"a packet that came already, {-m} before the newest")
        raise WireError(Rejection.LATE, f"{-m} packets behind the newest")
