"""Height from air pressure in blocks (half seconds), and its slope as evidence for stairs and elevators."""

from __future__ import annotations

from collections import deque
from math import exp, fsum, log

from ...types import Foot
from ...types.attrs import define, field
from .chain import (
    ELEVATOR_CREEPS_DOWN,
    ELEVATOR_CREEPS_UP,
    ELEVATOR_HALTS_DOWN,
    ELEVATOR_HALTS_UP,
    ELEVATOR_MOVES_DOWN,
    ELEVATOR_MOVES_UP,
    ELEVATOR_STARTS_DOWN,
    ELEVATOR_STARTS_UP,
    ELEVATOR_STOPS_DOWN,
    ELEVATOR_STOPS_UP,
    RUN,
    STAIRS_DOWN,
    STAIRS_UP,
    STAND,
    UNKNOWN,
    WALK,
)

SCALE_HEIGHT = 8578.0
"""Height over which the pressure of air at 20 degrees Celsius falls to 1/e, m: R T / (M g)."""
MIN_PRESSURE, MAX_PRESSURE = 2e4, 2e5
"""Limits of a plausible air pressure, Pa."""
BLOCK_NOISE = 0.25
"""Standard deviation of the mean height over a block, m; it corresponds to 3 Pa.

Small barometers have a noise of 1 to 3 Pa, and doors change the pressure as well."""
BLOCKS_BEFORE, BLOCKS_AFTER = 3, 2
"""Numbers of blocks before and after the judged one; the slope is computed over all of them."""
MIN_SLOPE_SPAN = 1.0
"""Least time between the first and the last of these blocks with air pressure, s."""
SLOPE_WEIGHT = 1.0 / 3.0
"""Weight of one slope's log-likelihood; it is below 1 because neighbouring slopes share samples."""
MAX_SLOPE_PENALTY = 3.0
"""Largest penalty by a slope (natural logarithm); a door that opens changes the pressure suddenly."""

_SLOPES = {
    STAND: (0.0, 0.05),
    WALK: (0.0, 0.15),
    RUN: (0.0, 0.25),
    STAIRS_UP: (0.3, 0.15),
    STAIRS_DOWN: (-0.3, 0.15),
    UNKNOWN: (0.0, 1.0),
    ELEVATOR_MOVES_UP: (1.3, 0.8),
    ELEVATOR_MOVES_DOWN: (-1.3, 0.8),
    ELEVATOR_STARTS_UP: (0.6, 0.6),
    ELEVATOR_STOPS_UP: (0.6, 0.6),
    ELEVATOR_CREEPS_UP: (0.2, 0.2),
    ELEVATOR_HALTS_UP: (0.1, 0.2),
    ELEVATOR_STARTS_DOWN: (-0.6, 0.6),
    ELEVATOR_STOPS_DOWN: (-0.6, 0.6),
    ELEVATOR_CREEPS_DOWN: (-0.2, 0.2),
    ELEVATOR_HALTS_DOWN: (-0.1, 0.2),
}
"""Mean and standard deviation of the vertical velocity in each state, m/s, positive upwards.

Stairs are climbed at two treads per second; elevators move at 0.5 to 2.5 m/s."""
_SLOPE_OF_STATE = tuple(_SLOPES[state] for state in range(len(_SLOPES)))
NO_EVIDENCE = (0.0,) * len(_SLOPE_OF_STATE)


@define
class PressureHeight:
    """The mean heights of the newest blocks (the last few seconds), by the barometers of both feet."""

    references: dict[Foot, float] = field(factory=dict)
    """Pressure at height 0 of each foot's barometer, Pa."""
    newest: float = 0.0
    """Newest height, m above the first reading."""
    index: int | None = None
    """Number of the block under way."""
    height_sum: float = 0.0
    """Sum of the heights in the block under way, m."""
    height_count: int = 0
    """Number of heights in the block under way."""
    blocks: deque[tuple[int, float]] = field(factory=deque)
    """Number and mean height, m, of each of the newest blocks, oldest first."""
    walked: bool = False
    """Flag: the wearer has taken a stride. Before, no force can have shown that an elevator set off, and a slope of the
    air pressure alone is no ride."""
    faulty: list[Foot] = field(factory=list)
    """Feet whose barometers contradict the strides, and are left out."""

    def add(self, foot: Foot, index: int, pressure: float) -> None:
        """Add a foot's air pressure, Pa, to the block number `index`."""
        if not MIN_PRESSURE < pressure < MAX_PRESSURE or foot in self.faulty:
            return
        reference = self.references.get(foot)
        if reference is None:
            # a barometer that is read later starts at the height of the other one
            reference = self.references[foot] = pressure * exp(self.newest / SCALE_HEIGHT)
        self.newest = SCALE_HEIGHT * log(reference / pressure)
        if index != self.index:
            self._close()
            self.index = index
        self.height_sum += self.newest
        self.height_count += 1

    def leave_out(self, foot: Foot) -> None:
        """Stop to use a foot's barometer, and forget the heights to which it has contributed."""
        if foot not in self.faulty:
            self.faulty.append(foot)
        self.references.pop(foot, None)
        self.blocks.clear()
        self.index, self.height_sum, self.height_count = None, 0.0, 0

    def use_again(self, foot: Foot) -> None:
        """Use a foot's barometer, or another one in its place."""
        if foot in self.faulty:
            self.faulty.remove(foot)

    def _close(self) -> None:
        if self.index is not None and self.height_count:
            self.blocks.append((self.index, self.height_sum / self.height_count))
            if len(self.blocks) > BLOCKS_BEFORE + BLOCKS_AFTER + 4:
                self.blocks.popleft()
        self.height_sum, self.height_count = 0.0, 0

    def height(self, first: int, last: int) -> float | None:
        """Return the mean height over the blocks `first` to `last`, m; None when they have no pressure."""
        neighbours = [height for index, height in self.blocks if first <= index <= last]
        return fsum(neighbours) / len(neighbours) if neighbours else None

    def score_slope(self, index: int, block: float) -> tuple[float, ...]:
        """Return the log-likelihood of the slope around block number `index` for each state, relative to the best.

        `block` is the duration of a block, s."""
        neighbours = [
            (i * block, height) for i, height in self.blocks if index - BLOCKS_BEFORE <= i <= index + BLOCKS_AFTER
        ]
        if not self.walked or len(neighbours) < 3 or neighbours[-1][0] - neighbours[0][0] < MIN_SLOPE_SPAN:
            return NO_EVIDENCE
        n = len(neighbours)
        middle = fsum([t for t, _ in neighbours]) / n
        spread = fsum([(t - middle) ** 2 for t, _ in neighbours])
        slope = fsum([(t - middle) * height for t, height in neighbours]) / spread
        variance = BLOCK_NOISE * BLOCK_NOISE / spread
        scores = []
        for mean, deviation in _SLOPE_OF_STATE:
            total = variance + deviation * deviation
            scores.append(-0.5 * (min((slope - mean) ** 2 / total, 1e3) + log(total)))
        best = max(scores)
        return tuple([max(SLOPE_WEIGHT * (score - best), -MAX_SLOPE_PENALTY) for score in scores])
