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

MOST_SINGLE_CELLS = 16
"""Largest number of cells that are judged one by one."""
GROUND_LOAD, AIR_LOAD = 0.07, 0.05
"""Loads of an insole of many cells above which it is on the ground, and below which it is in the air.

They are shares of the wearer's full load. A recorded insole of 35 cells shows up to 5 % of the load throughout the
swing."""
CELL_LOADED = 0.20
"""Load above which one of few cells is loaded, as a share of its own range of the last seconds."""
CELLS_UNLOADED = 0.10
"""Load below which all cells are unloaded without a layout, as a share of their ranges.

Without a layout, front and rear are unknown."""
LEAST_CELL_RANGE = 0.5
"""Smallest range of a cell that is known, as a share of the cell's highest value."""
FRONT_LOADED = 0.50
"""Load above which a front cell has pushed off, or landed first, as a share of its range."""
SHORTEST_STANCE = 0.3
"""Shortest stance of a foot without push-off, s."""
WEAK_CELL_RANGE = 0.10
"""Smallest range of a cell that is used, as a share of the widest range."""
TRUST_TIME = 0.1
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
    front_peak: float = field(default=0.0, init=False)
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
        moved = self.moving_since is not None and t - self.moving_since >= TRUST_TIME - TIE
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
        elif t - self.still_since >= TRUST_TIME - TIE:
            self.trusted = False
        return airborne

    def _is_airborne(self, t: float, load: Load) -> bool:
        if 0 < len(load.cells) <= MOST_SINGLE_CELLS:
            self.airborne = self._is_airborne_by_cell(t, load.cells)
        else:
            self.airborne = load.total < (GROUND_LOAD if self.airborne else AIR_LOAD)
        return self.airborne

    def _is_airborne_by_cell(self, t: float, values: tuple[float, ...]) -> bool:
        if len(self.cells) != len(values):
            self.cells = [Extremes() for _ in values]
            if len(self.in_front) != len(values):
                self.in_front = []
        widest_range = 0.0
        for extremes, value in zip(self.cells, values, strict=True):
            extremes.update(t, value)
            widest_range = max(widest_range, extremes.high - extremes.low)
        front = rear = 0.0
        any_known = False
        for k, (extremes, value) in enumerate(zip(self.cells, values, strict=True)):
            cell_range = extremes.high - extremes.low
            if cell_range <= 0.0 or cell_range < LEAST_CELL_RANGE * extremes.high or cell_range < WEAK_CELL_RANGE * widest_range:
                continue
            any_known = True
            share = (value - extremes.low) / cell_range
            if self.in_front and self.in_front[k]:
                front = max(front, share)
            else:
                rear = max(rear, share)
        if not any_known:
            return False
        if not self.in_front:
            return rear < (CELL_LOADED if self.airborne else CELLS_UNLOADED)
        if self.airborne:
            if rear > CELL_LOADED or front > FRONT_LOADED:
                self.front_peak = front
                self.landed_at = t
                return False
            return True
        self.front_peak = max(self.front_peak, front)
        if self.front_peak > FRONT_LOADED:
            return rear < CELL_LOADED and front < CELL_LOADED
        # without push-off this is a valley in mid-stance, where the load lies between the cells, and no swing
        return max(rear, front) < 0.5 * CELLS_UNLOADED and t - self.landed_at >= SHORTEST_STANCE
