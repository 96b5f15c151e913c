"""Detection of failed pressure cells of one insole, and the values that can still be used.

Cells are judged over windows of walking with SWINGS swings of the foot; two windows in a row must agree.

- DEAD, STUCK, SATURATED: one window shows the fault (cell_window.py).
- MISSING: for PATIENCE, the cell gives no number, or samples do not have as many cells as the insole.

Without swings only MISSING is judged.

`usable` returns 0 for failed cells, so load, areas and centre of pressure work without them. A cell that loads again in
two windows is used again. This is not reported, but another failure of it is. The pressure of samples with a wrong
number of cells is not used; their inertial part is. Without a layout, another number of cells means another insole
after PATIENCE."""

from __future__ import annotations

from ...events import CellFault, CellsFailed, Event, InsoleNeverUnloads
from ...types import Layout, Phase, Site, Vec3
from ...types.attrs import define, field
from ..rejection import ABSURD_TOTAL
from .cell_window import LIVELY_WINDOWS_ALONE, CellWindow, unloads
from .cells import CellSpan

CHECK_INTERVAL = 0.0795
"""Interval at which the cells are checked, s; a load under the toes lasts about 0.15 s."""
SWING_RATE, ONE_SWING = 3.0, 0.7
"""Smallest rate of a foot that walks, rad/s, and time for which it is then in the same swing, s."""
SHORTEST, LONGEST = 3.0, 30.0
"""Shortest and longest duration of a window, s."""
SWINGS, PATIENCE = 4, 1.0
"""Number of swings that end a window, and time without a number after which a cell is missing, s."""


@define
class CellHealth:
    """The health of the cells of one insole.

    Call `update` with every sample in order of time, then use the cells that `usable` returns. A sample costs one sum,
    and 12 times a second the extremes of each cell."""

    site: Site
    count: int = field(default=0, init=False)
    """Number of cells; 0 before any."""
    span: CellSpan = field(factory=CellSpan, init=False)
    """Extremes of the cells in the current window."""
    checked_at: float | None = field(default=None, init=False)
    """Time of the last check of the cells, s."""
    window_start: float | None = field(default=None, init=False)
    """Start of the current window, s."""
    swings: int = field(default=0, init=False)
    """Number of swings in the current window."""
    swing_start: float | None = field(default=None, init=False)
    """Start of the last swing, s."""
    airborne: bool = field(default=False, init=False)
    """The foot was in the air in the last sample without a rate."""
    suspects: dict[CellFault, list[int]] = field(factory=dict, init=False)
    """Faults that the last window showed, each with its cells."""
    failed: dict[CellFault, list[int]] = field(factory=dict, init=False)
    """Faults that are reported, each with its cells."""
    excluded: list[int] = field(factory=list, init=False)
    """All failed cells."""
    lively_windows: list[int] = field(factory=list, init=False)
    """Number of windows in a row in which each cell was lively."""
    not_numbers: list[tuple[int, float]] = field(factory=list, init=False)
    """Cells that give no number now, each with the time since which, s."""
    wrong_count: int | None = field(default=None, init=False)
    """Number of cells of the current samples if it is wrong; None otherwise."""
    wrong_count_since: float = field(default=0.0, init=False)
    """Time since which the number of cells is wrong, s."""
    wrong_count_reported: bool = field(default=False, init=False)
    """The wrong number of cells was reported."""
    loaded_windows: int = field(default=0, init=False)
    """Number of windows in a row in which the insole did not unload."""
    loaded_since: float = field(default=0.0, init=False)
    """Start of the first of these windows, s."""
    constant_windows: int = field(default=0, init=False)
    """Number of windows in a row in which no cell showed any load."""

    def reset(self) -> None:
        """Discard the current window, because times restart; failed cells stay failed."""
        self.checked_at = self.window_start = self.swing_start = None
        self.span, self.swings, self.not_numbers, self.wrong_count = CellSpan(), 0, [], None

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

        `cells` is () for a sample without cells, because the inertial sensor and the cells may send separately. `phase`
        is that of the foot, `gyro` is in rad/s, and `layout` comes from the device or a calibration."""
        events: list[Event] = []
        if layout is not None and self.count != len(layout.cells):
            self._set_count(len(layout.cells))
        if len(cells) != self.count and not self._accept_count(t, known_at, len(cells), layout, events):
            return events
        self.wrong_count = None
        try:
            numbers = -ABSURD_TOTAL < sum(cells) < ABSURD_TOTAL
        except (TypeError, OverflowError):
            numbers = False
        if self.not_numbers or not numbers:
            self._watch_numbers(t, known_at, cells, events)
            cells = self.usable(cells)
            if not cells:
                return events
        if self.checked_at is None or not 0.0 <= t - self.checked_at < CHECK_INTERVAL:
            self.checked_at = t
            if self.window_start is None or not 0.0 <= t - self.window_start < LONGEST:
                self.window_start, self.swings, self.span = t, 0, CellSpan()
            self.span.add(cells, self.excluded)
        x, y, z = (SWING_RATE, SWING_RATE, SWING_RATE) if gyro is None else gyro
        if x * x + y * y + z * z >= SWING_RATE * SWING_RATE and self._swing_starts(t, phase, gyro is None):
            self.swings += 1
            if self.swings >= SWINGS and self.window_start is not None and t - self.window_start >= SHORTEST:
                self._judge(t, known_at, self.window_start, layout, events)
                self.window_start, self.swings, self.span = t, 0, CellSpan()
        return events

    def usable(self, cells: tuple[float, ...]) -> tuple[float, ...]:
        """Return the cells of the sample of the last `update`, with 0 for those that failed or are no numbers.

        Returns () when no cell can be used."""
        if len(cells) != self.count:
            return ()
        if not self.not_numbers:
            if not self.excluded:
                return cells
            left = list(cells)
        else:
            left = [value if _is_number(value) else 0.0 for value in cells]
            if len(self.not_numbers) == self.count:
                return ()
        for i in self.excluded:
            left[i] = 0.0
        return tuple(left)

    def _accept_count(self, t: float, known_at: float, count: int, layout: Layout | None, events: list[Event]) -> bool:
        """Return whether another number of cells, `count`, is valid from now on."""
        if self.count == 0:
            if count == 0:
                return False
            self._set_count(count)
            return True
        if count != self.wrong_count or t < self.wrong_count_since:
            self.wrong_count, self.wrong_count_since = count, t
            return False
        if t - self.wrong_count_since < PATIENCE:
            return False
        if not self.wrong_count_reported:
            missing = tuple(range(count, self.count)) or tuple(range(self.count, count))
            self.wrong_count_reported = True
            self._report(t, known_at, CellFault.MISSING, missing, events)
        if layout is None and count:
            self._set_count(count)
            return True
        return False

    def _set_count(self, count: int) -> None:
        """Restart for another insole of `count` cells."""
        self.count, self.wrong_count_reported = count, False
        self.failed, self.suspects, self.excluded, self.lively_windows = {}, {}, [], []
        self.reset()

    def _watch_numbers(self, t: float, known_at: float, cells: tuple[float, ...], events: list[Event]) -> None:
        since = dict(self.not_numbers)
        self.not_numbers = [(i, since.get(i, t)) for i, value in enumerate(cells) if not _is_number(value)]
        known = self.failed.get(CellFault.MISSING, [])
        missing = [i for i, start in self.not_numbers if t - start >= PATIENCE or i in known]
        new = tuple([i for i in missing if i not in known])
        self.failed[CellFault.MISSING] = missing
        self.excluded = self._all_failed()
        if new:
            self._report(t, known_at, CellFault.MISSING, new, events)

    def _swing_starts(self, t: float, phase: Phase, unseen: bool) -> bool:
        """Return whether a swing starts: the foot turns fast, or is in the air if its rate is `unseen`."""
        if unseen:
            before, self.airborne = self.airborne, phase is Phase.SWING
            return self.airborne and not before
        if self.swing_start is not None and 0.0 <= t - self.swing_start < ONE_SWING:
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
        if not window.moves:
            self._count_constant(t, known_at, window_start, window, events)
            return
        self.constant_windows = 0
        if unloads(span, layout):
            self.loaded_windows = 0
        else:
            self._count_loaded(t, known_at, window_start, events)
        faults = window.faults(layout, self.lively_windows)
        for fault, cells in faults.items():
            new = tuple([i for i in cells if i in self.suspects.get(fault, [])])
            if new:
                self.failed[fault] = sorted([*self.failed.get(fault, []), *new])
                self._report(t, known_at, fault, new, events)
        self.suspects = faults
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
            self.loaded_since = window_start
        elif self.loaded_windows == 2:
            seconds = t - self.loaded_since
            events.append(InsoleNeverUnloads(t=t, known_at=known_at, site=self.site, seconds=seconds))

    def _update_lively(self, window: CellWindow) -> None:
        """Count the lively windows of each cell; use failed cells again after two in a row."""
        if len(self.lively_windows) != self.count:
            self.lively_windows = [0] * self.count
        suspected = {i for cells in self.suspects.values() for i in cells}
        for i, lively in enumerate(window.lively()):
            if i not in suspected:  # a suspected cell keeps its count, because the count is why it is suspected
                self.lively_windows[i] = min(self.lively_windows[i] + 1, LIVELY_WINDOWS_ALONE) if lively else 0
        for fault, cells in self.failed.items():
            if fault is not CellFault.MISSING:
                self.failed[fault] = [i for i in cells if i in suspected or self.lively_windows[i] < 2]
        self.excluded = self._all_failed()

    def _all_failed(self) -> list[int]:
        return sorted({i for cells in self.failed.values() for i in cells})

    def _report(self, t: float, known_at: float, fault: CellFault, cells: tuple[int, ...], events: list[Event]) -> None:
        events.append(CellsFailed(t=t, known_at=known_at, site=self.site, fault=fault, cells=cells))


def _is_number(value: float | None) -> bool:
    return value is not None and -ABSURD_TOTAL < value < ABSURD_TOTAL
