"""Bounded queue of packets between the connections and their consumer; it counts the packets that it drops."""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Callable, Iterable

from attrs import define, field

from ..link.setup.device_setup import RecentTroubles, Value, trouble
from ..link.setup.roster import Member
from ..types import Packet, Site
from ..wire.receiver import build_dropped, parse_dropped

DROPPED = "receiver/dropped"


@define
class Inbox:
    """A first-in-first-out queue that holds at most `capacity` notifications and drops the oldest beyond that.

    Values that were read or written and reports of the receiver are not dropped to make room for a notification, so
    that a recording keeps its ranges and layouts. At most `capacity` of these are held too; beyond it the oldest are
    dropped. A packet receiver/dropped counts the dropped packets of a site and takes their place among the kept packets
    of that site."""

    capacity: int
    _packets: deque[tuple[Packet, bool]] = field(factory=deque, init=False)
    _kept_packets: deque[Packet] = field(factory=deque, init=False)
    """Packets older than all of `_packets`: counts, those that a notification does not displace, and the next one."""
    on_arrival: Callable[[], None] | None = field(default=None, init=False)

    def put(self, packet: Packet, is_notification: bool) -> None:
        """Add one packet; `is_notification` is True when the device sent it without a request, so it may be dropped."""
        self._packets.append((packet, is_notification))
        if len(self._packets) > self.capacity:
            oldest, may_be_dropped = self._packets.popleft()
            if may_be_dropped:
                self._drop(oldest)
            else:
                self._kept_packets.append(oldest)
            while len(self._kept_packets) > max(self.capacity, len(Site)):  # there may be a count of each site
                self._drop(self._kept_packets.popleft())
        if self.on_arrival is not None:
            self.on_arrival()

    def _drop(self, packet: Packet) -> None:
        """Count a dropped packet, or those of a packet receiver/dropped, after the kept packets of its site."""
        kept, count, t = self._kept_packets, _count(packet), packet.t
        newest = next((one for one in reversed(kept) if one.site is packet.site), None)
        if newest is not None and newest.channel == DROPPED:
            kept.remove(newest)
            count += _count(newest)
        if kept:
            t = max(t, kept[-1].t)  # an older one may be counted again
        kept.append(Packet(t, packet.site, DROPPED, build_dropped(count), packet.device))

    def take(self) -> Packet | None:
        """Remove and return the oldest packet; None when there is none."""
        if not self._kept_packets:
            return self._packets.popleft()[0] if self._packets else None
        taken = self._kept_packets.popleft()
        if taken.channel == DROPPED and self._packets:
            # keep the next packet: otherwise a slow consumer could get nothing but counts
            self._kept_packets.append(self._packets.popleft()[0])
        return taken


def _count(packet: Packet) -> int:
    return parse_dropped(packet.data) if packet.channel == DROPPED else 1


@define(eq=False)
class Emitter:
    """Puts packets of a device, at its site in the roster, into `inbox`, with the event loop's time, s."""

    inbox: Inbox
    member: Member
    _recent: RecentTroubles = field(factory=RecentTroubles, init=False)

    def emit_notification(self, channel: str, data: bytes) -> float:
        """Emit a notification and return its arrival time, s."""
        packet = self._make_packet(channel, data)
        self.inbox.put(packet, True)
        return packet.t

    def emit(self, values: Iterable[Value]) -> None:
        """Emit values that were read or written, and reports of the receiver; notifications do not displace them.

        A trouble is left out if it was emitted shortly before."""
        for channel, data in self._recent.leave_out([*values], asyncio.get_running_loop().time()):
            self.inbox.put(self._make_packet(channel, data), False)

    def report_trouble(self, text: str) -> None:
        """Emit a packet receiver/trouble."""
        self.emit([trouble(text)])

    def _make_packet(self, channel: str, data: bytes) -> Packet:
        return Packet(asyncio.get_running_loop().time(), self.member.site, channel, data, self.member.address)
