"""Detection of failed pressure cells of one insole, and the values that can still be used.

Cells are judged over windows of walking, each of which contains SWINGS_OF_WINDOW swings of the foot.

- DEAD, STUCK and SATURATED are reported when two windows in a row show the fault (cell_window.py).
- MISSING is reported when for MISSING_TIME the cell gives no number, or samples do not have as many cells as the
  insole. This needs no swings.

`usable` returns 0 for failed cells, so load, areas and centre of pressure work without them. A cell that loads again in
two windows in a row is used again. This is not reported, but another failure of the same cell is. If a sample has a
wrong number of cells, its pressure is not used, but its inertial part is. Without a layout, a wrong number that lasts
for MISSING_TIME means another insole.

A cell is "lively" in a window in which it both loads and unloads. The numbers were chosen by hand and not swept."""

from __future__ import annotations

from math import hypot

from ...events import CellFault, CellsFailed, Event, InsoleNeverUnloads
from ...types import Layout, Phase, Site, Vec3
from ...types.attrs import define, field
from ..rejection import ABSURD_PRESSURE
from .cell_window import LIVELY_WINDOWS_ALONE, CellWindow, unloads
from .cells import CellSpan

CHECK_INTERVAL = 0.0795
"""Interval at which the cells are checked, s; a load under the toes lasts about 0.15 s."""
LEAST_SWING_RATE, LEAST_SWING_INTERVAL = 3.0, 0.7
"""Angular rate of a foot in swing, rad/s, and the time for which higher rates then belong to the same swing, s."""
SHORTEST_WINDOW, LONGEST_WINDOW = 3.0, 30.0
"""Shortest and longest duration of a window, s."""
SWINGS_OF_WINDOW, MISSING_TIME = 4, 1.0
"""Number of swings in a window, and time without a number after which a cell is missing, s."""


@define
class CellHealth:
    """The health of the cells of one insole.

    Call `update` with every sample in order of time, then use the cells that `usable` returns. A sample costs one sum;
    12 times a second a sample also updates the extremes of each cell."""

    site: Site
    count: int = field(default=0, init=False)
    """Number of cells; 0 before any."""
    span: CellSpan = field(factory=CellSpan, init=False)
    """Extremes of the cells in the current window."""
    checked_at: float | None = field(default=None, init=False)
    """Time of the last check of the cells, s; None before any."""
    window_start: float | None = field(default=None, init=False)
    """Start of the current window, s; None before any."""
    swings: int = field(default=0, init=False)
    """Number of swings in the current window."""
    swing_start: float | None = field(default=None, init=False)
    """Start of the last swing, s; None before any."""
    airborne: bool = field(default=False, init=False)
    """The foot was in the air in the last sample without an angular rate."""
    suspected: dict[CellFault, list[int]] = field(factory=dict, init=False)
    """Faults that the last window showed, each with the indices of its cells."""
    failed: dict[CellFault, list[int]] = field(factory=dict, init=False)
    """Faults that were reported and last, each with the indices of its cells."""
    excluded: list[int] = field(factory=list, init=False)
    """Indices of all failed cells."""
    lively_windows: list[int] = field(factory=list, init=False)
    """For each cell, number of windows in a row in which it was lively."""
    non_numeric: list[tuple[int, float]] = field(factory=list, init=False)
    """Index of each cell that gives no number now, and the time since which it gives none, s."""
    wrong_count: int | None = field(default=None, init=False)
    """Number of cells of the current samples if it is wrong; None otherwise."""
    wrong_count_since: float = field(default=0.0, init=False)
    """Time since which the number of cells is wrong, s."""
    wrong_count_reported: bool = field(default=False, init=False)
    """The wrong number of cells was reported."""
    loaded_windows: int = field(default=0, init=False)
    """Number of windows in a row in which the insole did not unload."""
    loaded_windows_start: float = field(default=0.0, init=False)
    """Start of the first window in which the insole did not unload, s."""
    constant_windows: int = field(default=0, init=False)
    """Number of windows in a row in which no cell showed any load."""

    def reset(self) -> None:
        """Discard the current window, because times restart; failed cells stay failed."""
        self.checked_at = self.window_start = self.swing_start = None
        self.span, self.swings, self.non_numeric, self.wrong_count = CellSpan(), 0, [], None

    def update(
        self,
        t: float,
        known_at: float,
        cells: tuple[float, ...],
        phase: Phase,
        gyro: Vec3 | None = None,
        layout: Layout | None = None,
    ) -> list[Event]:
        """Return the events of one sample at `t`, s, with raw `cells`.

        `cells` is () for a sample of an inertial sensor that sends separately from the cells. `phase` is that of the
        foot, `gyro` is in rad/s, and `layout` comes from the device or a calibration."""
        events: list[Event] = []
        if layout is not None and self.count != len(layout.cells):
            self._set_count(len(layout.cells))
        if len(cells) != self.count and not self._accept_count(t, known_at, len(cells), layout, events):
            return events
        self.wrong_count = None
        try:
            all_numeric = hypot(*cells) < ABSURD_PRESSURE
        except (TypeError, OverflowError):
            all_numeric = False
        if self.non_numeric or not all_numeric:
            self._watch_numbers(t, known_at, cells, events)
            cells = self.usable(cells)
            if not cells:
                return events
        if self.checked_at is None or not 0.0 <= t - self.checked_at < CHECK_INTERVAL:
            self.checked_at = t
            if self.window_start is None or not 0.0 <= t - self.window_start < LONGEST_WINDOW:
                self.window_start, self.swings, self.span = t, 0, CellSpan()
            self.span.add(cells, self.excluded)
        x, y, z = (LEAST_SWING_RATE, LEAST_SWING_RATE, LEAST_SWING_RATE) if gyro is None else gyro
        if x * x + y * y + z * z >= LEAST_SWING_RATE * LEAST_SWING_RATE and self._swing_starts(t, phase, gyro is None):
            self.swings += 1
            if (
                self.swings >= SWINGS_OF_WINDOW
                and self.window_start is not None
                and t - self.window_start >= SHORTEST_WINDOW
            ):
                self._judge(t, known_at, self.window_start, layout, events)
                self.window_start, self.swings, self.span = t, 0, CellSpan()
        return events

    def usable(self, cells: tuple[float, ...]) -> tuple[float, ...]:
        """Return `cells`, those of the last `update`, with 0 for failed cells and for values that are no numbers.

        The result is () when no cell can be used."""
        if len(cells) != self.count:
            return ()
        if not self.non_numeric:
            if not self.excluded:
                return cells
            usable_cells = list(cells)
        else:
            usable_cells = [value if _is_number(value) else 0.0 for value in cells]
            if len(self.non_numeric) == self.count:
                return ()
        for i in self.excluded:
            usable_cells[i] = 0.0
        return tuple(usable_cells)

    def _accept_count(self, t: float, known_at: float, count: int, layout: Layout | None, events: list[Event]) -> bool:
        """Return whether samples with `count` cells, a new number, are used from now on."""
        if self.count == 0:
            if count == 0:
                return False
            self._set_count(count)
            return True
        if count != self.wrong_count or t < self.wrong_count_since:
            self.wrong_count, self.wrong_count_since = count, t
            return False
        if t - self.wrong_count_since < MISSING_TIME:
            return False
        if not self.wrong_count_reported:
            missing_cells = tuple(range(count, self.count)) or tuple(range(self.count, count))
            self.wrong_count_reported = True
            self._report(t, known_at, CellFault.MISSING, missing_cells, events)
        if layout is None and count:
            self._set_count(count)
            return True
        return False

    def _set_count(self, count: int) -> None:
        """Restart for another insole of `count` cells."""
        self.count, self.wrong_count_reported = count, False
        self.failed, self.suspected, self.excluded, self.lively_windows = {}, {}, [], []
        self.reset()

    def _watch_numbers(self, t: float, known_at: float, cells: tuple[float, ...], events: list[Event]) -> None:
        since = dict(self.non_numeric)
        self.non_numeric = [(i, since.get(i, t)) for i, value in enumerate(cells) if not _is_number(value)]
        reported = self.failed.get(CellFault.MISSING, [])
        missing_cells = [i for i, start in self.non_numeric if t - start >= MISSING_TIME or i in reported]
        new_cells = tuple([i for i in missing_cells if i not in reported])
        self.failed[CellFault.MISSING] = missing_cells
        self.excluded = self._all_failed()
        if new_cells:
            self._report(t, known_at, CellFault.MISSING, new_cells, events)

    def _swing_starts(self, t: float, phase: Phase, rate_unknown: bool) -> bool:
        """Return whether a swing starts, for a foot that turns fast or whose rate is unknown."""
        if rate_unknown:
            was_airborne, self.airborne = self.airborne, phase is Phase.SWING
            return self.airborne and not was_airborne
        if self.swing_start is not None and 0.0 <= t - self.swing_start < LEAST_SWING_INTERVAL:
            return False
        self.swing_start = t
        return True

    def _judge(
        self, t: float, known_at: float, window_start: float, layout: Layout | None, events: list[Event]
    ) -> None:
        span = self.span
        if not span.lows:
            return
        window = CellWindow.from_span(span, self.excluded)
        if not window.varies:
            self._count_constant(t, known_at, window_start, window, events)
            return
        self.constant_windows = 0
        if unloads(span, layout):
            self.loaded_windows = 0
        else:
            self._count_loaded(t, known_at, window_start, events)
        faults = window.find_faults(layout, self.lively_windows)
        for fault, cells in faults.items():
            new_cells = tuple([i for i in cells if i in self.suspected.get(fault, [])])
            if new_cells:
                self.failed[fault] = sorted([*self.failed.get(fault, []), *new_cells])
                self._report(t, known_at, fault, new_cells, events)
        self.suspected = faults
        self._update_lively(window)

    def _count_constant(
        self, t: float, known_at: float, window_start: float, window: CellWindow, events: list[Event]
    ) -> None:
        working = window.working
        if window.highest > 0.0:
            self._count_loaded(t, known_at, window_start, events)
            return
        self.constant_windows += 1
        if self.constant_windows == 2 and working:
            self.failed[CellFault.DEAD] = sorted([*self.failed.get(CellFault.DEAD, []), *working])
            self._report(t, known_at, CellFault.DEAD, tuple(working), events)
            self.excluded = self._all_failed()

    def _count_loaded(self, t: float, known_at: float, window_start: float, events: list[Event]) -> None:
        self.loaded_windows += 1
        if self.loaded_windows == 1:
            self.loaded_windows_start = window_start
        elif self.loaded_windows == 2:
            seconds = t - self.loaded_windows_start
            events.append(InsoleNeverUnloads(t=t, known_at=known_at, site=self.site, seconds=seconds))

    def _update_lively(self, window: CellWindow) -> None:
        """Count the lively windows of each cell; use failed cells again after two in a row."""
        if len(self.lively_windows) != self.count:
            self.lively_windows = [0] * self.count
        suspected_cells = {i for cells in self.suspected.values() for i in cells}
        for i, lively in enumerate(window.find_lively()):
            if i not in suspected_cells:  # a suspected cell keeps its count, because the count is why it is suspected
                self.lively_windows[i] = min(self.lively_windows[i] + 1, LIVELY_WINDOWS_ALONE) if lively else 0
        for fault, cells in self.failed.items():
            if fault is not CellFault.MISSING:
                self.failed[fault] = [i for i in cells if i in suspected_cells or self.lively_windows[i] < 2]
        self.excluded = self._all_failed()

    def _all_failed(self) -> list[int]:
        return sorted({i for cells in self.failed.values() for i in cells})

    def _report(self, t: float, known_at: float, fault: CellFault, cells: tuple[int, ...], events: list[Event]) -> None:
        events.append(CellsFailed(t=t, known_at=known_at, site=self.site, fault=fault, cells=cells))


def _is_number(value: float | None) -> bool:
    return value is not None and -ABSURD_PRESSURE < value < ABSURD_PRESSURE
