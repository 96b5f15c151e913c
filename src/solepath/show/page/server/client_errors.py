"""Logs errors of clients, with a limit on the rate of lines; the two numbers were chosen by hand and not swept."""

from __future__ import annotations

from collections import deque
from logging import Logger
from time import monotonic

from attrs import define, field

MAX_LINES = 10
"""Largest number of lines in each TIME_OF_LINES."""
TIME_OF_LINES = 600.0
"""Time in which MAX_LINES may come, s."""


@define
class ClientErrors:
    """Writes errors of clients to `logger`, with a limit on their rate.

    Lines that were left out are counted; the next line gives their number."""

    logger: Logger
    _times: deque[float] = field(factory=lambda: deque(maxlen=MAX_LINES), init=False)
    """Times of the newest lines, s."""
    _unreported: int = field(default=0, init=False)

    def report(self, text: str) -> None:
        """Write a line, or only count it when the limit is reached; `text` holds nothing that a client sent."""
        now = monotonic()
        if len(self._times) == MAX_LINES and now - self._times[0] < TIME_OF_LINES:
            self._unreported += 1
            return
        more = f" ({self._unreported} more were not logged)" if self._unreported else ""
        self._unreported = 0
        self._times.append(now)
        self.logger.warning("%s%s", text, more)
