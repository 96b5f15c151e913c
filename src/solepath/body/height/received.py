"""What a filter of heights was told lately: a lift's ride is known after it, and then all of it is gone
through again."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable

from ...types.attrs import define, field
from ...types.vector import single

Told = tuple[float, int, float, float]
"""When, s, of whom, a value in m and its variance, m^2."""

Row = tuple[int, int, int, float]
"""The same as it is kept: ticks, of whom, parts, and the variance rounded to float32."""
TICKS = 100.0
"""a second."""
PARTS = 10_000.0
"""a metre."""


@define
class Heard:
    """The newest ones, in the order in which they were used."""

    rows: deque[Row] = field(factory=deque)

    def add(self, told: Told) -> Told:
        """One more. Returns what is kept of it, to use that."""
        t, which, value, variance = told
        row = (round(t * TICKS), which, round(value * PARTS), single(variance))
        self.rows.append(row)
        return _told(row)

    @property
    def count(self) -> int:
        return len(self.rows)

    @property
    def oldest(self) -> float | None:
        """When it was told, s; None when nothing is kept."""
        return self.rows[0][0] / TICKS if self.rows else None

    def pop(self) -> Told:
        """The oldest one goes; not for none."""
        return _told(self.rows.popleft())

    def all(self) -> list[Told]:
        """In their order."""
        return [_told(row) for row in self.rows]

    def replace(self, told: Iterable[Told]) -> None:
        """These in place of all."""
        self.clear()
        for one in told:
            self.add(one)

    def clear(self) -> None:
        self.rows.clear()


def _told(row: Row) -> Told:
    ticks, which, parts, variance = row
    return ticks / TICKS, which, parts / PARTS, variance
