"""Whether a foot is on the ground or in the air, from its cells.

Insoles of many cells tell by the total: whatever lies under the foot, some cells feel it. On one of few cells, a switch
under heel and toe or eight sensors, a cell that is weak, or slow to let go, spoils the total; there every cell is
looked at as a share of its own range, and the foot is in the air when none of them is loaded.
"""

from __future__ import annotations

from attrs import define, field

from .pressure import Extremes
from .stance import Load

FEW = 16
"""Up to so many cells are looked at one by one."""


@define
class Touch:
    """Latency: none. A foot of which nothing is known yet is on the ground."""

    on: float = 0.03
    """Many cells: on the ground above this share of the wearer's full load; in the air when `Load.airborne` says so."""
    cell_on: float = 0.20
    """Few cells: a cell is loaded above this share of its own range of the last seconds,"""
    cell_off: float = 0.10
    """and unloaded below this."""
    contrast: float = 0.5
    """A cell's range is known once it is this share of its highest value."""
    weak: float = 0.10
    """A cell whose range is below this share of the widest one's tells nothing."""
    # state
    airborne: bool = field(default=False, init=False)
    cells: list[Extremes] = field(factory=list, init=False)
    loaded: list[bool] = field(factory=list, init=False)

    def update(self, t: float, load: Load) -> bool:
        """True when the foot is in the air."""
        if 0 < len(load.cells) <= FEW:
            self.airborne = self._by_cell(t, load.cells)
        elif self.airborne:
            self.airborne = load.total < self.on
        else:
            self.airborne = load.airborne
        return self.airborne

    def _by_cell(self, t: float, values: tuple[float, ...]) -> bool:
        if len(self.cells) != len(values):
            self.cells = [Extremes() for _ in values]
            self.loaded = [True] * len(values)
        widest = 0.0
        for extremes, value in zip(self.cells, values, strict=True):
            extremes.update(t, value)
            widest = max(widest, extremes.high - extremes.low)
        known = any_loaded = False
        for k, (extremes, value) in enumerate(zip(self.cells, values, strict=True)):
            reach = extremes.high - extremes.low
            if reach <= 0.0 or reach < self.contrast * extremes.high or reach < self.weak * widest:
                continue
            known = True
            share = (value - extremes.low) / reach
            self.loaded[k] = share > (self.cell_off if self.loaded[k] else self.cell_on)
            any_loaded = any_loaded or self.loaded[k]
        return known and not any_loaded

    def interrupt(self) -> None:
        """Times begin anew: the extremes are kept, but their spans end here."""
        for extremes in self.cells:
            extremes.ends = None
