"""Logs errors of clients, with a limit on the rate of lines; the two numbers were chosen by hand and not swept."""

from __future__ import annotations

from logging import Logger
from time import monotonic

from attrs import define, field

BURST_SIZE = 10
"""Largest number of lines that may come at once."""
LINE_INTERVAL = 60.0
"""Time after which one more line may come, s."""


@define
class ClientErrors:
    """Writes errors of clients to `logger`, with a limit on their rate.

    Lines that were left out are counted; the next line gives their number."""

    logger: Logger
    _lines_left: float = field(default=float(BURST_SIZE), init=False)
    _updated_at: float = field(factory=monotonic, init=False)
    _unreported: int = field(default=0, init=False)

    def report(self, text: str) -> None:
        """Write a line, or only count it when the limit is reached; `text` holds nothing that a client sent."""
        now = monotonic()
        self._lines_left = min(self._lines_left + (now - self._updated_at) / LINE_INTERVAL, float(BURST_SIZE))
        self._updated_at = now
        if self._lines_left < 1.0:
            self._unreported += 1
            return
        self._lines_left -= 1.0
        more = f" ({self._unreported} more were not logged)" if self._unreported else ""
        self._unreported = 0
        self.logger.warning("%s%s", text, more)
