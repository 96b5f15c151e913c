"""What a filter of heights was told lately, 11 bytes each: a lift's ride is known after it, and then all of it is gone
through again."""

from __future__ import annotations

from collections.abc import Iterable
from struct import Struct

from attrs import define

Told = tuple[float, int, float, float]
"""When, s, of whom, a value in m and its variance, m^2."""

ROW = Struct("<hBif")
"""Of one: `TICKS` since the one before, of whom, the value in `PARTS`, and the variance rounded to float32."""
TICKS = 100.0
"""a second."""
PARTS = 10_000.0
"""a metre."""
FARTHEST = 1 << 15
"""Ticks; two that are further apart count as this."""


@define
class Heard:
    """The newest ones, in the order in which they were used."""

    rows: bytes = b""
    first: int = 0
    """Ticks of the oldest, and"""
    last: int = 0
    """of the newest."""

    def add(self, told: Told) -> Told:
        """One more. Returns what is kept of it, to use that: the value is below 200 km."""
        t, which, value, variance = told
        ticks = round(t * TICKS)
        if not self.rows:
            self.first = self.last = ticks
        since = max(-FARTHEST, min(ticks - self.last, FARTHEST - 1))
        self.last += since
        row = ROW.pack(since, which, round(value * PARTS), variance)
        self.rows += row
        return _told(self.last, row)

    @property
    def count(self) -> int:
        return len(self.rows) // ROW.size

    @property
    def oldest(self) -> float | None:
        """When it was told, s; None when nothing is kept."""
        return self.first / TICKS if self.rows else None

    def pop(self) -> Told:
        """The oldest one goes; not for none."""
        told = _told(self.first, self.rows[: ROW.size])
        self.rows = self.rows[ROW.size :]
        if self.rows:
            self.first += ROW.unpack_from(self.rows)[0]
        return told

    def all(self) -> list[Told]:
        """In their order."""
        told, ticks = [], self.first
        for k in range(0, len(self.rows), ROW.size):
            row = self.rows[k : k + ROW.size]
            ticks += ROW.unpack(row)[0] if k else 0
            told.append(_told(ticks, row))
        return told

    def replace(self, told: Iterable[Told]) -> None:
        """These in place of all."""
        self.clear()
        for one in told:
            self.add(one)

    def clear(self) -> None:
        self.rows, self.first, self.last = b"", 0, 0


def _told(ticks: int, row: bytes) -> Told:
    _, which, value, variance = ROW.unpack(row)
    return ticks / TICKS, which, value / PARTS, variance
