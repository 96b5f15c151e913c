"""Packets between connections, which say them, and whoever takes them: bounded, honest about what did not fit."""

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
"""The same trouble is reported again after so long at the earliest, s."""
LONGEST = 500
"""Bytes of a trouble."""


@define
class Inbox:
    """First in, first out. Holds `capacity` notifications; when one more comes, the oldest goes.

    What was read, written or said by the receiver is not dropped for a notification's sake, so that a recording keeps
    its ranges and layouts; of that too there is at most `capacity`, the oldest go. What was dropped of a site is told
    by a packet receiver/dropped where it stood among what was kept of that site. Only when so much was kept that such
    a packet would not fit is its count told later, with the next.
    """

    capacity: int
    _packets: deque[tuple[Packet, bool]] = field(factory=deque, init=False)
    _kept: deque[Packet] = field(factory=deque, init=False)
    """What may not be dropped and was found among the oldest, or comes next; older than all of `_packets`."""
    _dropped: dict[Site, int] = field(factory=dict, init=False)
    """Notifications of each site that went since the last packet receiver/dropped."""
    _passed: dict[Site, Packet] = field(factory=dict, init=False)
    """By site, the newest that was dropped or kept when it was the oldest: the dropped are told at its time, since
    what was kept is taken before."""
    on_arrival: Callable[[], None] | None = field(default=None, init=False)

    def __len__(self) -> int:
        return len(self._packets) + len(self._kept) + len(self._dropped)

    def put(self, packet: Packet, notified: bool) -> None:
        """`notified`: it came by itself, and may be dropped."""
        self._packets.append((packet, notified))
        if len(self._packets) > self.capacity:
            self._make_room()
        if self.on_arrival is not None:
            self.on_arrival()

    def _make_room(self) -> None:
        packet, notified = self._packets.popleft()
        if notified:
            self._passed[packet.site] = packet
            self._drop(packet)
            return
        if packet.site in self._dropped:
            self._kept.append(self._tell(packet.site))
        self._passed[packet.site] = packet
        self._kept.append(packet)
        while len(self._kept) > self.capacity:
            counts = (k for k, kept in enumerate(self._kept) if kept.channel == DROPPED)
            oldest = next(counts, 0)  # a count can be told later, a value cannot
            self._drop(self._kept[oldest])
            del self._kept[oldest]

    def _drop(self, packet: Packet) -> None:
        """Count it; if it is a count itself, add that."""
        count = parse_dropped(packet.data) if packet.channel == DROPPED else 1
        self._dropped[packet.site] = self._dropped.get(packet.site, 0) + count

    def _tell(self, site: Site) -> Packet:
        """How many of the site were dropped that were not told yet."""
        newest = self._passed[site]
        return Packet(newest.t, site, DROPPED, build_dropped(self._dropped.pop(site)), newest.device)

    def take(self) -> Packet | None:
        """The oldest packet; None when there is none."""
        if self._kept:
            return self._kept.popleft()
        if self._dropped:
            told = self._tell(next(iter(self._dropped)))
            if self._packets:  # it comes next whatever is dropped meanwhile: who is slow shall not hear of drops alone
                packet, _ = self._packets.popleft()
                if packet.site in self._dropped:
                    self._kept.append(self._tell(packet.site))
                self._passed[packet.site] = packet
                self._kept.append(packet)
            return told
        return self._packets.popleft()[0] if self._packets else None


@define(eq=False)
class Emitter:
    """Speaks into `inbox`, at once and by the loop's clock, for the device `address` ("" while none is known) at
    `site`."""

    inbox: Inbox
    site: Site
    address: str = ""
    _reported: dict[str, float] = field(factory=dict, init=False)
    """When each trouble was last reported, s, by its words."""

    def pass_on(self, channel: str, data: bytes) -> float:
        """A notification; when it came, s."""
        packet = self._packet(channel, data)
        self.inbox.put(packet, True)
        return packet.t

    def say(self, channel: str, data: bytes = b"") -> Packet:
        """What was read, written or became known; not to be dropped."""
        packet = self._packet(channel, data)
        self.inbox.put(packet, False)
        return packet

    def complain(self, what: str) -> None:
        """Report a trouble, by a packet receiver/trouble; the same one again after `REPEAT` at the earliest."""
        now = asyncio.get_running_loop().time()
        if now - self._reported.get(what, -REPEAT) >= REPEAT:
            self._reported = {one: t for one, t in self._reported.items() if now - t < REPEAT}
            self._reported[what] = now
            self.say("receiver/trouble", build_text(shortened(what, LONGEST)))

    def _packet(self, channel: str, data: bytes) -> Packet:
        return Packet(asyncio.get_running_loop().time(), self.site, channel, data, self.address)


def shortened(text: str, size: int) -> str:
    """As much of the text as so many bytes of UTF-8 hold."""
    return text.encode("utf-8")[:size].decode("utf-8", "ignore")
