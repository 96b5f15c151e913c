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
    of that site. When it does not fit among the kept packets, the next packet receiver/dropped includes its count."""

    capacity: int
    _packets: deque[tuple[Packet, bool]] = field(factory=deque, init=False)
    _kept_packets: deque[Packet] = field(factory=deque, init=False)
    """Packets older than all of `_packets`: those that a notification does not displace, and the next one to take."""
    _drop_counts: dict[Site, int] = field(factory=dict, init=False)
    """Number of packets of each site that were dropped since its last packet receiver/dropped."""
    _newest_removed: dict[Site, Packet] = field(factory=dict, init=False)
    """The newest packet of each site that has left `_packets` other than by `take`; it gives receiver/dropped its time.

    The time cannot be later, since kept packets are taken before `_packets`."""
    on_arrival: Callable[[], None] | None = field(default=None, init=False)

    def __len__(self) -> int:
        return len(self._packets) + len(self._kept_packets) + len(self._drop_counts)

    def put(self, packet: Packet, is_notification: bool) -> None:
        """Add one packet; `is_notification` is True when the device sent it without a request, so it may be dropped."""
        self._packets.append((packet, is_notification))
        if len(self._packets) > self.capacity:
            self._make_room()
        if self.on_arrival is not None:
            self.on_arrival()

    def _make_room(self) -> None:
        packet, is_notification = self._packets.popleft()
        if is_notification:
            self._newest_removed[packet.site] = packet
            self._drop(packet)
            return
        if packet.site in self._drop_counts:
            self._kept_packets.append(self._make_dropped_packet(packet.site))
        self._newest_removed[packet.site] = packet
        self._kept_packets.append(packet)
        while len(self._kept_packets) > self.capacity:
            counts = (index for index, kept in enumerate(self._kept_packets) if kept.channel == DROPPED)
            dropped_index = next(counts, 0)  # a count can be reported later, a value cannot
            self._drop(self._kept_packets[dropped_index])
            del self._kept_packets[dropped_index]

    def _drop(self, packet: Packet) -> None:
        """Count a dropped packet; a packet receiver/dropped adds its own count."""
        count = parse_dropped(packet.data) if packet.channel == DROPPED else 1
        self._drop_counts[packet.site] = self._drop_counts.get(packet.site, 0) + count

    def _make_dropped_packet(self, site: Site) -> Packet:
        """Return a packet receiver/dropped with the unreported count of a site."""
        newest = self._newest_removed[site]
        return Packet(newest.t, site, DROPPED, build_dropped(self._drop_counts.pop(site)), newest.device)

    def take(self) -> Packet | None:
        """Remove and return the oldest packet; None when there is none."""
        if self._kept_packets:
            return self._kept_packets.popleft()
        if self._drop_counts:
            dropped = self._make_dropped_packet(next(iter(self._drop_counts)))
            if self._packets:  # keep the next packet: otherwise a slow consumer could get nothing but counts
                packet, _ = self._packets.popleft()
                if packet.site in self._drop_counts:
                    self._kept_packets.append(self._make_dropped_packet(packet.site))
                self._newest_removed[packet.site] = packet
                self._kept_packets.append(packet)
            return dropped
        return self._packets.popleft()[0] if self._packets else None


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
