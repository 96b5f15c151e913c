"""The one ledger of a sensor's link: what came, what never came, how many samples a second, where it fell silent.

What terminal, page, report and summary say of links is read from here, and what each figure means is said here alone.
It is counted from the packets that a session was fed and from the events that it said of them.
"""

from __future__ import annotations

from collections import Counter, deque
from math import floor, inf

from attrs import define, field

from ..events import (
    BatteryLevel,
    ClockReset,
    Connected,
    Disconnected,
    Event,
    LinkTrouble,
    PacketRejected,
    PacketsDropped,
    PacketsLost,
    SampleGap,
    SampleRejected,
    StreamRestarted,
    StreamResumed,
    StreamStale,
)
from ..link.known import KINDS
from ..types import Packet
from ..wire.fragment import is_fragment

SET_BACK = 1.0
"""s by which nothing is late: what is earlier than that is of a clock that was set back."""
WINDOW = 2.0
"""s over which the rate of late is counted."""
MOST_SAMPLES = 1000
"""Samples that are counted in it: 500 a second."""
LOSS_WINDOW = 10
"""s over which the loss of late is counted, in whole ones: an outage is over when it is over."""
SILENT_AFTER = 1.5
"""s without a sample after which a link is silent, whether or not the session has said so."""
STRAGGLER_TIME = 1.0
"""s after a connection broke in which what still comes is no sign of a new one."""


def is_sample_channel(channel: str) -> bool:
    """Whether samples come on this channel of a device that solepath knows."""
    kind = KINDS.get(channel.partition("/")[0])
    return kind is not None and channel in kind.profile.streams


def is_frame_fragment(packet: Packet) -> bool:
    """Whether this is a piece of a frame that was too long for one packet."""
    return packet.channel == "insole/frame" and is_fragment(packet.data)


@define
class CoveredTime:
    """Time that is covered, s: of stretches that no clock was set back in."""

    count: int = 0
    first: float | None = None
    """Where the one that is going on began; None between two of them."""
    last: float = 0.0
    _before: float = 0.0
    """How long the others are together."""

    def add(self, t: float) -> None:
        """Something came at `t` s."""
        if self.first is not None and t < self.last - SET_BACK:
            self.close()
        if self.first is None:
            self.count += 1
            self.first = self.last = t
        self.first, self.last = min(self.first, t), max(self.last, t)

    def close(self) -> None:
        """What comes next does not go on from what came."""
        self._before, self.first = self.total, None

    @property
    def total(self) -> float:
        """How long all of them are together."""
        return self._before + (0.0 if self.first is None else self.last - self.first)


@define
class RecentLoss:
    """Packets of samples of the last seconds."""

    seconds: deque[list[int]] = field(factory=lambda: deque(maxlen=LOSS_WINDOW + 1))
    """[second, received, lost], of those in which there were any."""

    def add(self, t: float, received: int, lost: int) -> None:
        """At `t` s there were so many more."""
        second = floor(t)
        if not self.seconds or not self.seconds[-1][0] - 1 <= second <= self.seconds[-1][0]:
            self.seconds.append([second, 0, 0])
        self.seconds[-1][1] += received
        self.seconds[-1][2] += lost

    def share(self, now: float) -> float | None:
        """Of those that were sent, the lost ones; None where none came."""
        kept = [one for one in self.seconds if now - LOSS_WINDOW - 1.0 < one[0] <= now]
        received, lost = sum([one[1] for one in kept]), sum([one[2] for one in kept])
        return lost / (received + lost) if received else None


@define
class LinkLedger:
    """The link of one site since the start. Times are arrivals in s, unless a line says otherwise; memory is bounded.

    `counted`: its samples are seen here. Those of feet always are; of another site, once a packet of it was fed."""

    counted: bool = True
    received: int = 0
    """Packets of samples that came and were used. A frame that is sent in pieces is one packet, and is there with the
    piece that makes a sample of it. 0 where samples are fed without packets, and of a device of an app's own."""
    lost: int = 0
    """Packets of samples that never came, as the device's counter has it, or the time between arrivals for a device
    without one (PacketsLost). What was rejected is not lost for that: of a packet that came twice or late nothing is
    missing. Of one that came damaged, or that the receiver dropped, the counter shows that it is."""
    dropped: int = 0
    """Packets that came and were thrown away, since nobody took them in time (PacketsDropped)."""
    rejected: Counter[tuple[str, str]] = field(factory=Counter)
    """Packets and samples that came and could not be used (PacketRejected, SampleRejected): by "packets" or "samples",
    and the reason."""
    samples: int = 0
    """Samples that were used, each with its own time: of a foot what the session said where it was or what it pressed
    (FootMoved, FootPressed) or what was fed as a sample; of another site what its packets hold."""
    has_motion: bool = False
    """There were samples of an inertial sensor ..."""
    has_pressure: bool = False
    """... and of pressure cells."""
    gaps: int = 0
    """Interruptions between samples that are longer than the sensor's rate allows (SampleGap)."""
    gap_time: float = 0.0
    """Their time together, each from the last sample before it to the first one after it, s."""
    silences: int = 0
    """How often nothing came for longer than the link allows (StreamStale)."""
    connections: int = 0
    clock_resets: int = 0
    """How often the device's clock, or the receiver's, jumped or began anew (ClockReset)."""
    restarts: int = 0
    """How often the receiver set up the device again, since it sent nothing over a connection that stands."""
    battery: float | None = None
    """As the device said last, 0 to 1."""
    name: str = ""
    """Of the device, as far as it is known."""
    signal: int | None = None
    """With which it was last heard before the connection, dBm."""
    trouble: str = ""
    """The last one, until the device is connected again (LinkTrouble)."""
    last_sample_at: float | None = None
    """When the newest sample came."""
    broken_at: float | None = None
    """When the connection broke; None while there is one."""
    _fresh: bool = False
    """Samples have come over this connection."""
    _stale: bool = False
    """The session has said that nothing comes any more."""
    _t: float | None = None
    """The newest sample's own time, s."""
    _covered: CoveredTime = field(factory=CoveredTime)
    """By the samples' own times: silences, and clocks that begin anew, part them."""
    _gaps_covered: int = 0
    """Gaps that lie within a stretch ..."""
    _gap_time_covered: float = 0.0
    """... and their time, s."""
    _recent: deque[float] = field(factory=lambda: deque(maxlen=MOST_SAMPLES))
    """When the newest samples came."""
    _recent_start: float = 0.0
    """When the first of an unbroken row of them came: a stream that has just begun is not slow."""
    _losses: RecentLoss = field(factory=RecentLoss)

    def add_packet(self, t: float) -> None:
        """A packet of samples came at `t` s, and was used."""
        self.received += 1
        self._losses.add(t, 1, 0)

    def add_sample(self, t: float, known_at: float) -> None:
        """A sample of `t` s was used, which came at `known_at`. What is said of the same one again does not count."""
        if t == self._t:
            return
        self._t, self.last_sample_at, self.counted = t, known_at, True
        self.samples += 1
        self._covered.add(t)
        if self._recent and known_at < self._recent[-1] - SET_BACK:
            self._recent.clear()
        if not self._recent:
            self._recent_start = known_at
        self._recent.append(known_at)
        if self.broken_at is None or known_at > self.broken_at + STRAGGLER_TIME:
            self.broken_at, self._fresh, self._stale = None, True, False

    def add_event(self, event: Event) -> None:
        """An event of this link."""
        match event:
            case PacketsLost(count=count):
                self.lost += count
                self._losses.add(event.known_at, 0, count)
            case PacketRejected(reason=reason):
                self.rejected["packets", reason.value] += 1
            case SampleRejected(reason=reason):
                self.rejected["samples", reason.value] += 1
            case PacketsDropped(count=count):
                self.dropped += count
            case SampleGap(duration=duration):
                self.gaps += 1
                self.gap_time += duration
                if self._covered.first is not None:
                    self._gaps_covered += 1
                    self._gap_time_covered += duration
            case ClockReset():
                self.clock_resets += 1
                self._covered.close()
            case StreamStale():
                self.silences += 1
                self._stale = True
                self._covered.close()
            case StreamResumed():
                self._stale = False
            case StreamRestarted():
                self.restarts += 1
            case Connected(name=name, signal=signal):
                self.connections += 1
                self.name, self.signal, self.trouble = name or self.name, signal, ""
                self.broken_at, self._fresh, self._stale = None, False, False
            case Disconnected():
                self.broken_at, self._fresh = event.known_at, False
                self._covered.close()
            case BatteryLevel(level=level):
                self.battery = level
            case LinkTrouble(what=what):
                self.trouble = what
            case _:
                pass

    @property
    def rate(self) -> float | None:
        """Samples a second since the start, outside gaps and silences; None of fewer than two in a row."""
        span = self._covered.total - self._gap_time_covered
        intervals = self.samples - self._covered.count - self._gaps_covered
        return intervals / span if span > 0.0 and intervals > 0 else None

    def recent_rate(self, now: float) -> float | None:
        """Samples a second that came in the 2 s before `now`; None where they are not counted."""
        while self._recent and self._recent[0] <= now - WINDOW:
            self._recent.popleft()
        if not self.counted:
            return None
        return len(self._recent) / min(WINDOW, max(now - self._recent_start, 0.5 * WINDOW))

    @property
    def loss(self) -> float | None:
        """Share of the packets sent since the start that were lost; None where none came."""
        return self.lost / (self.received + self.lost) if self.received else None

    def recent_loss(self, now: float) -> float | None:
        """Share of the packets sent in the 10 s before `now` that were lost; None where none came."""
        return self._losses.share(now)

    def state(self, now: float) -> str:
        """In a word: "waiting" for the first sample over this connection, "ok", "silent" when nothing comes any more,
        "lost" when the connection is."""
        if self.broken_at is not None:
            return "lost"
        if self._stale:
            return "silent"
        if not self.counted:
            return "ok"
        if not self._fresh:
            return "waiting"
        return "ok" if now <= self.silent_from else "silent"

    @property
    def silent_from(self) -> float:
        """From when on it is silent if nothing comes any more."""
        return inf if self.last_sample_at is None else self.last_sample_at + SILENT_AFTER
