"""Recent inputs of the height filter.

An elevator ride is known only after it has ended; all inputs since its start are then processed again."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable

from ...types.attrs import define, field
from ...types.vector import single

HeightInput = tuple[float, int, float, float]
"""Time, s; source (altitude.py lists them); value, m; its variance, m^2."""

PackedInput = tuple[int, int, int, float]
"""A `HeightInput` in compact form: ticks, source, value in units of 1/`PARTS_PER_M` m, variance as float32."""
TICKS_PER_S = 100.0
"""Number of ticks in a second."""
PARTS_PER_M = 10_000.0
"""Number of units of the value in a metre."""


@define
class RecentInputs:
    """The newest inputs, in the order in which the filter processed them."""

    rows: deque[PackedInput] = field(factory=deque)

    def add(self, entry: HeightInput) -> HeightInput:
        """Add an input and return it as rounded for storage; the filter must process the rounded input."""
        t, source, value, variance = entry
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

    @property
    def newest(self) -> HeightInput | None:
        """The newest input; None when nothing is kept."""
        return _unpack(self.rows[-1]) if self.rows else None

    def pop(self) -> HeightInput:
        """Remove the oldest input and return it; there must be one."""
        return _unpack(self.rows.popleft())

    def all(self) -> list[HeightInput]:
        """Return all inputs, oldest first."""
        return [_unpack(row) for row in self.rows]

    def replace(self, inputs: Iterable[HeightInput]) -> None:
        """Replace all inputs by these."""
        self.clear()
        for entry in inputs:
            self.add(entry)

    def clear(self) -> None:
        """Remove all inputs."""
        self.rows.clear()


def _unpack(row: PackedInput) -> HeightInput:
    """Return the input in s, m and m^2."""
    ticks, source, parts, variance = row
    return ticks / TICKS_PER_S, source, parts / PARTS_PER_M, variance
