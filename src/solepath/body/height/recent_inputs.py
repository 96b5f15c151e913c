"""Recent inputs of the height filter.

A lift ride is known only after it has ended; all inputs since it started are then used again."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable

from ...types.attrs import define, field
from ...types.vector import single

HeightInput = tuple[float, int, float, float]
"""Time in s, source (left barometer, right barometer or move), value in m and its variance in m^2."""

PackedInput = tuple[int, int, int, float]
"""A `HeightInput` as it is kept: ticks, source, 1/`PARTS_PER_M` m, and the variance rounded to float32."""
TICKS_PER_S = 100.0
"""Ticks of the time in one second."""
PARTS_PER_M = 10_000.0
"""Parts of the value in one metre."""


@define
class RecentInputs:
    """The newest inputs, in the order in which they were used."""

    rows: deque[PackedInput] = field(factory=deque)

    def add(self, item: HeightInput) -> HeightInput:
        """Add one input and return it as it is kept, rounded: that value is to be used."""
        t, source, value, variance = item
        row = (round(t * TICKS_PER_S), source, round(value * PARTS_PER_M), single(variance))
        self.rows.append(row)
        return _unpack(row)

    @property
    def count(self) -> int:
        """Number of inputs."""
        return len(self.rows)

    @property
    def oldest(self) -> float | None:
        """Time of the oldest input, s; None when nothing is kept."""
        return self.rows[0][0] / TICKS_PER_S if self.rows else None

    def pop(self) -> HeightInput:
        """Remove the oldest input and return it; there must be one."""
        return _unpack(self.rows.popleft())

    def all(self) -> list[HeightInput]:
        """Return all inputs in their order."""
        return [_unpack(row) for row in self.rows]

    def replace(self, inputs: Iterable[HeightInput]) -> None:
        """Replace all inputs by these."""
        self.clear()
        for one in inputs:
            self.add(one)

    def clear(self) -> None:
        """Remove all inputs."""
        self.rows.clear()


def _unpack(row: PackedInput) -> HeightInput:
    """Return the input in s, m and m^2."""
    ticks, source, parts, variance = row
    return ticks / TICKS_PER_S, source, parts / PARTS_PER_M, variance
