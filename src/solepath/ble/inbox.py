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
    """What may not be dropped and was found among the oldest; older than all of `_packets`."""
    _dropped: dict[Site, tuple[int, Packet]] = field(factory=dict, init=False)
    """By site, how many since the last `take`, and the newest of them."""
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
        while True:
            packet, notified = self._packets.popleft()
            if not notified:
                self._kept.append(packet)
                if len(self._kept) <= self.capacity:
                    if not self._packets:
                        return
                    continue
                packet = self._kept.popleft()
            count, _ = self._dropped.get(packet.site, (0, packet))
            self._dropped[packet.site] = (count + 1, packet)
            return

    def take(self) -> Packet | None:
        """The oldest packet; None when there is none."""
        if self._kept:
            return self._kept.popleft()
        if self._dropped:
            site = next(iter(self._dropped))
            count, newest = self._dropped.pop(site)
            return Packet(newest.t, site, "receiver/dropped", build_dropped(count), newest.device)
        return self._packets.popleft()[0] if self._packets else None
