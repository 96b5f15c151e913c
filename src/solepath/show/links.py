"""Counts what came over each sensor's link: packets, losses, sample rate, gaps and silences.

Terminal, page, report and summary read their figures of links from here, and only here the figures are defined. They
are counted from the packets that a session was fed and from the events that it reported of them."""

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
from ..link.kinds import BUILT_IN_KINDS
from ..types import Packet
from ..wire.fragment import is_fragment

SET_BACK = 1.0
"""Time that a moment may lie before the latest one, s; if it lies farther back, the clock was set back."""
WINDOW = 2.0
"""Time over which the recent sample rate is counted, s."""
MOST_SAMPLES = 1000
"""Samples that the recent rate counts at the most: 500 a second."""
LOSS_WINDOW = 10
"""Time over which the recent loss is counted, in whole seconds; an outage that ended earlier no longer counts."""
SILENT_AFTER = 1.5
"""Time without a sample after which a link is silent, whether or not the session has reported it, s."""
STRAGGLER_TIME = 1.0
"""Time after a broken connection in which a sample that still comes is no sign of a new connection, s."""


def is_sample_channel(channel: str) -> bool:
    """Return whether samples come on this channel of a device that solepath knows."""
    kind = BUILT_IN_KINDS.get(channel.partition("/")[0])
    return kind is not None and channel in kind.profile.streams


def is_frame_fragment(packet: Packet) -> bool:
    """Return whether the packet is a fragment of a frame that was too long for one packet."""
    return packet.channel == "insole/frame" and is_fragment(packet.data)


@define
class CoveredTime:
    """Time that is covered by stretches within which no clock was set back, s."""

    count: int = 0
    first: float | None = None
    """Start of the stretch that is going on, s; None between two stretches."""
    last: float = 0.0
    """Latest moment of the stretch that is going on, s."""
    _before: float = 0.0
    """Total duration of the stretches that have ended, s."""

    def add(self, t: float) -> None:
        """Add the moment `t`, in s, at which something came."""
        if self.first is not None and t < self.last - SET_BACK:
            self.close()
        if self.first is None:
            self.count += 1
            self.first = self.last = t
        self.first, self.last = min(self.first, t), max(self.last, t)

    def close(self) -> None:
        """End the stretch: what comes next does not continue it."""
        self._before, self.first = self.total, None

    @property
    def total(self) -> float:
        """Total duration of all stretches, s."""
        return self._before + (0.0 if self.first is None else self.last - self.first)


@define
class RecentLoss:
    """Received and lost packets of samples in the last seconds."""

    seconds: deque[list[int]] = field(factory=lambda: deque(maxlen=LOSS_WINDOW + 1))
    """Lists [second, received, lost] for each second in which there were any packets."""

    def add(self, t: float, received: int, lost: int) -> None:
        """Add packets that were received or lost at `t` s."""
        second = floor(t)
        if not self.seconds or not self.seconds[-1][0] - 1 <= second <= self.seconds[-1][0]:
            self.seconds.append([second, 0, 0])
        self.seconds[-1][1] += received
        self.seconds[-1][2] += lost

    def share(self, now: float) -> float | None:
        """Return the lost share of the packets sent in the window before `now`; None when none was received."""
        kept = [one for one in self.seconds if now - LOSS_WINDOW - 1.0 < one[0] <= now]
        received, lost = sum([one[1] for one in kept]), sum([one[2] for one in kept])
        return lost / (received + lost) if received else None


@define
class LinkLedger:
    """Counts of the link of one site since the start.

    Times are arrivals in s, unless a field says otherwise. Memory is bounded. `counted` says whether the samples of
    this site are seen here: those of a foot always are, those of another site once a packet of it was fed."""

    counted: bool = True
    received: int = 0
    """Packets of samples that came and were used. A frame that is sent in fragments is one packet; it is counted with
    the fragment that completes a sample. The count is 0 where samples are fed without packets, and for a device of an
    app's own."""
    lost: int = 0
    """Packets of samples that never came, by the device's counter or by the time between arrivals (PacketsLost). The
    time between arrivals counts for a device without a counter. A rejected packet is not lost for that reason: nothing
    is missing when a packet came twice or late. When a packet came damaged, or the receiver dropped it, the counter
    shows that it is missing."""
    dropped: int = 0
    """Packets that came and were discarded because the program did not take them in time (PacketsDropped)."""
    rejected: Counter[tuple[str, str]] = field(factory=Counter)
    """Packets and samples that came and could not be used, by "packets" or "samples" and the reason. They are counted
    from PacketRejected and SampleRejected."""
    samples: int = 0
    """Samples that were used, each with its own time. A sample of a foot counts when the session reported a position or
    a pressure of it (FootMoved, FootPressed) or when it was fed as a sample. Samples of another site are those that its
    packets hold."""
    has_motion: bool = False
    """True once there were samples of an inertial sensor."""
    has_pressure: bool = False
    """True once there were samples of pressure cells."""
    gaps: int = 0
    """Gaps between samples that are longer than the sensor's rate allows (SampleGap)."""
    gap_time: float = 0.0
    """Total duration of the gaps, each from the last sample before it to the first one after it, s."""
    silences: int = 0
    """Number of times at which nothing came for longer than the link allows (StreamStale)."""
    connections: int = 0
    clock_resets: int = 0
    """Number of times at which the device's or the receiver's clock jumped or restarted (ClockReset)."""
    restarts: int = 0
    """Number of times at which the receiver set up the device again, as it sent nothing over a standing connection."""
    battery: float | None = None
    """Charge of the battery as the device last reported it, 0 to 1."""
    name: str = ""
    """Name of the device; empty while it is not known."""
    signal: int | None = None
    """Signal strength of the last advertisement before the connection, dBm."""
    trouble: str = ""
    """The last LinkTrouble; empty again when the device is connected."""
    last_sample_at: float | None = None
    """Arrival of the newest sample, s."""
    broken_at: float | None = None
    """Moment at which the connection broke, s; None while there is one."""
    _fresh: bool = False
    """True once samples have come over this connection."""
    _stale: bool = False
    """True after the session has reported that nothing comes any more."""
    _t: float | None = None
    """Time of the newest sample by its own clock, s."""
    _covered: CoveredTime = field(factory=CoveredTime)
    """Time covered by the samples' own times; silences and restarted clocks split it into stretches."""
    _gaps_covered: int = 0
    """Gaps that lie within a stretch of covered time."""
    _gap_time_covered: float = 0.0
    """Total duration of the gaps that lie within a stretch of covered time, s."""
    _recent: deque[float] = field(factory=lambda: deque(maxlen=MOST_SAMPLES))
    """Arrivals of the newest samples, s."""
    _recent_start: float = 0.0
    """Arrival of the first of them in an unbroken row, s: a stream that has just started is not slow."""
    _losses: RecentLoss = field(factory=RecentLoss)

    def add_packet(self, t: float) -> None:
        """Add a packet of samples that came at `t` s and was used."""
        self.received += 1
        self._losses.add(t, 1, 0)

    def add_sample(self, t: float, known_at: float) -> None:
        """Add a used sample of time `t` that came at `known_at`, both in s; a repeated `t` does not count."""
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
        """Add an event of this link."""
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
        """Samples a second since the start, without gaps and silences; None for fewer than two samples in a row."""
        span = self._covered.total - self._gap_time_covered
        intervals = self.samples - self._covered.count - self._gaps_covered
        return intervals / span if span > 0.0 and intervals > 0 else None

    def recent_rate(self, now: float) -> float | None:
        """Return the samples a second that came in the 2 s before `now`; None where they are not counted."""
        while self._recent and self._recent[0] <= now - WINDOW:
            self._recent.popleft()
        if not self.counted:
            return None
        return len(self._recent) / min(WINDOW, max(now - self._recent_start, 0.5 * WINDOW))

    @property
    def loss(self) -> float | None:
        """Share of the packets sent since the start that were lost; None when none came."""
        return self.lost / (self.received + self.lost) if self.received else None

    def recent_loss(self, now: float) -> float | None:
        """Return the share of the packets sent in the 10 s before `now` that were lost; None when none came."""
        return self._losses.share(now)

    def state(self, now: float) -> str:
        """Return the state of the link at `now`: "waiting", "ok", "silent" or "lost".

        "waiting" is before the first sample over this connection, "silent" when nothing comes any more, "lost" when the
        connection is broken."""
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
        """Moment from which the link is silent if nothing more comes, s."""
        return inf if self.last_sample_at is None else self.last_sample_at + SILENT_AFTER
