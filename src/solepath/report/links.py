"""What came from each sensor, counted."""

from __future__ import annotations

from attrs import define, field

from ..events import (
    BatteryLevel,
    Connected,
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
from ..types import SITE_OF_FOOT, Site


@define
class Link:
    """Of one site."""

    moved: int = 0
    """Samples with a position ..."""
    pressed: int = 0
    """... and with pressure."""
    first: float | None = None
    last: float | None = None
    gaps: int = 0
    gap_time: float = 0.0
    lost: int = 0
    rejected: int = 0
    silent: int = 0
    connections: int = 0
    battery: float | None = None
    """The last that was told, 0 to 1."""
    name: str = ""

    def seen(self, t: float) -> None:
        self.first = t if self.first is None else min(self.first, t)
        self.last = t if self.last is None else max(self.last, t)

    @property
    def rate(self) -> float | None:
        """Samples a second outside gaps."""
        if self.first is None or self.last is None:
            return None
        span = self.last - self.first - self.gap_time
        intervals = max(self.moved, self.pressed) - 1 - self.gaps
        return intervals / span if span > 0.0 and intervals > 0 else None


@define
class Links:
    """Of all sites that were heard of."""

    sites: dict[Site, Link] = field(factory=dict)

    def of(self, site: Site) -> Link:
        return self.sites.setdefault(site, Link())

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
                self.of(site).gaps += 1
                self.of(site).gap_time += duration
            case PacketsLost(site=site, count=count) | PacketsDropped(site=site, count=count):
                self.of(site).lost += count
            case PacketRejected(site=site) | SampleRejected(site=site):
                self.of(site).rejected += 1
            case StreamStale(site=site):
                self.of(site).silent += 1
            case Connected(site=site, name=name):
                self.of(site).connections += 1
                self.of(site).name = name or self.of(site).name
            case BatteryLevel(site=site, level=level):
                self.of(site).battery = level
            case _:
                pass
