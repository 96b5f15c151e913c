"""Whether a foot is on the ground or in the air, from its cells.

Insoles of many cells tell by the total: whatever lies under the foot, some cells feel it. On one of few, a switch
under heel and toe or eight sensors, a cell that is weak, or slow to let go, spoils the total, and in mid-stance the
load may lie between them. There every cell is looked at as a share of its own range. The foot is in the air when the
rear cells have let go and the front ones too after they had pushed off; it is on the ground again when a rear cell is
loaded, or a front one for more than the shoe's own pressure as the toes are raised in swing.

What an insole shows in the air is learnt from the least that it showed (pressure.py), which is wrong before the first
step and after a long stand: half of the wearer's weight is then the least. So what the cells say is believed
(`trusted`) from a swing on, and no longer when a foot that they have in the air stands still.
"""

from __future__ import annotations

from ...types import Layout
from ...types.attrs import define, evolve, field
from ...types.vector import TIE
from ..pressure.cells import centre
from ..pressure.insole import Extremes
from ..stance.stance import Load

FEW = 16
"""Up to so many cells are looked at one by one."""
ON, OFF = 0.07, 0.05
"""Many cells: on the ground above the first of these shares of the wearer's full load, and in the air below the other:
a recorded insole of 35 cells shows up to 5 % of the load throughout the swing."""
CELL_ON = 0.20
"""Few cells: one is loaded above this share of its own range of the last seconds."""
CELL_OFF = 0.10
"""Without a layout, which tells front from rear, all cells are unloaded below this."""
CONTRAST = 0.5
"""A cell's range is known once it is this share of its highest value."""
FRONT_LOADED = 0.50
"""A front cell has pushed off, or landed first, above this share."""
STANCE = 0.3
"""A foot that did not push off stays on the ground for so long, s."""
WEAK = 0.10
"""A cell whose range is below this share of the widest one's tells nothing."""
FLIGHT = 0.1
"""A foot that is in the air and moves, or stands still, for so long: the cells are right, or wrong, s."""


@define
class Touch:
    """Latency: none. A foot of which nothing is known yet is on the ground."""

    trusted: bool = field(default=False, init=False)
    """The cells were right when the foot swung last."""
    moving_since: float | None = field(default=None, init=False)
    """Since when the foot moved without load, or before any was known, s."""
    still_since: float | None = field(default=None, init=False)
    """Since when it stood still though the cells have it in the air, s."""
    unloaded: bool = field(default=True, init=False)
    """There was no load in the last sample."""
    airborne: bool = field(default=False, init=False)
    cells: list[Extremes] = field(factory=list, init=False)
    in_front: list[bool] = field(factory=list, init=False)
    """Which cells lie in the front half of the foot; empty without a layout."""
    peak: float = field(default=0.0, init=False)
    """The highest share of a front cell since the foot came down."""
    landed_at: float = field(default=0.0, init=False)
    """When that was, s."""

    def set_layout(self, layout: Layout) -> None:
        """The device said where its cells are."""
        middle = centre(layout)
        self.in_front = [] if middle is None else [cell.x > middle for cell in layout.cells]

    def restart(self) -> Touch:
        """For times that begin anew: where the cells are is kept, what they showed is not."""
        fresh = evolve(self)
        fresh.in_front = self.in_front
        return fresh

    def update(self, t: float, load: Load | None, still: bool = False) -> bool:
        """True when the foot is in the air. `still`: it stands, whatever the cells say."""
        airborne = load is not None and self._is_airborne(t, load)
        moved = self.moving_since is not None and t - self.moving_since >= FLIGHT - TIE
        if load is None:
            self.trusted = False
        elif self.unloaded:
            # a load is known from when it has risen; it rose because the foot came down from a swing, or it stood
            self.trusted = moved
        if moved and airborne:
            self.trusted = True
        self.unloaded = load is None
        if still or not (airborne or self.unloaded):
            self.moving_since = None
        elif self.moving_since is None:
            self.moving_since = t
        if not (still and airborne):
            self.still_since = None
        elif self.still_since is None:
            self.still_since = t
        elif t - self.still_since >= FLIGHT - TIE:
            self.trusted = False
        return airborne

    def _is_airborne(self, t: float, load: Load) -> bool:
        if 0 < len(load.cells) <= FEW:
            self.airborne = self._is_airborne_by_cell(t, load.cells)
        else:
            self.airborne = load.total < (ON if self.airborne else OFF)
        return self.airborne

    def _is_airborne_by_cell(self, t: float, values: tuple[float, ...]) -> bool:
        if len(self.cells) != len(values):
            self.cells = [Extremes() for _ in values]
            if len(self.in_front) != len(values):
                self.in_front = []
        widest = 0.0
        for extremes, value in zip(self.cells, values, strict=True):
            extremes.update(t, value)
            widest = max(widest, extremes.high - extremes.low)
        front = rear = 0.0
        known = False
        for k, (extremes, value) in enumerate(zip(self.cells, values, strict=True)):
            reach = extremes.high - extremes.low
            if reach <= 0.0 or reach < CONTRAST * extremes.high or reach < WEAK * widest:
                continue
            known = True
            share = (value - extremes.low) / reach
            if self.in_front and self.in_front[k]:
                front = max(front, share)
            else:
                rear = max(rear, share)
        if not known:
            return False
        if not self.in_front:
            return rear < (CELL_ON if self.airborne else CELL_OFF)
        if self.airborne:
            if rear > CELL_ON or front > FRONT_LOADED:
                self.peak = front
                self.landed_at = t
                return False
            return True
        self.peak = max(self.peak, front)
        if self.peak > FRONT_LOADED:
            return rear < CELL_ON and front < CELL_ON
        # it has not pushed off: a valley in mid-stance, where the load lies between the cells, is no swing
        return max(rear, front) < 0.5 * CELL_OFF and t - self.landed_at >= STANCE
