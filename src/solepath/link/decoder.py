"""The link of one site: packets in, samples and link events out.

The channel's prefix identifies the device, the first time that a packet of it can be used. This file does what all
devices have in common: it checks the arrival time and the device's address, and handles silence, battery and firmware.
Bytes and clocks are handled by devices/ and, for declared devices, by stream.py; kinds.py has the table of all. An app
that adds devices passes its own table with every call: the table holds functions, and a decoder is data.

A site is bound to the first device whose packets have its address (`Packet.device`), or to the one that it was made
for. From then on packets of other devices, and packets without an address, are rejected; upper and lower case are one
address. Packets about the receiver itself belong to no device and are always accepted.

Arrival time must not run backwards: such packets are rejected. But a receiver's clock that was set back for good must
not end the stream, so the twentieth such packet in a row gives ClockReset, and times restart there, before the old
ones. That count is the only thing that a rejected packet changes."""

from __future__ import annotations

from copy import deepcopy
from math import isfinite

from ..events import BatteryLevel, ClockReset, Connected, PacketRejected, Rejection, StreamResumed, StreamStale
from ..types import Packet, Site
from ..types.attrs import define, fields
from ..wire.error import WireError
from .device_link import DeviceLink, Output
from .kinds import BUILT_IN_KINDS, DeviceKinds

SET_BACK_PACKETS = 20
"""Number of packets in a row from before the newest arrival that show that the receiver's clock was set back."""
MAX_TIME = 1e11
"""Largest magnitude of an arrival time, s; a packet beyond it is rejected."""


@define
class Decoder:
    """The link of one site.

    `feed` is total: any packet gives events, never an exception, and a rejected one changes nothing (except the count
    of packets whose time runs backwards). Sample times strictly increase from one ClockReset to the next; `known_at` is
    the arrival that settled the sample, or `t` where that is later."""

    site: Site
    """Site whose packets are decoded."""
    device: str = ""
    """Address of the device that the site is bound to; "" until one is known."""
    link: DeviceLink | None = None
    """Link of the device; None until a packet of it was used."""
    firmware: str = ""
    """Firmware revision of the device; "" until it is known."""
    arrived: float | None = None
    """Newest arrival of a packet that was used, s."""
    backwards: int = 0
    """Number of packets rejected in a row because their arrival was before the newest."""
    stream_arrived: float | None = None
    """Newest arrival on a channel that must not fall silent, s."""
    stale: bool = False
    """True if the stream is silent and StreamStale was reported."""

    def feed(self, packet: Packet, kinds: DeviceKinds = BUILT_IN_KINDS) -> Output:
        """Return the samples and events of one packet, in the order in which they become known."""
        t = packet.t
        if not isfinite(t):
            return self._reject(packet, Rejection.NOT_FINITE, f"arrival time {t}")
        if not -MAX_TIME <= t <= MAX_TIME:
            return self._reject(packet, Rejection.ABSURD, f"arrival time {t:g} s")
        if packet.site is not self.site:
            return self._reject(packet, Rejection.WRONG_SITE, f"of {packet.site.value}, not {self.site.value}")
        if packet.device != self.device and self._is_other_device(packet):
            return self._reject(packet, Rejection.WRONG_DEVICE, f"of {packet.device or 'nobody'}, not {self.device}")
        if self.arrived is not None and t < self.arrived:
            if self.backwards + 1 < SET_BACK_PACKETS:
                self.backwards += 1
                return self._reject(packet, Rejection.TIME_BACKWARDS, f"{self.arrived - t:.6g} s before the newest")
            return self._restart(packet, kinds)
        try:
            return self._use(packet, kinds)
        except WireError as error:
            return self._reject(packet, error.reason, error.detail)

    def advance(self, now: float, kinds: DeviceKinds = BUILT_IN_KINDS) -> Output:
        """Let time pass to `now`, s, with nothing arriving. A time that is not finite is ignored."""
        link, stream_arrived = self.link, self.stream_arrived
        if link is None or stream_arrived is None or self.stale or link.may_be_silent or not isfinite(now):
            return []
        kind = kinds.loaded.get(link.name) or kinds.get(link.name)
        if kind is None or now - stream_arrived <= kind.profile.stale_after:
            return []
        limit = kind.profile.stale_after
        self.stale = True
        out = link.flush(now)
        out.append(StreamStale(t=stream_arrived + limit, known_at=now, site=self.site, silent_for=now - stream_arrived))
        return out

    def finish(self) -> Output:
        """Return the samples that still wait, at the end of all data."""
        return [] if self.link is None or self.arrived is None else self.link.flush(self.arrived)

    def is_bound_to(self, device: str) -> bool:
        """Return whether the site is bound to just this address, in any case; "" asks whether it is bound to none."""
        return device == self.device or device.upper() == self.device.upper()

    def _is_other_device(self, packet: Packet) -> bool:
        """Return whether a packet is of another device than the site is bound to. The receiver itself is of none."""
        if self.device == "" or self.is_bound_to(packet.device):
            return False
        return packet.device != "" or packet.channel.partition("/")[0] != "receiver"

    def _use(self, packet: Packet, kinds: DeviceKinds) -> Output:
        """Use a packet. WireError, before anything has changed, when the packet cannot be used."""
        prefix = packet.channel.partition("/")[0]
        if prefix == "device" or prefix == "receiver":
            out = self._read_standard(packet) if prefix == "device" else self._read_receiver(packet)
            self.device = self.device or packet.device
            self.arrived, self.backwards = packet.t, 0
            return self.advance(packet.t, kinds) + out
        kind = kinds.loaded.get(prefix) or kinds.get(prefix)
        if kind is None or packet.channel not in kind.profile.channel_names:
            raise WireError(Rejection.UNKNOWN_CHANNEL, f"no channel {packet.channel!r}")
        link = self.link
        if link is None:
            link = kind.make_link(self.site, self.firmware)
        elif link.name != prefix:
            detail = f"{packet.channel!r} at a site whose device is {link.name}"
            raise WireError(Rejection.UNKNOWN_CHANNEL, detail)
        out = kind.feed(link, packet.channel, packet.data, packet.t)
        self.link = link
        self.device = self.device or packet.device
        self.arrived, self.backwards = packet.t, 0
        if packet.channel not in kind.profile.streams:
            return self.advance(packet.t, kinds) + out
        if self.stale or (
            self.stream_arrived is not None and packet.t - self.stream_arrived > kind.profile.stale_after
        ):
            out = self._end_silence(packet.t, kind.profile.stale_after) + out
        self.stream_arrived = packet.t
        return out

    def _read_receiver(self, packet: Packet) -> Output:
        from .receiver import parse_receiver_event

        out = parse_receiver_event(packet)
        if self.link is not None and any([isinstance(event, Connected) for event in out]):
            self.link.handle_reconnection()
        return [*out]

    def _read_standard(self, packet: Packet) -> Output:
        """Read battery and firmware, which any device may have."""
        from ..wire.device import parse_battery, parse_firmware

        if packet.channel == "device/battery":
            level = parse_battery(packet.data) / 100.0
            return [BatteryLevel(t=packet.t, known_at=packet.t, site=self.site, level=level)]
        if packet.channel != "device/firmware":
            raise WireError(Rejection.UNKNOWN_CHANNEL, f"no channel {packet.channel!r}")
        self.firmware = parse_firmware(packet.data).rstrip("\0")
        if self.link is not None:
            self.link.set_firmware(self.firmware)
        return []

    def _end_silence(self, t: float, limit: float) -> Output:
        """Return the events for a stream packet that arrived at `t` after more than `limit` s without any."""
        out: Output = []
        if self.stream_arrived is None or self.link is None:
            return out
        silent_for = t - self.stream_arrived
        if not self.stale and not self.link.may_be_silent:
            self.stale = True
            t_stale = self.stream_arrived + limit
            out.append(StreamStale(t=t_stale, known_at=t, site=self.site, silent_for=silent_for))
        if self.stale:
            self.stale = False
            out.append(StreamResumed(t=t, known_at=t, site=self.site, silent_for=silent_for))
        return out

    def _restart(self, packet: Packet, kinds: DeviceKinds) -> Output:
        """Restart times, because the receiver's clock was set back. If the packet cannot be used, nothing changes."""
        trial = deepcopy(self)
        out = trial._reset_times(packet.t)
        try:
            out = out + trial._use(packet, kinds)
        except WireError as error:
            return self._reject(packet, error.reason, error.detail)
        for attribute in fields(Decoder):
            setattr(self, attribute.name, getattr(trial, attribute.name))
        return out

    def _reset_times(self, t: float) -> Output:
        self.arrived, self.stream_arrived, self.stale, self.backwards = None, None, False, 0
        if self.link is not None:
            self.link.restart_clock()
        return [ClockReset(t=t, known_at=t, site=self.site, restarted=False)]

    def _reject(self, packet: Packet, reason: Rejection, detail: str) -> Output:
        newest = 0.0 if self.arrived is None else self.arrived
        t = packet.t if -MAX_TIME <= packet.t <= MAX_TIME else newest
        return [
            PacketRejected(
                t=t, known_at=max(t, newest), site=packet.site, channel=packet.channel, reason=reason, detail=detail
            )
        ]
