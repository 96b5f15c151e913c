"""Logs what clients do wrong: a line for each error, with a limit on their rate."""

from __future__ import annotations

from logging import Logger
from time import monotonic

from attrs import define, field

AT_ONCE = 10
"""Lines that may come together."""
EVERY = 60.0
"""Time after which there may be one more line, s."""


@define
class ClientErrors:
    """Writes errors of clients to `logger`, with a limit on their rate.

    A line that was left out is counted; the next line gives the number."""

    logger: Logger
    _left: float = field(default=float(AT_ONCE), init=False)
    _at: float = field(factory=monotonic, init=False)
    _unreported: int = field(default=0, init=False)

    def report(self, what: str) -> None:
        """Write a line, or count it where there were too many; `what` holds nothing that a client sent."""
        now = monotonic()
        self._left = min(self._left + (now - self._at) / EVERY, float(AT_ONCE))
        self._at = now
        if self._left < 1.0:
            self._unreported += 1
            return
        self._left -= 1.0
        more = f" ({self._unreported} more were not logged)" if self._unreported else ""
        self._unreported = 0
        self.logger.warning("%s%s", what, more)
