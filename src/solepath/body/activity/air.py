"""Height from air pressure, half a second at a time, and what its slope says of stairs and lifts."""

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

SCALE = 8578.0
"""Height over which the pressure of air of 20 degrees falls to 1/e, m: R T / (M g)."""
NOISE = 0.25
"""Deviation of the mean over half a second, m: 3 Pa. Small barometers flicker by 1 to 3 Pa, and doors add to it."""
BEFORE, AFTER = 3, 2
"""Blocks before and after the one that is told, over which the slope is taken."""
LEAST = 1.0
"""They must span so long, s."""
WEIGHT = 1.0 / 3.0
"""Neighbouring slopes are of the same samples, so each counts so much."""
WORST = 3.0
"""A slope speaks no louder than this (natural logarithm): a door that opens is a gust."""

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
NOTHING = (0.0,) * len(_ORDERED)


@define
class PressureHeight:
    """Feed it every pressure; `climbs` and `height` look back a few seconds."""

    references: dict[Foot, float] = field(factory=dict)
    """Pressure at height 0 by each foot's barometer, Pa."""
    newest: float = 0.0
    """m."""
    index: int | None = None
    """Of the block under way."""
    total: float = 0.0
    count: int = 0
    blocks: deque[tuple[int, float]] = field(factory=deque)
    """Number and mean height, m, of the newest blocks, oldest first."""

    def add(self, foot: Foot, index: int, pressure: float) -> None:
        """A pressure in Pa in the block of that number."""
        if not 2e4 < pressure < 2e5:
            return
        reference = self.references.get(foot)
        if reference is None:
            # a barometer that is heard later goes on where the other one is
            reference = self.references[foot] = pressure * exp(self.newest / SCALE)
        self.newest = SCALE * log(reference / pressure)
        if index != self.index:
            self._close()
            self.index = index
        self.total += self.newest
        self.count += 1

    def _close(self) -> None:
        if self.index is not None and self.count:
            self.blocks.append((self.index, self.total / self.count))
            if len(self.blocks) > BEFORE + AFTER + 4:
                self.blocks.popleft()
        self.total, self.count = 0.0, 0

    def height(self, first: int, last: int) -> float | None:
        """Mean over these blocks, m; None when nothing was heard in them."""
        near = [height for index, height in self.blocks if first <= index <= last]
        return sum(near) / len(near) if near else None

    def climbs(self, index: int, block: float) -> tuple[float, ...]:
        """Logarithm of how likely the slope about the block of that number is, for each state; `block`: s."""
        near = [(i * block, height) for i, height in self.blocks if index - BEFORE <= i <= index + AFTER]
        if len(near) < 3 or near[-1][0] - near[0][0] < LEAST:
            return NOTHING
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
        return tuple([max(WEIGHT * (one - best), -WORST) for one in likely])
