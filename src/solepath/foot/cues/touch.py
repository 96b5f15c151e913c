"""Ground contact of a foot from its pressure cells.

For an insole of many cells the total load is enough: some cells are always under the foot. For an insole of few cells,
such as switches under heel and toe or eight sensors, one cell that is weak, or slow to unload, makes the total wrong,
and in mid-stance the load may lie between the cells. There, each cell is judged by its load as a share of its own
range. The foot is in the air when the rear cells are unloaded, and the front cells too after they have pushed off. It
is on the ground again when a rear cell is loaded, or a front cell more than by the pressure of the shoe as the toes
rise in swing.

The values in the air are learnt from the lowest ones so far (pressure.py). These are wrong before the first step and
after standing for long, where half of the wearer's weight is the lowest load. So the cells are `trusted` after a swing,
and no longer when the foot stands still while the cells say that it is in the air."""

from __future__ import annotations

from ...types import Layout
from ...types.attrs import define, evolve, field
from ...types.vector import TIE
from ..pressure.cells import centre
from ..pressure.insole import Extremes
from ..stance.stance import Load

FEW = 16
"""Largest number of cells that are judged one by one."""
ON, OFF = 0.07, 0.05
"""Loads of an insole of many cells above which it is on the ground, and below which it is in the air.

They are shares of the wearer's full load. A recorded insole of 35 cells shows up to 5 % of the load throughout the
swing."""
CELL_ON = 0.20
"""Load above which one of few cells is loaded, as a share of its own range of the last seconds."""
CELL_OFF = 0.10
"""Load below which all cells are unloaded without a layout, as a share of their ranges.

Without a layout, front and rear are unknown."""
CONTRAST = 0.5
"""Smallest range of a cell that is known, as a share of the cell's highest value."""
FRONT_LOADED = 0.50
"""Load above which a front cell has pushed off, or landed first, as a share of its range."""
STANCE = 0.3
"""Shortest stance of a foot without push-off, s."""
WEAK = 0.10
"""Smallest range of a cell that is used, as a share of the widest range."""
FLIGHT = 0.1
"""Time after which an airborne foot that moves shows that the cells are right, s.

After the same time, an airborne foot that stands still shows that they are wrong."""


@define
class Touch:
    """Detects ground contact from the load. Latency: none. At first the foot is on the ground."""

    trusted: bool = field(default=False, init=False)
    """The cells were right in the last swing."""
    moving_since: float | None = field(default=None, init=False)
    """Time since which the foot moves without load, or with unknown load, s."""
    still_since: float | None = field(default=None, init=False)
    """Time since which the foot stands still while the cells say that it is in the air, s."""
    load_unknown: bool = field(default=True, init=False)
    """The load of the last sample is unknown."""
    airborne: bool = field(default=False, init=False)
    """The cells say that the foot is in the air."""
    cells: list[Extremes] = field(factory=list, init=False)
    """Extremes of each cell."""
    in_front: list[bool] = field(factory=list, init=False)
    """Cells in the front half of the foot; empty without a layout."""
    peak: float = field(default=0.0, init=False)
    """Highest load of a front cell since the last contact, as a share of its range."""
    landed_at: float = field(default=0.0, init=False)
    """Time of the last contact, s."""

    def set_layout(self, layout: Layout) -> None:
        """Set the layout of the pressure cells."""
        middle = centre(layout)
        self.in_front = [] if middle is None else [cell.x > middle for cell in layout.cells]

    def restart(self) -> Touch:
        """Return a copy for times that restart; the layout stays, the loads do not."""
        fresh = evolve(self)
        fresh.in_front = self.in_front
        return fresh

    def update(self, t: float, load: Load | None, still: bool = False) -> bool:
        """Return whether the foot is in the air; `still` tells that it stands, whatever the cells show."""
        airborne = load is not None and self._is_airborne(t, load)
        moved = self.moving_since is not None and t - self.moving_since >= FLIGHT - TIE
        if load is None:
            self.trusted = False
        elif self.load_unknown:
            # the load is known once it has risen, because the foot came down from a swing or because it stood
            self.trusted = moved
        if moved and airborne:
            self.trusted = True
        self.load_unknown = load is None
        if still or not (airborne or self.load_unknown):
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
        # without push-off this is a valley in mid-stance, where the load lies between the cells, and no swing
        return max(rear, front) < 0.5 * CELL_OFF and t - self.landed_at >= STANCE
