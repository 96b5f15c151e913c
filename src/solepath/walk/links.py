"""Counts what came over each sensor's link: packets, losses, sample rate, gaps and silences.

Only this file defines the figures of links that terminal, page, report and summary show, and link/health.py those of
the last seconds. They are counted from the packets that a session was fed and from the events that it reported. Numbers
without a source were chosen by hand and not swept."""

from __future__ import annotations

from collections import Counter, deque
from math import inf

from attrs import define, field

from ..events import (
    BatteryLevel,
    ClockReset,
    Connected,
    DefectFound,
    Disconnected,
    Event,
    HeelStrike,
    LinkTrouble,
    PacketRejected,
    PacketsDropped,
    Rejection,
    SampleGap,
    SampleRejected,
    StreamRestarted,
    StreamResumed,
    StreamStale,
    ToeOff,
)
from ..foot.rhythm import longest_loss
from ..link.health import RecentLink, missing_samples
from ..types.attrs import NOT_SAVED

SET_BACK_TOLERANCE = 1.0
"""Longest time by which a moment may lie before the latest one, s; farther back, the clock was set back."""
RATE_WINDOW = 2.0
"""Time over which the recent sample rate is counted, s."""
MIN_RATE_TIME = 0.5 * RATE_WINDOW
"""Least time by which the number of recent samples is divided, s: a stream that has just started is not fast."""
MAX_RATE_SAMPLES = 1000
"""Largest number of samples that the recent rate counts: 500 a second."""
SILENCE_TIME = 1.5
"""Time without a sample after which a link counts as silent, even if the session has not reported it yet, s."""
MAX_CHANNELS = 100
"""Largest number of unknown channels of a site that are remembered by name."""
DELAY_PARTS, DELAY_COUNT = ("sensor", "radio", "decision"), 200
"""Parts of the delay of an event, and the number of newest events of a foot whose delays are kept: of some minutes."""
NO_DEVICE = ("device", "receiver")
"""Prefixes of channels that belong to no kind of device."""
STRAGGLER_TIME = 1.0
"""Time after the end of a connection within which a sample does not mean that there is a new connection, s."""


@define
class CoveredTime:
    """The total duration of spans of time, s; a span ends where a clock is set back."""

    span_count: int = 0
    span_start: float | None = None
    """Start of the present span, s; None between two spans."""
    span_end: float = 0.0
    """Latest moment of the present span, s."""
    _ended_time: float = 0.0
    """Total duration of the spans that have ended, s."""

    def add(self, t: float) -> None:
        """Add the moment `t` of a packet or sample, s."""
        if self.span_start is not None and t < self.span_end - SET_BACK_TOLERANCE:
            self.close()
        if self.span_start is None:
            self.span_count += 1
            self.span_start = self.span_end = t
        self.span_start, self.span_end = min(self.span_start, t), max(self.span_end, t)

    def close(self) -> None:
        """End the span: the next moment starts another one."""
        self._ended_time, self.span_start = self.total, None

    @property
    def total(self) -> float:
        """Total duration of all spans, s."""
        return self._ended_time + (0.0 if self.span_start is None else self.span_end - self.span_start)


@define
class Delays:
    """How late the newest heel-strikes and toe-offs of a foot were known, DELAY_COUNT of them, in three parts, s.

    *sensor* is the time from the event to the last sample that it needed, and *radio* from there to the arrival of that
    sample: beyond the least delay of the link, which is in the sample's time. *decision* is the time from then until
    the session has returned the event, the wait in the program included; only the program can say when that was."""

    parts: deque[tuple[float, float, float | None]] = field(factory=lambda: deque(maxlen=DELAY_COUNT))
    _figures: dict[str, tuple[float, float]] | None = field(default=None, eq=False, metadata=NOT_SAVED)
    """Figures of these parts; None after another event, since a page asks thirty times a second."""

    def add(self, event: HeelStrike | ToeOff, returned_at: float | None) -> None:
        """Add an event that the session returned at `returned_at`, s, on the packets' clock; None if unknown."""
        is_revision = isinstance(event, HeelStrike) and event.revises is not None
        if not (event.inferred or is_revision):
            decision = None if returned_at is None else max(0.0, returned_at - event.known_at)
            self.parts.append((event.sampled_at - event.t, event.known_at - event.sampled_at, decision))
            self._figures = None

    @property
    def figures(self) -> dict[str, tuple[float, float]]:
        """Median and 95th percentile of each part that is known, s."""
        if self._figures is None:
            self._figures = {}
            for name, values in zip(DELAY_PARTS, zip(*self.parts, strict=True), strict=False):
                ordered = sorted([value for value in values if value is not None])
                if ordered:
                    last = len(ordered) - 1
                    self._figures[name] = ordered[last // 2], ordered[round(0.95 * last)]
        return self._figures


@define
class LinkLedger:
    """The counts of the link of one site since the start, in bounded memory.

    Times are arrivals in s, unless a field says otherwise. `is_counted` says whether samples of this site are counted:
    always for a foot, for another site from its first sample on."""

    is_counted: bool = True
    received: int = 0
    """Packets of samples that came and were used. The fragments of a frame count as one packet, when a sample is
    complete. The count is 0 where samples are fed without packets, and for a device that the walk does not know."""
    lost: int = 0
    """Samples that were counted as lost (`SampleGap.count`). A packet that was rejected because it came twice is not
    lost. One that came damaged or late, or that the receiver dropped, is."""
    dropped: int = 0
    """Packets that came and were discarded because the program did not read them in time (PacketsDropped)."""
    packets: int = 0
    """Packets that came, used or not, without those of the receiver itself."""
    rejected: Counter[tuple[str, str]] = field(factory=Counter)
    """Number of rejected packets and samples by ("packets" or "samples", reason)."""
    unknown: Counter[str] = field(factory=Counter)
    """Number of packets of channels that no device has, or not the one at this site, by channel; the first MAX_CHANNELS
    channels, and of all others together under ""."""
    samples: int = 0
    """Number of used samples with different times. A sample of a foot counts when it was fed as a sample, or when the
    session reported its position or pressure (FootMoved, FootPressed). For another site, and for a foot until the
    session reports either, all samples in its packets count."""
    has_motion: bool = False
    """True from the first sample of an inertial sensor on."""
    has_pressure: bool = False
    """True from the first sample of pressure cells on."""
    gaps: int = 0
    """Number of losses (`SampleGap.gaps` of those with a count); an absence is none."""
    ended_absences: float = 0.0
    """Total duration, s, of the absences that have ended."""
    silences: int = 0
    """Number of times that nothing came for longer than the link allows (StreamStale)."""
    connections: int = 0
    clock_resets: int = 0
    """Number of times that the device's or the receiver's clock jumped or restarted (ClockReset)."""
    restarts: int = 0
    """Number of times that a connected device was set up again because it sent nothing (StreamRestarted)."""
    battery: float | None = None
    """Charge of the battery as the device last reported it, 0 to 1."""
    name: str = ""
    """Name of the device; empty while it is not known."""
    signal: int | None = None
    """Signal strength of the last advertisement before the connection, dBm."""
    rejected_at: float | None = None
    """Moment at which a packet or sample that had not come before was rejected, s; None before any."""
    rejected_all: bool = False
    """True if all that came was rejected while the other foot walked on."""
    delays: Delays = field(factory=Delays)
    trouble: str = ""
    """The last LinkTrouble, or defect that spoils; empty again when the device is connected."""
    last_sample_at: float | None = None
    """Arrival of the newest sample, s."""
    broken_at: float | None = None
    """Moment at which the connection broke, s; None while there is a connection."""
    _has_samples: bool = False
    """True from the first sample of the present connection on."""
    _stale: bool = False
    """True after the session has reported that nothing comes any more."""
    _t: float | None = None
    """Time of the newest sample by its own clock, s."""
    _covered: CoveredTime = field(factory=CoveredTime)
    """Time covered by the samples' own times; absences and restarted clocks split it into spans."""
    _recent: deque[float] = field(factory=lambda: deque(maxlen=MAX_RATE_SAMPLES))
    """Arrivals of the newest samples, s."""
    _recent_start: float = 0.0
    """Arrival of the first sample after `_recent` was empty, s: the time before it does not lower the rate."""
    _losses: RecentLink = field(factory=RecentLink)

    def add_packet(self, t: float) -> None:
        """Add a packet of samples that came at `t` s and was used."""
        self.received += 1
        self._losses.add(t, packets=1)

    def add_sample(self, t: float, known_at: float) -> None:
        """Add a used sample of time `t` that came at `known_at`, both s; a repeated `t` does not count."""
        if t == self._t:
            return
        self._t, self.last_sample_at, self.is_counted = t, known_at, True
        self.samples += 1
        self._losses.add(known_at, samples=1)
        self._covered.add(t)
        if self._recent and known_at < self._recent[-1] - SET_BACK_TOLERANCE:
            self._recent.clear()
        if not self._recent:
            self._recent_start = known_at
        self._recent.append(known_at)
        if self.broken_at is None or known_at > self.broken_at + STRAGGLER_TIME:
            self.broken_at, self._has_samples, self._stale = None, True, False

    def add_event(self, event: Event, now: float) -> None:
        """Count an event of this link that came at `now`, s; other events change nothing."""
        if isinstance(event, PacketRejected | SampleRejected) and event.reason is not Rejection.DUPLICATE:
            self.rejected_at = now
        match event:
            case PacketRejected(reason=reason, channel=channel, count=count):
                self.rejected["packets", reason.value] += count
                if reason is Rejection.UNKNOWN_CHANNEL:
                    is_named = channel in self.unknown or len(self.unknown) < MAX_CHANNELS
                    self.unknown[channel if is_named else ""] += count
            case SampleRejected(reason=reason, count=count):
                self.rejected["samples", reason.value] += count
            case PacketsDropped(count=count):
                self.dropped += count
            case SampleGap(duration=duration, count=count, gaps=gaps):
                self.gaps += gaps if count > 0 else 0
                self.lost += count
                self._losses.add(event.known_at, missing=count)
                if count == 0:
                    self.ended_absences += duration
                    self._covered.close()
            case ClockReset():
                self.clock_resets += 1
                self._covered.close()
            case StreamStale():
                self.silences += 1
                self._stale = True
            case StreamResumed():
                self._stale = False
            case StreamRestarted():
                self.restarts += 1
            case Connected(name=name, signal=signal):
                self.connections += 1
                self.name, self.signal, self.trouble = name or self.name, signal, ""
                self.broken_at, self._has_samples, self._stale = None, False, False
            case Disconnected():
                self.broken_at, self._has_samples = event.known_at, False
            case BatteryLevel(level=level):
                self.battery = level
            case LinkTrouble(what=what) | DefectFound(what=what, needs_action=True):
                self.trouble = what

    @property
    def rate(self) -> float | None:
        """Samples that the device took a second while it was connected; None before the second one."""
        time, intervals = self._covered.total, self.samples + self.missing - self._covered.span_count
        return intervals / time if time > 0.0 and intervals > 0 else None

    def recent_rate(self, now: float) -> float | None:
        """Return the samples a second in the RATE_WINDOW before `now`, s; None where samples are not counted."""
        while self._recent and self._recent[0] <= now - RATE_WINDOW:
            self._recent.popleft()
        if not self.is_counted:
            return None
        return len(self._recent) / min(RATE_WINDOW, max(now - self._recent_start, MIN_RATE_TIME))

    @property
    def missing(self) -> int:
        """Number of samples that the device took and that did not arrive."""
        return round(missing_samples(self.lost, self.samples, self.received))

    @property
    def taken(self) -> int:
        """Number of samples that the device took while it was connected."""
        return self.missing + (self.samples or self.received)

    def absent_time(self, now: float) -> float:
        """Return for how long, until `now`, s, the device was not connected, was silent or took no samples, s."""
        silence = 0.0 if self.last_sample_at is None else now - self.last_sample_at
        is_silent = not self.received and silence > longest_loss(1.0 / (self.rate or inf))  # no link reports it
        is_absent = is_silent or self._stale or not self._has_samples
        return self.ended_absences + (max(0.0, silence) if is_absent else 0.0)

    @property
    def missing_share(self) -> float:
        """Share, 0 to 1, of these samples that are missing; 0 without samples."""
        return self.missing / self.taken if self.taken else 0.0

    @property
    def missing_time(self) -> float:
        """Total duration of what is missing, s: its number times the interval between samples."""
        return self.missing / self.rate if self.rate else 0.0

    def still_rejects(self, now: float) -> bool:
        """Return whether something came shortly before `now`, s, and was rejected."""
        return self.rejected_at is not None and now - self.rejected_at <= SILENCE_TIME

    def recent_share(self, now: float) -> float | None:
        """Return the share, 0 to 1, of the samples of the LOSS_WINDOW before `now`, s, that are missing."""
        return self._losses.share(now)

    def state(self, now: float) -> str:
        """Return the state of the link at `now`, s: "waiting", "ok", "silent" or "lost".

        A link is "waiting" before the first sample of its connection, "silent" when nothing comes any more, and "lost"
        when the connection is broken. While its samples are not counted, it is "ok"."""
        if self.broken_at is not None:
            return "lost"
        if self._stale:
            return "silent"
        if not self.is_counted:
            return "ok"
        if not self._has_samples:
            return "waiting"
        return "ok" if now <= self.silent_from else "silent"

    @property
    def silent_from(self) -> float:
        """Moment from which the link is silent if nothing more comes, s."""
        return inf if self.last_sample_at is None else self.last_sample_at + SILENCE_TIME
