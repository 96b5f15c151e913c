"""Height from air pressure in blocks of half a second, and its slope as evidence for stairs and lifts."""

from __future__ import annotations

from collections import deque
from math import exp, log

from ...types import Foot
from ...types.attrs import define, field
from .chain import (
    DOWN,
    DOWN_THERE,
    NEARLY_DOWN,
    NEARLY_UP,
    RISE,
    RISEN,
    RISING,
    RUN,
    SINK,
    SINKING,
    STAND,
    SUNK,
    UNKNOWN,
    UP,
    UP_THERE,
    WALK,
)

SCALE_HEIGHT = 8578.0
"""Height over which the pressure of air of 20 degrees falls to 1/e, m: R T / (M g)."""
NOISE = 0.25
"""Standard deviation of the mean over half a second, m: 3 Pa.

Small barometers flicker by 1 to 3 Pa, and doors add to it."""
BLOCKS_BEFORE, BLOCKS_AFTER = 3, 2
"""Numbers of blocks before and after the judged one over which the slope is taken."""
LEAST_SPAN = 1.0
"""Least time that these blocks span, s."""
WEIGHT = 1.0 / 3.0
"""Weight of one slope: neighbouring slopes come from the same samples."""
LARGEST_VOTE = 3.0
"""Largest penalty by a slope (natural logarithm): a door that opens is a gust."""

_SLOPES = {
    STAND: (0.0, 0.05),
    WALK: (0.0, 0.15),
    RUN: (0.0, 0.25),
    UP: (0.3, 0.15),
    DOWN: (-0.3, 0.15),
    UNKNOWN: (0.0, 1.0),
    RISING: (1.3, 0.8),
    SINKING: (-1.3, 0.8),
    RISE: (0.6, 0.6),
    RISEN: (0.6, 0.6),
    NEARLY_UP: (0.2, 0.2),
    UP_THERE: (0.1, 0.2),
    SINK: (-0.6, 0.6),
    SUNK: (-0.6, 0.6),
    NEARLY_DOWN: (-0.2, 0.2),
    DOWN_THERE: (-0.1, 0.2),
}
"""Mean and deviation of the climb in each state, m/s: stairs at two treads a second, lifts of 0.5 to 2.5 m/s."""
_ORDERED = tuple(_SLOPES[state] for state in range(len(_SLOPES)))
NO_EVIDENCE = (0.0,) * len(_ORDERED)


@define
class PressureHeight:
    """Height over the newest blocks by the pressures of both barometers; it covers the last few seconds."""

    references: dict[Foot, float] = field(factory=dict)
    """Pressure at height 0 of each foot's barometer, Pa."""
    newest: float = 0.0
    """Newest height, m."""
    index: int | None = None
    """Number of the block under way."""
    total: float = 0.0
    """Sum of the heights in the block under way, m."""
    count: int = 0
    """Number of heights in the block under way."""
    blocks: deque[tuple[int, float]] = field(factory=deque)
    """Number and mean height, m, of the newest blocks, oldest first."""

    def add(self, foot: Foot, index: int, pressure: float) -> None:
        """Add a pressure, Pa, to the block of that number."""
        if not 2e4 < pressure < 2e5:
            return
        reference = self.references.get(foot)
        if reference is None:
            # a barometer that is read later starts at the height of the other one
            reference = self.references[foot] = pressure * exp(self.newest / SCALE_HEIGHT)
        self.newest = SCALE_HEIGHT * log(reference / pressure)
        if index != self.index:
            self._close()
            self.index = index
        self.total += self.newest
        self.count += 1

    def _close(self) -> None:
        if self.index is not None and self.count:
            self.blocks.append((self.index, self.total / self.count))
            if len(self.blocks) > BLOCKS_BEFORE + BLOCKS_AFTER + 4:
                self.blocks.popleft()
        self.total, self.count = 0.0, 0

    def height(self, first: int, last: int) -> float | None:
        """Return the mean height over these blocks, m; None when they have no pressure."""
        near = [height for index, height in self.blocks if first <= index <= last]
        return sum(near) / len(near) if near else None

    def climbs(self, index: int, block: float) -> tuple[float, ...]:
        """Return the log-likelihood of the slope about a block for each state; `block` is its duration, s."""
        near = [(i * block, height) for i, height in self.blocks if index - BLOCKS_BEFORE <= i <= index + BLOCKS_AFTER]
        if len(near) < 3 or near[-1][0] - near[0][0] < LEAST_SPAN:
            return NO_EVIDENCE
        n = len(near)
        middle = sum([t for t, _ in near]) / n
        spread = sum([(t - middle) ** 2 for t, _ in near])
        slope = sum([(t - middle) * height for t, height in near]) / spread
        variance = NOISE * NOISE / spread
        likely = []
        for mean, deviation in _ORDERED:
            whole = variance + deviation * deviation
            likely.append(-0.5 * (min((slope - mean) ** 2 / whole, 1e3) + log(whole)))
        best = max(likely)
        return tuple([max(WEIGHT * (one - best), -LARGEST_VOTE) for one in likely])
