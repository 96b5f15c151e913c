"""The link of one site, which turns packets into samples and link events.

This module does the work that is the same for all devices: it checks the arrival time and the device's address, and it
handles silence, battery and firmware. The first usable packet shows the kind of device by its channel's prefix.
Bytes and clocks are handled in devices/ and, for declared devices, in stream.py; kinds.py has the table of all kinds.
An app that adds devices passes its own table with every call, because the table holds functions and a decoder is data.

A decoder may be made with the address of its device (`Packet.device`); otherwise the first packet with an address binds
the site to that device. Then packets of other devices, and packets without an address, are rejected; upper and lower
case are the same address. Only packets of channels receiver/..., which report on the receiver, need no address.

A packet is rejected when it arrived before the newest one. If twenty such packets come in a row, the receiver's clock
was set back: the twentieth gives ClockReset, and times restart earlier than before (protocol/clock.md). The count of
these packets is the only thing that a rejected packet changes here."""

from __future__ import annotations

from copy import deepcopy
from math import isfinite

from ..events import (
    BatteryLevel,
    ClockReset,
    Connected,
    PacketRejected,
    Rejection,
    SampleGap,
    StreamResumed,
    StreamStale,
)
from ..types import Packet, Sample, Site
from ..types.attrs import NOT_SAVED, define, evolve, field, fields
from ..types.records import MAX_TIME
from ..wire.error import WireError
from .counters import MIN_GAP
from .kinds import BUILT_IN_KINDS, DeviceKinds, DeviceLink, Output, is_address

SET_BACK_PACKETS = 20
"""Number of packets in a row with earlier arrivals that shows that the receiver's clock was set back."""


@define
class Decoder:
    """The link of one site: it finds out which device sends, and gives its packets to the link of that device.

    `feed` never raises an exception, whatever the packet. A rejected packet changes nothing except `backward_packets`;
    a rejected fragment also ends the frame that it is part of.
    Sample times strictly increase from one ClockReset to the next. A sample's `known_at` is the arrival of the packet
    that completed it, or `t` if that is later."""

    site: Site
    """Site whose packets are decoded."""
    device: str = ""
    """Address of the device that the site is bound to; "" before it is bound."""
    link: DeviceLink | None = None
    """Link of the device; None until one of its packets was used."""
    firmware: str = ""
    """Firmware revision of the device; "" until it is known."""
    newest_arrival: float | None = None
    """Arrival of the newest packet that was used, s."""
    backward_packets: int = 0
    """Number of packets rejected in a row because they arrived before the newest one."""
    newest_stream_arrival: float | None = None
    """Arrival of the newest packet of a channel that must not fall silent, s."""
    stale: bool = False
    """True from StreamStale until StreamResumed."""
    absent: bool = False
    """True from a silence or a new connection until the first sample after it.

    Samples that are missing before that one were not sent to this receiver: they are an absence and no loss."""
    used: bool = field(default=False, init=False, eq=False, metadata=NOT_SAVED)
    """Flag: the packet of the last `feed` was used, though it may report an earlier one that was rejected."""

    def feed(self, packet: Packet, kinds: DeviceKinds = BUILT_IN_KINDS) -> Output:
        """Return the samples and events of one packet, in the order in which they become known."""
        self.used = False
        try:
            if packet.device != self.device or packet.site is not self.site or not abs(packet.t) <= MAX_TIME:
                self._check(packet)
            if self.newest_arrival is None or packet.t >= self.newest_arrival:
                return self._use_packet(packet, kinds)
            if self.backward_packets + 1 >= SET_BACK_PACKETS:
                return self._restart(packet, kinds)
            self.backward_packets += 1
            detail = f"{self.newest_arrival - packet.t:.6g} s before the newest"
            raise WireError(Rejection.TIME_BACKWARDS, detail)
        except WireError as error:
            return [*error.earlier, *self._reject(packet, error.reason, error.detail)]

    def _check(self, packet: Packet) -> None:
        """Raise WireError for a packet of another site or device, or at an impossible time."""
        if not isfinite(packet.t):
            raise WireError(Rejection.NOT_FINITE, f"arrival time {packet.t}")
        if not -MAX_TIME <= packet.t <= MAX_TIME:
            raise WireError(Rejection.ABSURD, f"arrival time {packet.t:g} s")
        if packet.site is not self.site:
            raise WireError(Rejection.WRONG_SITE, f"of {packet.site.value}, not {self.site.value}")
        if not is_address(packet.device):
            raise WireError(Rejection.MALFORMED, f"device {packet.device!r:.80} is no address")
        speaks_for_itself = packet.device != "" or packet.channel.partition("/")[0] != "receiver"
        if self.device and speaks_for_itself and not self.is_bound_to(packet.device):
            detail = f"of {packet.device or 'nobody'}, not {self.device}; Session.bind lets another device send"
            raise WireError(Rejection.WRONG_DEVICE, detail)

    def advance(self, now: float, kinds: DeviceKinds = BUILT_IN_KINDS) -> Output:
        """Return the events of time that passes until `now`, s, without packets."""
        if self.link is None or self.stale or self.link.may_be_silent:
            return []
        kind = kinds.loaded.get(self.link.name) or kinds.get(self.link.name)
        newest = self.newest_stream_arrival
        limit = 0.0 if kind is None else max(kind.profile.stale_after, MIN_GAP * self.link.interval)
        if kind is None or newest is None or now - newest <= limit:
            return []
        self.stale = True
        return [*self.link.flush(now), self._silence(newest, now, limit)]

    def _silence(self, newest: float, now: float, limit: float) -> StreamStale:
        return StreamStale(t=newest + limit, known_at=now, site=self.site, silent_for=now - newest)

    def finish(self) -> Output:
        """Return the samples that still wait for other data; call it at the end of all data."""
        return [] if self.link is None or self.newest_arrival is None else self.link.flush(self.newest_arrival)

    def restart_clock(self, now: float) -> Output:
        """Restart times at `now`, s, because the receiver's clock restarted; return waiting samples and ClockReset.

        The next packet may have arrived earlier or later by the new clock; it starts a new fit."""
        out = self.finish()
        self.newest_arrival, self.absent, self.backward_packets = None, False, 0
        if self.newest_stream_arrival is not None:
            self.newest_stream_arrival = now
        if self.link is not None:
            self.link.restart_clock()
        out.append(ClockReset(t=now, site=self.site, restarted=False))
        return out

    def is_bound_to(self, device: str) -> bool:
        """Return whether the site is bound to this address, in upper or lower case; for "", whether it is not bound."""
        return device.upper() == self.device.upper()

    def _use_packet(self, packet: Packet, kinds: DeviceKinds) -> Output:
        """Return the samples and events of a packet; one that cannot be used raises WireError and changes nothing."""
        prefix, t, link, kind = packet.channel.partition("/")[0], packet.t, self.link, None
        if prefix == "device":
            out = self._read_standard(packet)
        elif prefix == "receiver":
            out = self._read_receiver(packet)
        else:
            kind = kinds.loaded.get(prefix) or kinds.get(prefix)
            if kind is None or packet.channel not in kind.profile.channel_by_name:
                raise WireError(Rejection.UNKNOWN_CHANNEL, f"no channel {packet.channel!r}")
            if link is None:
                link = kind.make_link(self.site)
                link.set_firmware(self.firmware)
            elif link.name != prefix:
                detail = f"{packet.channel!r} at a site whose device is {link.name}"
                raise WireError(Rejection.UNKNOWN_CHANNEL, detail)
            out = kind.feed(link, packet.channel, packet.data, t)
            self.link = link
        self.device = self.device or packet.device
        self.newest_arrival, self.backward_packets, self.used = t, 0, True
        if link is None or kind is None or packet.channel not in kind.profile.streams:
            return self.advance(t, kinds) + out
        newest, limit = self.newest_stream_arrival, max(kind.profile.stale_after, MIN_GAP * link.interval)
        self.newest_stream_arrival = t
        is_long = newest is not None and t - newest > limit
        self.absent = self.absent or is_long or self.stale
        if self.absent and any([isinstance(item, Sample) for item in out]):
            out = [evolve(item, count=0) if isinstance(item, SampleGap) else item for item in out]
            self.absent = False
        if newest is not None and (self.stale or (is_long and not link.may_be_silent)):
            resumed = StreamResumed(t=t, site=self.site, silent_for=t - newest)
            out[:0] = [resumed] if self.stale else [self._silence(newest, t, limit), resumed]
            self.stale = False
        return out

    def _read_receiver(self, packet: Packet) -> Output:
        from .receiver import parse_receiver_event

        out = parse_receiver_event(packet)
        if any([isinstance(event, Connected) for event in out]):
            self.absent = True
            if self.link is not None:
                self.link.handle_reconnection()
        return [*out]

    def _read_standard(self, packet: Packet) -> Output:
        from ..wire.device import parse_battery
        from ..wire.fields import parse_text

        if packet.channel == "device/battery":
            level = parse_battery(packet.data) / 100.0
            return [BatteryLevel(t=packet.t, site=self.site, level=level)]
        if packet.channel != "device/firmware":
            raise WireError(Rejection.UNKNOWN_CHANNEL, f"no channel {packet.channel!r}")
        self.firmware = parse_text(packet.data).rstrip("\0")
        if self.link is not None:
            self.link.set_firmware(self.firmware)
        return []

    def _restart(self, packet: Packet, kinds: DeviceKinds) -> Output:
        """Restart times with this packet, because the receiver's clock was set back; WireError if it is unusable."""
        trial = deepcopy(self)
        out = trial.restart_clock(packet.t)
        try:
            out += trial._use_packet(packet, kinds)
        except WireError as error:  # what the packet made known before it is not kept either
            raise WireError(error.reason, error.detail) from None
        for attribute in fields(Decoder):
            setattr(self, attribute.name, getattr(trial, attribute.name))
        return out

    def _reject(self, packet: Packet, reason: Rejection, detail: str) -> Output:
        newest, t = self.newest_arrival, packet.t
        if not -MAX_TIME <= t <= MAX_TIME:
            t = 0.0 if newest is None else newest
        known_at = t if newest is None else max(t, newest)
        return [
            PacketRejected(
                t=t, known_at=known_at, site=packet.site, channel=packet.channel, reason=reason, detail=detail
            )
        ]
