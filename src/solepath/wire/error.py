"""The exception of the wire package."""

from __future__ import annotations

from ..events import PacketRejected, Rejection


class WireError(ValueError):
    """Error for bytes that do not fit their channel, with the `reason` for events and a `detail` in words.

    `earlier` are the events of packets before it, which became known with it."""

    def __init__(self, reason: Rejection, detail: str, earlier: tuple[PacketRejected, ...] = ()) -> None:
        super().__init__(f"{reason.value}: {detail}")
        self.reason = reason
        self.detail = detail
        self.earlier = earlier
