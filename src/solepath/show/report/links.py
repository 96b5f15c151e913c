"""What came from each sensor, counted."""

from __future__ import annotations

from attrs import define, field

from ...events import (
    BatteryLevel,
    ClockReset,
    Connected,
    Disconnected,
    Event,
    FootMoved,
    FootPressed,
    PacketRejected,
    PacketsDropped,
    PacketsLost,
    SampleGap,
    SampleRejected,
    StreamStale,
)
from ...types import SITE_OF_FOOT, Site

BACK = 1.0
"""s by which no sample is late: earlier ones are of a clock that was set back."""


@define
class Covered:
    """Time that is covered by stretches of samples, s."""

    stretches: int = 0
    before: float = 0.0
    """By all stretches but the one that is going on ..."""
    first: float | None = None
    last: float = 0.0
    """... which is from here to here."""

    def add(self, t: float) -> None:
        if self.first is not None and t < self.last - BACK:
            self.close()
        if self.first is None:
            self.stretches += 1
            self.first = self.last = t
        self.first, self.last = min(self.first, t), max(self.last, t)

    def close(self) -> None:
        """What comes next does not go on from what came."""
        self.before, self.first = self.total, None

    @property
    def total(self) -> float:
        return self.before + (0.0 if self.first is None else self.last - self.first)


@define
class ReportLink:
    """Of one site."""

    moved: int = 0
    """Samples with a position ..."""
    pressed: int = 0
    """... and with pressure."""
    heard: Covered = field(factory=Covered)
    """Without silences ..."""
    lasted: Covered = field(factory=Covered)
    """... and with them: stretches are what no clock was set back in."""
    gaps: int = 0
    gap_time: float = 0.0
    within: int = 0
    """Gaps within what was heard ..."""
    within_time: float = 0.0
    """... and their time."""
    lost: int = 0
    rejected: int = 0
    silent: int = 0
    connections: int = 0
    battery: float | None = None
    """The last that was told, 0 to 1."""
    name: str = ""

    def seen(self, t: float) -> None:
        self.heard.add(t)
        self.lasted.add(t)

    def gap(self, duration: float) -> None:
        self.gaps += 1
        self.gap_time += duration
        if self.heard.first is not None:  # or it was silent, or its clock began anew
            self.within += 1
            self.within_time += duration

    @property
    def rate(self) -> float | None:
        """Samples a second outside gaps and silences."""
        span = self.heard.total - self.within_time
        intervals = max(self.moved, self.pressed) - self.heard.stretches - self.within
        return intervals / span if span > 0.0 and intervals > 0 else None


@define
class Links:
    """Of all sites that were heard of."""

    sites: dict[Site, ReportLink] = field(factory=dict)

    def of(self, site: Site) -> ReportLink:
        return self.sites.setdefault(site, ReportLink())

    def hear(self, event: Event) -> None:
        """Any event."""
        match event:
            case FootMoved(t=t, foot=foot):
                one = self.of(SITE_OF_FOOT[foot])
                one.moved += 1
                one.seen(t)
            case FootPressed(t=t, foot=foot):
                one = self.of(SITE_OF_FOOT[foot])
                one.pressed += 1
                one.seen(t)
            case SampleGap(site=site, duration=duration):
                self.of(site).gap(duration)
            case PacketsLost(site=site, count=count) | PacketsDropped(site=site, count=count):
                self.of(site).lost += count
            case PacketRejected(site=site) | SampleRejected(site=site):
                self.of(site).rejected += 1
            case StreamStale(site=site):
                self.of(site).silent += 1
                self.of(site).heard.close()
            case ClockReset(site=site) | Disconnected(site=site):
                self.of(site).heard.close()
            case Connected(site=site, name=name):
                self.of(site).connections += 1
                self.of(site).name = name or self.of(site).name
            case BatteryLevel(site=site, level=level):
                self.of(site).battery = level
            case _:
                pass

    def lasted(self) -> float | None:
        """How long samples came, s, where a clock was set back meanwhile, so that first and last time do not tell."""
        if all(one.lasted.stretches < 2 for one in self.sites.values()):
            return None
        return max(one.lasted.total for one in self.sites.values())
