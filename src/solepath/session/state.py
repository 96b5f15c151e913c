"""State of a session: the wearer, and the decoders of the worn devices; and how packets and samples change it."""

from __future__ import annotations

from collections.abc import Iterable

from ..events import ClockReset, Event, PacketRejected, SampleRejected
from ..link.decoder import Decoder
from ..link.kinds import DeviceKinds
from ..types import Packet, Sample, Site
from ..types.attrs import define, evolve, field
from ..types.plain import has_floats, number, text, with_floats
from .wearer import WearerParts, sort_by_key

VERSION = 3
"""Version of the state, increased by 1 with every release that changes state or settings; no other can be restored."""


@define
class SessionState:
    """The whole state of a session."""

    wearer: WearerParts
    now: float | None = field(default=None, init=False)
    """Newest known time, s, packets' clock; None before the first."""
    decoders: dict[Site, Decoder] = field(factory=dict, init=False)
    finished: bool = field(default=False, init=False)

    def feed_sample(self, sample: Sample) -> list[Event]:
        """Add a sample; raise TypeError for one whose values are no numbers."""
        if not isinstance(sample.site, Site):
            raise TypeError(f"site of a sample is a Site, not {sample.site!r:.80}")
        if not has_floats(sample):
            sample = with_floats(sample)
        events = self.wearer.feed(sample)
        rejected = events and any([isinstance(event, SampleRejected) for event in events])
        if not rejected and (self.now is None or sample.t > self.now):
            self.now = sample.t
        return events

    def feed_packet(self, packet: Packet, kinds: DeviceKinds) -> list[Event]:
        """Add a packet of one of these kinds of devices; raise TypeError for one of wrong types."""
        site, data, events = packet.site, packet.data, list[Event]()
        is_text = isinstance(packet.channel, str) and isinstance(packet.device, str)
        if not (is_text and isinstance(site, Site) and isinstance(data, bytes | bytearray | memoryview)):
            wrong = "data" if is_text else "device" if isinstance(packet.channel, str) else "channel"
            wrong = wrong if isinstance(site, Site) else "site"
            fault = f"this {wrong} is {getattr(packet, wrong)!r:.40}"
            raise TypeError(f"a packet holds a time, a Site, a channel's name, bytes and a device's address; {fault}")
        texts_plain = packet.device.__class__ is packet.channel.__class__ is str
        if not (texts_plain and packet.t.__class__ is float and data.__class__ is bytes):
            t, channel, device = number("t of a packet", packet.t), text(packet.channel), text(packet.device)
            packet = evolve(packet, t=t, channel=channel, data=bytes(data), device=device)
        decoder = self.decoders.get(site) or Decoder(site)
        newest_arrival = decoder.newest_arrival
        items = decoder.feed(packet, kinds)
        if not decoder.used:
            # a rejected packet changes nothing, so time does not pass with it either
            if site not in self.decoders:
                return [event for event in items if isinstance(event, PacketRejected)]
            self.use_items(site, items, events)
            return events
        if site not in self.decoders:
            self.decoders = sort_by_key({**self.decoders, site: decoder}, Site)
        for other_site, other_decoder in self.decoders.items():
            if other_site is not site and (other_items := other_decoder.advance(packet.t, kinds)):
                self.use_items(other_site, other_items, events)
        if newest_arrival is not None and packet.t < newest_arrival:
            self.now = packet.t  # a clock that one site shows to be set back is set back for all
            for other_site, other in self.decoders.items():
                if other_site is not site and other.newest_arrival is not None and other.newest_arrival > packet.t:
                    self.use_items(other_site, other.restart_clock(packet.t), events)
        if self.now is None or packet.t > self.now:
            self.now = packet.t
        if decoder.link is not None:
            until = decoder.link.unsettled_until
            if until != self.wearer.unsettled.get(site):
                self.wearer.unsettle(site, until)
        self.use_items(site, items, events)
        return events

    def advance(self, now: float, kinds: DeviceKinds) -> list[Event]:
        """Let time pass until `now`, s, packets' clock."""
        if self.now is None or now > self.now:
            self.now = now
        events: list[Event] = []
        for decoder in self.decoders.values():
            self.use_items(decoder.site, decoder.advance(now, kinds), events)
        return events

    def restart_clock(self, now: float) -> list[Event]:
        """Continue at `now`, s, on a clock that restarted or was set, for packets and for samples."""
        events: list[Event] = []
        for site in Site:
            decoder = self.decoders.get(site)
            if decoder is not None:
                self.use_items(site, decoder.restart_clock(now), events)
            elif site.foot in self.wearer.feet:
                reset = ClockReset(t=now, known_at=now, site=site, restarted=False)
                events += self.wearer.receive(site, reset)
            else:
                self.wearer.reset(site)
        self.now = now
        return events

    def finish(self) -> list[Event]:
        """Return the events that were held back; nothing is fed after this."""
        events: list[Event] = []
        for decoder in self.decoders.values():
            self.use_items(decoder.site, decoder.finish(), events)
        if self.now is not None:
            events += self.wearer.finish(self.now)
        self.finished = True
        return events

    def use_items(self, site: Site, items: Iterable[Sample | Event], events: list[Event]) -> None:
        """Pass the samples and events of a link to the wearer, and add the events that follow."""
        for item in items:
            events += self.wearer.feed(item) if isinstance(item, Sample) else self.wearer.receive(site, item)
