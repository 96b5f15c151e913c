"""The height filter of altitude.py: its estimate of three values, and its recent inputs.

An elevator ride is known only after it has ended; all inputs since its start are then processed again."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable

from ...types.attrs import define, field
from ...types.vector import single

JUMP_LIMIT = 25.0
"""Squared innovation, divided by its variance, above which the offset has changed suddenly: a door or a gust."""
UNKNOWN_VARIANCE = 1e4
"""Variance of an unknown height, m^2."""

HeightInput = tuple[float, int, float, float]
"""Time, s; source (altitude.py lists them); value, m; its variance, m^2."""

PackedInput = tuple[int, int, int, float]
"""A `HeightInput` in compact form: ticks, source, value in units of 1/`PARTS_PER_M` m, variance as float32."""
TICKS_PER_S = 100.0
"""Number of ticks in a second."""
PARTS_PER_M = 10_000.0
"""Number of units of the value in a metre."""


@define
class HeightEstimate:
    """The filter's estimate of the correction and the two offsets."""

    values: list[float] = field(factory=lambda: [0.0, 0.0, 0.0])
    """The correction and the offsets of the left and the right barometer, m."""
    covariance: list[float] = field(factory=lambda: [0.0] * 9)
    """Covariance of the three values, row by row, m^2."""
    read_at: list[float | None] = field(factory=lambda: [None, None])
    """Time of the newest reading of each barometer, s; None: never read."""

    def move(self, by: float, variance: float) -> None:
        """Change the correction by `by`, m; `variance` is that of the change, m^2."""
        self.values[0] += by
        self.covariance[0] = min(self.covariance[0] + variance, UNKNOWN_VARIANCE)

    def read(self, source: int, t: float, height: float, noise: float, wander: float) -> None:
        """Correct the estimate with `height`, m: the height by the barometer minus the height of the track.

        `noise` is the variance of the reading, m^2, and `wander` the growth of the offset's variance, m^2/s."""
        x, p, i = self.values, self.covariance, 1 + source
        previous = self.read_at[source]
        self.read_at[source] = t
        if previous is None:
            # the offset is unknown: set it so that the reading fits the correction
            x[i] = height - x[0]
            for j in range(3):
                if j != i:
                    p[3 * i + j] = p[3 * j + i] = -p[j]
            p[4 * i] = p[0] + noise
            return
        p[4 * i] = min(p[4 * i] + wander * max(0.0, t - previous), UNKNOWN_VARIANCE)
        innovation = height - x[0] - x[i]
        innovation_variance = p[0] + 2.0 * p[i] + p[4 * i] + noise
        if innovation * innovation > JUMP_LIMIT * innovation_variance:
            p[4 * i] = min(p[4 * i] + innovation * innovation, UNKNOWN_VARIANCE)
            innovation_variance = p[0] + 2.0 * p[i] + p[4 * i] + noise
        covariances = [p[3 * j] + p[3 * j + i] for j in range(3)]
        for j in range(3):
            x[j] += covariances[j] / innovation_variance * innovation
        for j in range(3):
            for k in range(3):
                p[3 * j + k] -= covariances[j] * covariances[k] / innovation_variance
        for j in range(3):
            p[4 * j] = max(p[4 * j], 0.0)

    def forget_offset(self, source: int) -> None:
        """Forget the offset of a barometer; its next reading gives another one that fits the correction."""
        self.read_at[source] = None

    def copy(self) -> HeightEstimate:
        """Return a copy of the estimate."""
        return HeightEstimate(list(self.values), list(self.covariance), list(self.read_at))


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
