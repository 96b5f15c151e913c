"""Ground contact of a foot from its pressure cells.

For an insole of many cells the total load is enough, because some cells are always under the foot. An insole of few
cells has, for example, switches under heel and toe, or eight sensors. There, one cell that is weak or slow to unload
makes the total wrong, and in mid-stance the load may lie between the cells. So each cell is judged by its load as a
share of its own range. The foot is in the air when the rear cells are unloaded, and the front cells are unloaded after
they have pushed off. It is on the ground again when a rear cell is loaded, or when a front cell is loaded by more than
the pressure of the shoe, which acts on it as the toes rise in swing.

The values in the air are the lowest of the last 8 to 10 s, or those of the last swing (pressure/insole.py). The former
are wrong before the first step and after standing for long, when half of the wearer's weight is the lowest load. So the
cells are `trusted` only after a swing. Trust ends when the foot stands still while the cells show no load.

The numbers were chosen by hand and not swept."""

from __future__ import annotations

from ...types import Floats, Layout
from ...types.attrs import evolve, field, frozen, state, stateful
from ...types.vector import TIME_EPSILON
from ..pressure.insole import Extremes, centre
from ..stance.stance import Load
from .cues import MOST_SINGLE_CELLS

CELL_LOADED = 0.20
"""Load above which one of few cells is loaded, as a share of its own range in the last 8 to 10 s."""
CELLS_UNLOADED = 0.10
"""Load below which a foot leaves the ground without a layout if all cells are below it, as a share of their ranges.

Without a layout, front and rear are unknown."""
LEAST_CELL_RANGE = 0.5
"""Smallest range of a cell that has been both loaded and unloaded, as a share of the cell's highest value."""
FRONT_LOADED = 0.50
"""Load above which a front cell pushes off, or is the first to land, as a share of its range."""
SHORTEST_STANCE = 0.3
"""Shortest stance of a foot without push-off, s."""
WEAK_CELL_RANGE = 0.10
"""Smallest range of a cell that is used, as a share of the widest range."""
TRUST_TIME = 0.1
"""Duration of an airborne state that decides whether the cells are trusted, s.

They are right if the foot moves during this time, and wrong if it stands still."""


@frozen
class TouchSettings:
    """The settings of `Touch`, which stands in for the total load on insoles of few cells (gait_cues.py).

    A recorded insole of 35 cells shows up to 5 % of the load throughout the swing."""

    ground_load: float = 0.07
    """Load at which the foot lands, as a share of the full load."""
    air_load: float = 0.05
    """Load below which the foot leaves the ground, as a share of the full load."""


@stateful
class Touch:
    """Detects ground contact from the load. Latency: none. At first the foot is on the ground."""

    settings: TouchSettings = field(default=TouchSettings())
    trusted: bool = False
    """The cells were right in the last swing, and nothing has contradicted them since."""
    moving_since: float | None = None
    """Time since which the foot moves without load, or with unknown load, s; None while it does not."""
    still_since: float | None = None
    """Time since which the foot stands still although the cells show no load, s; None while it does not."""
    load_unknown: bool = True
    """The load of the last sample is unknown."""
    airborne: bool = False
    """The foot is in the air according to the cells."""
    cells: list[Extremes] = state(factory=list)
    """Lowest and highest recent value of each cell."""
    in_front: list[bool] = state(factory=list)
    """Flag for each cell, True in the front half of the foot; empty without a layout."""
    front_peak: float = 0.0
    """Highest load of any front cell since the last contact, as a share of its range."""
    landed_at: float = 0.0
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
        """Return whether the foot is in the air; `still` is True when the inertial sensor shows that it stands."""
        airborne = load is not None and self._is_airborne(t, load)
        moved = self.moving_since is not None and t - self.moving_since >= TRUST_TIME - TIME_EPSILON
        if load is None:
            self.trusted = False
        elif self.load_unknown:
            # the load becomes known when it rises: after a swing, in which the foot moved, or while the wearer stands
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
        elif t - self.still_since >= TRUST_TIME - TIME_EPSILON:
            self.trusted = False
        return airborne

    def _is_airborne(self, t: float, load: Load) -> bool:
        if 0 < len(load.cells) <= MOST_SINGLE_CELLS:
            self.airborne = self._is_airborne_by_cell(t, load.cells, load.unloaded)
        else:
            self.airborne = load.total < (self.settings.ground_load if self.airborne else self.settings.air_load)
        return self.airborne

    def _is_airborne_by_cell(self, t: float, values: Floats, unloaded: Floats) -> bool:
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
            low, zero = extremes.low, 0.0
            if k < len(unloaded):
                zero = unloaded[k]
                low = max(low, zero)
            cell_range = extremes.high - low
            if (
                cell_range <= 0.0
                or extremes.high - extremes.low < LEAST_CELL_RANGE * (extremes.high - zero)
                or cell_range < WEAK_CELL_RANGE * widest_range
            ):
                continue
            any_known = True
            share = (value - low) / cell_range
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
