"""What one connection has to say, as packets."""

from __future__ import annotations

import asyncio

from attrs import define, field

from ..types import Packet, Site
from ..wire.fields import build_text
from .inbox import Inbox

REPEAT = 60.0
"""s before the same trouble is told again."""
LONGEST = 500
"""Bytes of a trouble."""


@define(eq=False)
class Voice:
    """Speaks into `inbox`, at once and by the loop's clock, for the device `address` ("" while none is known) at
    `site`."""

    inbox: Inbox
    site: Site
    address: str = ""
    _told: dict[str, float] = field(factory=dict, init=False)
    """Troubles, and when they were told last."""

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
        """Tell a trouble; the same one not over and over."""
        now = asyncio.get_running_loop().time()
        if now - self._told.get(what, -REPEAT) >= REPEAT:
            self._told = {one: t for one, t in self._told.items() if now - t < REPEAT}
            self._told[what] = now
            self.say("receiver/trouble", build_text(shortened(what, LONGEST)))

    def _packet(self, channel: str, data: bytes) -> Packet:
        return Packet(asyncio.get_running_loop().time(), self.site, channel, data, self.address)


def shortened(text: str, size: int) -> str:
    """As much of the text as so many bytes of UTF-8 hold."""
    return text.encode("utf-8")[:size].decode("utf-8", "ignore")
