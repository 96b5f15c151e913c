"""The exception of the wire package."""

from __future__ import annotations

from ..events import Rejection


class WireError(ValueError):
    """Error for bytes that do not fit their channel. `reason` is one word for events, `detail` says what is wrong."""

    def __init__(self, reason: Rejection, detail: str) -> None:
        super().__init__(f"{reason.value}: {detail}")
        self.reason = reason
        self.detail = detail
