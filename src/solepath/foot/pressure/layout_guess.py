"""Where the cells of an insole are, when nobody says: from the order in which a stance loads them.

The heel's cells carry the beginning of every stance and the toes' its end, so the middle of a cell's load within the
stance grows from heel to toe. Where it lies from left to right the signal does not tell.
"""

from __future__ import annotations

from operator import add

from ...types import Cell, Foot, Layout
from ...types.attrs import define, field

LENGTH = 0.26
"""Of an insole that says nothing, m: a size 42."""
REAR, FRONT = 0.1, 0.9
"""Where the cells that are loaded first and last are put, as shares of the length."""
UNNAMED = 0
"""Number of a layout that was guessed."""
STANCES = 2
"""So many stances must have been seen whole."""
ON, OFF = 0.10, 0.05
"""Shares of the full load at which a stance begins and ends."""
SHORTEST, LONGEST = 0.25, 2.0
"""Contacts outside this are no stances of walking, s."""
LEAST_LOAD = 0.02
"""A cell with less than this share of the most loaded cell's load is not placed: it stays in the middle."""


@define
class LayoutGuess:
    """Feed it every sample until it answers. Costs two additions a cell, and nothing more once it has answered."""

    foot: Foot
    stance_start: float | None = field(default=None, init=False)
    """When the stance did, s; None while the foot is in the air."""
    was_airborne: bool = field(default=False, init=False)
    """The foot was in the air before this stance, so its beginning was seen."""
    loads: list[float] = field(factory=list, init=False)
    moments: list[float] = field(factory=list, init=False)
    """Over this stance, by cell: sums of the load, and of load times time since contact."""
    weights: list[float] = field(factory=list, init=False)
    middles: list[float] = field(factory=list, init=False)
    """Over all stances, by cell: load, and load times where in the stance it came, 0 to 1."""
    stances: int = field(default=0, init=False)

    def update(self, t: float, cells: tuple[float, ...], share: float) -> Layout | None:
        """One sample: the cells above what they show in the air, and their total as a share of the full load."""
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
