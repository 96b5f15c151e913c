"""Estimation of an unknown layout of pressure cells from the order in which a stance loads them.

The cells of the heel bear the start of each stance and those of the toes its end. So the mean time of a cell's load
within the stance grows from heel to toe. The signal does not show where a cell lies from left to right."""

from __future__ import annotations

from operator import add

from ...types import Cell, Foot, Layout
from ...types.attrs import define, field

LENGTH = 0.26
"""Length of an insole of unknown size, m: size 42."""
REAR, FRONT = 0.1, 0.9
"""Positions of the first and the last loaded cell, as shares of the length."""
UNNAMED = 0
"""Number of an estimated layout."""
STANCES = 2
"""Number of complete stances that an estimate needs."""
ON, OFF = 0.10, 0.05
"""Loads at which a stance starts and ends, as shares of the full load."""
SHORTEST, LONGEST = 0.25, 2.0
"""Shortest and longest stance of walking, s."""
LEAST_LOAD = 0.02
"""Smallest load of a cell that is placed, as a share of the most loaded cell's; others stay in the middle."""


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
    """Sum of the load of each cell over this stance."""
    moments: list[float] = field(factory=list, init=False)
    """Sum of load times time since contact of each cell over this stance."""
    weights: list[float] = field(factory=list, init=False)
    """Sum of the load of each cell over all stances."""
    middles: list[float] = field(factory=list, init=False)
    """Sum of load times relative time in the stance (0 to 1) of each cell over all stances."""
    stances: int = field(default=0, init=False)
    """Number of complete stances so far."""

    def update(self, t: float, cells: tuple[float, ...], share: float) -> Layout | None:
        """Add one sample; return the layout once it is known.

        `cells` are the cells above their values in the air, `share` is their total as a share of the full load."""
        if self.stance_start is None:
            if share > ON:
                self.stance_start = t
                self.loads = list(cells)
                self.moments = [0.0] * len(cells)
            else:
                self.was_airborne = True
            return None
        since = t - self.stance_start
        if share >= OFF and since < LONGEST and len(cells) == len(self.loads):
            self.loads = list(map(add, self.loads, cells))
            self.moments = [moment + since * cell for moment, cell in zip(self.moments, cells, strict=True)]
            return None
        whole, self.stance_start = self.was_airborne, None
        self.was_airborne = share < OFF
        if not whole or not SHORTEST <= since < LONGEST:
            return None
        if len(self.weights) != len(self.loads):
            self.weights, self.middles, self.stances = [0.0] * len(self.loads), [0.0] * len(self.loads), 0
        self.weights = list(map(add, self.weights, self.loads))
        self.middles = [m + moment / since for m, moment in zip(self.middles, self.moments, strict=True)]
        self.stances += 1
        return self._layout() if self.stances >= STANCES else None

    def _layout(self) -> Layout | None:
        most = max(self.weights)
        if most <= 0.0:
            return None
        placed = [w > LEAST_LOAD * most for w in self.weights]
        at = [m / w if known else 0.0 for m, w, known in zip(self.middles, self.weights, placed, strict=True)]
        known = [middle for middle, there in zip(at, placed, strict=True) if there]
        if not known:
            return None
        first, last = min(known), max(known)
        if last <= first:
            return None
        stretch = (FRONT - REAR) * LENGTH / (last - first)
        xs = [
            REAR * LENGTH + (middle - first) * stretch if there else 0.5 * LENGTH
            for middle, there in zip(at, placed, strict=True)
        ]
        return Layout(UNNAMED, self.foot, tuple([Cell(x, 0.0) for x in xs]), LENGTH)
