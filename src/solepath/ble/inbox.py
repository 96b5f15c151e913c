"""Packets between the callbacks of Bluetooth and whoever takes them: bounded, and honest about what did not fit."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable

from attrs import define, field

from ..types import Packet, Site
from ..wire.receiver import build_dropped


@define
class Inbox:
    """First in, first out. Holds `capacity` notifications; when one more comes, the oldest goes.

    What was read, written or said by the receiver is not dropped for a notification's sake, so that a recording keeps
    its ranges and layouts; of that too there is at most `capacity`. In place of what was dropped stands one packet
    receiver/dropped for each site, before the next one of `take`.
    """

    capacity: int
    _packets: deque[tuple[Packet, bool]] = field(factory=deque, init=False)
    _kept: deque[Packet] = field(factory=deque, init=False)
    """What may not be dropped and was found among the oldest, or comes next; older than all of `_packets`."""
    _dropped: dict[Site, int] = field(factory=dict, init=False)
    """By site, how many since that was told last."""
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
        self._passed[packet.site] = packet
        if not notified:
            self._kept.append(packet)
            if len(self._kept) <= self.capacity:
                return
            packet = self._kept.popleft()
        self._dropped[packet.site] = self._dropped.get(packet.site, 0) + 1

    def take(self) -> Packet | None:
        """The oldest packet; None when there is none."""
        if self._kept:
            return self._kept.popleft()
        if self._dropped:
            site, count = next(iter(self._dropped.items()))
            del self._dropped[site]
            newest = self._passed[site]
            if self._packets:  # it comes next whatever is dropped meanwhile: who is slow shall not hear of drops alone
                packet, _ = self._packets.popleft()
                self._passed[packet.site] = packet
                self._kept.append(packet)
            return Packet(newest.t, site, "receiver/dropped", build_dropped(count), newest.device)
        return self._packets.popleft()[0] if self._packets else None
