"""Bounded queue of packets between the connections and their consumer; it counts the packets that it drops."""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Callable

from attrs import define, field

from ..types import Packet, Site
from ..wire.fields import build_text
from ..wire.receiver import build_dropped, parse_dropped

DROPPED = "receiver/dropped"
REPEAT = 60.0
"""Shortest interval between two reports of the same trouble, s."""
LONGEST = 500
"""Longest text of a trouble, bytes."""


@define
class Inbox:
    """A first-in-first-out queue of `capacity` notifications; one more removes the oldest.

    Values that were read or written and reports of the receiver are not dropped to make room for a notification, so
    that a recording keeps its ranges and layouts. Of these too there are at most `capacity`; beyond it the oldest are
    dropped. A packet receiver/dropped counts the dropped packets of a site and takes their place among the kept packets
    of that site. Only when so many packets were kept that this packet would not fit, its count is reported with the
    next one."""

    capacity: int
    _packets: deque[tuple[Packet, bool]] = field(factory=deque, init=False)
    _kept: deque[Packet] = field(factory=deque, init=False)
    """Packets that may not be dropped and were among the oldest, or that come next; all older than `_packets`."""
    _dropped: dict[Site, int] = field(factory=dict, init=False)
    """Number of notifications of each site that were dropped since its last packet receiver/dropped."""
    _newest_removed: dict[Site, Packet] = field(factory=dict, init=False)
    """The newest packet of each site that was dropped, or kept as the oldest of the queue. The count of the dropped
    packets carries its time, since the kept packets are taken first."""
    on_arrival: Callable[[], None] | None = field(default=None, init=False)

    def __len__(self) -> int:
        return len(self._packets) + len(self._kept) + len(self._dropped)

    def put(self, packet: Packet, is_notification: bool) -> None:
        """Add one packet; `is_notification` says that the device sent it unasked, so it may be dropped."""
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
        if packet.site in self._dropped:
            self._kept.append(self._make_dropped_packet(packet.site))
        self._newest_removed[packet.site] = packet
        self._kept.append(packet)
        while len(self._kept) > self.capacity:
            counts = (k for k, kept in enumerate(self._kept) if kept.channel == DROPPED)
            oldest = next(counts, 0)  # a count can be reported later, a value cannot
            self._drop(self._kept[oldest])
            del self._kept[oldest]

    def _drop(self, packet: Packet) -> None:
        """Count a dropped packet; of a packet that is a count itself, add that count."""
        count = parse_dropped(packet.data) if packet.channel == DROPPED else 1
        self._dropped[packet.site] = self._dropped.get(packet.site, 0) + count

    def _make_dropped_packet(self, site: Site) -> Packet:
        """Return the packet that counts the dropped, not yet reported packets of a site."""
        newest = self._newest_removed[site]
        return Packet(newest.t, site, DROPPED, build_dropped(self._dropped.pop(site)), newest.device)

    def take(self) -> Packet | None:
        """Remove and return the oldest packet; None when there is none."""
        if self._kept:
            return self._kept.popleft()
        if self._dropped:
            dropped = self._make_dropped_packet(next(iter(self._dropped)))
            if self._packets:  # it comes next whatever is dropped now: a slow consumer must not get counts alone
                packet, _ = self._packets.popleft()
                if packet.site in self._dropped:
                    self._kept.append(self._make_dropped_packet(packet.site))
                self._newest_removed[packet.site] = packet
                self._kept.append(packet)
            return dropped
        return self._packets.popleft()[0] if self._packets else None


@define(eq=False)
class Emitter:
    """Puts packets into `inbox` at once, at the loop's time, for the device `address` ("" if unknown) at `site`."""

    inbox: Inbox
    site: Site
    address: str = ""
    _reported: dict[str, float] = field(factory=dict, init=False)
    """Time of the last report of each trouble, s, by its text."""

    def emit_notification(self, channel: str, data: bytes) -> float:
        """Emit a notification and return its arrival time, s."""
        packet = self._packet(channel, data)
        self.inbox.put(packet, True)
        return packet.t

    def emit(self, channel: str, data: bytes = b"") -> Packet:
        """Emit a packet that may not be dropped: a value that was read or written, or a report of the receiver."""
        packet = self._packet(channel, data)
        self.inbox.put(packet, False)
        return packet

    def report_trouble(self, what: str) -> None:
        """Emit a packet receiver/trouble; the same text again after `REPEAT` at the earliest."""
        now = asyncio.get_running_loop().time()
        if now - self._reported.get(what, -REPEAT) >= REPEAT:
            self._reported = {one: t for one, t in self._reported.items() if now - t < REPEAT}
            self._reported[what] = now
            self.emit("receiver/trouble", build_text(shorten(what, LONGEST)))

    def _packet(self, channel: str, data: bytes) -> Packet:
        return Packet(asyncio.get_running_loop().time(), self.site, channel, data, self.address)


def shorten(text: str, size: int) -> str:
    """Return the start of the text that fits into `size` bytes of UTF-8."""
    return text.encode("utf-8")[:size].decode("utf-8", "ignore")
