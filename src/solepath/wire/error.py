"""The one exception of this room."""

from __future__ import annotations

from ..events import Rejection


class WireError(ValueError):
    """Bytes that are not what their channel says. `reason` is one word for events, `detail` says what was wrong."""

    def __init__(self, reason: Rejection, detail: str) -> None:
        super().__init__(f"{reason.value}: {detail}")
        self.reason = reason
        self.detail = detail
