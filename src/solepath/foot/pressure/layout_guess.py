"""Estimation of an unknown layout of pressure cells from the order in which a stance loads them.

The cells of the heel bear the start of each stance and those of the toes its end. So the mean time of a cell's load
within the stance grows from heel to toe. The signal does not show where a cell lies from left to right.

The full load is that of all cells when they bear the wearer (insole.py). The origin of the numbers is not recorded."""

from __future__ import annotations

from operator import add

from ...types import Cell, Foot, Layout
from ...types.attrs import define, field

ASSUMED_LENGTH = 0.26
"""Length of an insole of unknown size, m: that of size 42."""
REAR_POSITION, FRONT_POSITION = 0.1, 0.9
"""Positions of the first and the last loaded cell, measured from the heel, as shares of the length, 0 to 1."""
ESTIMATED_LAYOUT_ID = 0
"""Value of `Layout.id` for an estimated layout."""
STANCES_OF_ESTIMATE = 2
"""Number of complete stances that an estimate needs."""
STANCE_START_LOAD, STANCE_END_LOAD = 0.10, 0.05
"""Loads at which a stance starts and ends, as shares of the full load, 0 to 1."""
SHORTEST_STANCE, LONGEST_STANCE = 0.25, 2.0
"""Shortest and longest stance of walking, s."""
LEAST_CELL_LOAD = 0.02
"""Smallest load of a cell whose position is estimated, as a share of the most loaded cell's.

Other cells get the middle of the insole."""


@define
class LayoutGuess:
    """Estimates the layout of an insole from its samples.

    Call `update` with every sample until it returns a layout. A sample costs two additions a cell."""

    foot: Foot
    stance_start: float | None = field(default=None, init=False)
    """Start of the current stance, s; None while the foot is in the air."""
    was_airborne: bool = field(default=False, init=False)
    """The foot was in the air before this stance, so the start of the stance is known."""
    loads: list[float] = field(factory=list, init=False)
    """For each cell, sum of its load over this stance."""
    moments: list[float] = field(factory=list, init=False)
    """For each cell, sum of its load times the time since the start of this stance, s."""
    weights: list[float] = field(factory=list, init=False)
    """For each cell, sum of its load over all stances."""
    relative_times: list[float] = field(factory=list, init=False)
    """For each cell, sum over all stances of its load times the relative time in the stance (0 to 1)."""
    stances: int = field(default=0, init=False)
    """Number of complete stances so far."""

    def update(self, t: float, cells: tuple[float, ...], load_share: float) -> Layout | None:
        """Add one sample; return the layout once it is known.

        `cells` holds the values minus those in the air, `load_share` their total as a share of the full load."""
        if self.stance_start is None:
            if load_share > STANCE_START_LOAD:
                self.stance_start = t
                self.loads = list(cells)
                self.moments = [0.0] * len(cells)
            else:
                self.was_airborne = True
            return None
        time_since_start = t - self.stance_start
        if load_share >= STANCE_END_LOAD and time_since_start < LONGEST_STANCE and len(cells) == len(self.loads):
            self.loads = list(map(add, self.loads, cells))
            self.moments = [moment + time_since_start * cell for moment, cell in zip(self.moments, cells, strict=True)]
            return None
        is_complete, self.stance_start = self.was_airborne, None
        self.was_airborne = load_share < STANCE_END_LOAD
        if not is_complete or not SHORTEST_STANCE <= time_since_start < LONGEST_STANCE:
            return None
        if len(self.weights) != len(self.loads):
            self.weights, self.relative_times, self.stances = [0.0] * len(self.loads), [0.0] * len(self.loads), 0
        self.weights = list(map(add, self.weights, self.loads))
        self.relative_times = [
            m + moment / time_since_start for m, moment in zip(self.relative_times, self.moments, strict=True)
        ]
        self.stances += 1
        return self._layout() if self.stances >= STANCES_OF_ESTIMATE else None

    def _layout(self) -> Layout | None:
        largest_weight = max(self.weights)
        if largest_weight <= 0.0:
            return None
        is_loaded = [w > LEAST_CELL_LOAD * largest_weight for w in self.weights]
        mean_times = [
            m / w if loaded else 0.0 for m, w, loaded in zip(self.relative_times, self.weights, is_loaded, strict=True)
        ]
        known_times = [middle for middle, loaded in zip(mean_times, is_loaded, strict=True) if loaded]
        if not known_times:
            return None
        earliest, latest = min(known_times), max(known_times)
        if latest <= earliest:
            return None
        metres_per_time = (FRONT_POSITION - REAR_POSITION) * ASSUMED_LENGTH / (latest - earliest)
        xs = [
            REAR_POSITION * ASSUMED_LENGTH + (middle - earliest) * metres_per_time if loaded else 0.5 * ASSUMED_LENGTH
            for middle, loaded in zip(mean_times, is_loaded, strict=True)
        ]
        return Layout(ESTIMATED_LAYOUT_ID, self.foot, tuple([Cell(x, 0.0) for x in xs]), ASSUMED_LENGTH)
