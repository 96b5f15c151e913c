"""The exception of the wire package."""

from __future__ import annotations

from ..events import Rejection


class WireError(ValueError):
    """Error for bytes that do not fit their channel, with the `reason` for events and a `detail` in words."""

    def __init__(self, reason: Rejection, detail: str) -> None:
        super().__init__(f"{reason.value}: {detail}")
        self.reason = reason
        self.detail = detail
