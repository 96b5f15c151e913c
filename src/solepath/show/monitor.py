"""A session with what a person wants to know of it meanwhile: the track so far, counts, and how the links do."""

from __future__ import annotations

from collections import deque
from math import hypot

from attrs import define, field

from ..events import BatteryLevel, Connected, Disconnected, Event, FootMoved, LinkTrouble, PacketRejected, PacketsLost
from ..link.decoder import Decoder
from ..session import Session
from ..types import SITE_OF_FOOT, Foot, Packet, Sample, Site
from .tally import Tally, streamed, whole

SPACING = 0.15
"""m between the points of the track that is drawn."""
LONGEST = 4000
"""Points that are kept of it."""
WINDOW = 2.0
"""s over which a rate is counted."""


@define
class LinkHealth:
    """One site's link. `samples`: that were used; `came`: packets of samples that were; `lost`: packets known never to
    have come."""

    connected: bool = False
    name: str = ""
    signal: int | None = None
    """With which the device last advertised, dBm."""
    battery: float | None = None
    """0 to 1."""
    samples: int = 0
    came: int = 0
    lost: int = 0
    connections: int = 0
    trouble: str = ""
    """The last one, until the device is connected again."""
    _sampled_at: deque[float] = field(factory=deque)

    @property
    def loss(self) -> float | None:
        """Share of the packets that were lost."""
        return self.lost / (self.came + self.lost) if self.came else None

    def sampled(self, t: float) -> None:
        """A sample of `t` s was used."""
        self.samples += 1
        self._sampled_at.append(t)
        self.rate(t)

    def rate(self, now: float) -> float:
        """Samples a second of late."""
        while self._sampled_at and self._sampled_at[0] <= now - WINDOW:
            self._sampled_at.popleft()
        return len(self._sampled_at) / WINDOW

    def heard(self, event: Event) -> None:
        match event:
            case Connected():
                self.connected, self.name, self.signal, self.trouble = True, event.name, event.signal, ""
                self.connections += 1
            case Disconnected():
                self.connected = False
            case BatteryLevel(level=level):
                self.battery = level
            case PacketsLost(channel=channel, count=count) if streamed(channel):
                self.lost += count
            case PacketRejected(channel=channel) if streamed(channel):
                self.came = max(0, self.came - 1)
            case LinkTrouble(what=what):
                self.trouble = what


@define
class Monitor:
    """Feeds `session`, which must have been made with `poses=True`, and keeps count."""

    session: Session
    tally: Tally = field(factory=Tally)
    links: dict[Site, LinkHealth] = field(factory=dict)
    track: list[tuple[Foot, float, float]] = field(factory=list)
    """Where the feet went, thinned to SPACING, m."""
    now: float = 0.0
    """Arrival of the newest packet, s."""
    _drawn: dict[Foot, tuple[float, float]] = field(factory=dict)
    _elsewhere: dict[Site, Decoder] = field(factory=dict)
    """What counts the samples of sites that are no feet: a session has no use for them."""

    def take(self, packet: Packet) -> list[Event]:
        """What `Session.feed` says of it."""
        return self.heard(packet, self.session.feed(packet))

    def heard(self, packet: Packet, events: list[Event]) -> list[Event]:
        """A packet, and what a session said of it."""
        self.now = packet.t
        self.tally.fed_packet(packet)
        if whole(packet):
            self.link(packet.site).came += 1
        if packet.site.foot is None:
            decoder = self._elsewhere.setdefault(packet.site, Decoder(packet.site))
            for item in decoder.feed(packet):
                if isinstance(item, Sample):
                    self.link(packet.site).sampled(item.t)
        return self.count(events)

    def finish(self) -> list[Event]:
        """What `Session.finish` says."""
        return self.count(self.session.finish())

    def link(self, site: Site) -> LinkHealth:
        return self.links.setdefault(site, LinkHealth())

    def count(self, events: list[Event]) -> list[Event]:
        """What a session said, of a packet or not."""
        for event in events:
            self.tally.add(event)
            if isinstance(event, FootMoved):
                self._draw(event)
            elif (site := getattr(event, "site", None)) is not None:
                self.link(site).heard(event)
        return events

    def _draw(self, event: FootMoved) -> None:
        self.link(SITE_OF_FOOT[event.foot]).sampled(event.t)
        x, y, _ = event.position
        last = self._drawn.get(event.foot)
        if (last is None or hypot(x - last[0], y - last[1]) > SPACING) and len(self.track) < LONGEST:
            self._drawn[event.foot] = (x, y)
            self.track.append((event.foot, x, y))
