"""Sentences on what a receiver could not do, as packets receiver/trouble (protocol/receiver.md)."""

from __future__ import annotations

from ...types.attrs import define, field
from ...wire.fields import build_text

TROUBLE = "receiver/trouble"
"""Channel of a sentence on what could not be done."""
MAX_TEXT_SIZE = 500
"""Longest text of a trouble, bytes, chosen by hand."""
REPORT_INTERVAL = 60.0
"""Shortest interval between two reports of the same trouble, s, chosen by hand."""
MAX_RECENT = 100
"""Largest number of troubles of a device that are remembered, chosen by hand."""

Value = tuple[str, bytes]
"""Channel and data of a packet."""


def trouble(sentence: str) -> Value:
    """Return the value of a trouble; a long sentence is shortened."""
    return TROUBLE, build_text(shorten(sentence, MAX_TEXT_SIZE))


def shorten(text: str, size: int) -> str:
    """Return the start of the text that fits into `size` bytes of UTF-8."""
    return text.encode("utf-8", "replace")[:size].decode("utf-8", "ignore")


@define(eq=False)
class RecentTroubles:
    """The troubles of one device that were reported less than `REPORT_INTERVAL` ago."""

    _reported: dict[bytes, float] = field(factory=dict, init=False)
    """Time of the last report of each trouble, s, by its text."""

    def leave_out(self, values: list[Value], now: float) -> list[Value]:
        """Return the values, at `now`, s, without troubles that were reported shortly before."""
        return [value for value in values if value[0] != TROUBLE or self._add(value[1], now)]

    def _add(self, text: bytes, now: float) -> bool:
        self._reported = {reported: t for reported, t in self._reported.items() if now - t < REPORT_INTERVAL}
        is_new = text not in self._reported
        if is_new and len(self._reported) < MAX_RECENT:
            self._reported[text] = now
        return is_new
