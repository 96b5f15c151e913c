"""Whether the pressure cells of one insole work, and what to use of them when some do not.

Cells are judged over windows of walking, SWINGS swings of the foot each; two windows in a row must say the same.

- DEAD, STUCK, SATURATED: what it shows in a window says so (cell_window.py).
- MISSING: no number comes from it, or samples do not have as many cells as the insole, for PATIENCE.

Without swings nothing is judged but MISSING.

Failed cells read 0 from then on (`usable`), so that load, areas and centre of pressure go on without them. A cell that
loads again for two windows is used again; that is not said, but if it fails once more that is. Samples with the wrong
number of cells have no pressure that anyone could use; their inertial part is used. Without a layout another number of
cells is taken for another insole after PATIENCE.
"""

from __future__ import annotations

from ...events import CellFault, CellsFailed, Event, InsoleNeverUnloads
from ...types import Layout, Phase, Site, Vec3
from ...types.attrs import define, field
from ..rejection import ABSURD_TOTAL
from .cell_window import LIVELY_WINDOWS_ALONE, CellWindow, unloads
from .cells import CellSpan

CHECK_INTERVAL = 0.0795
"""Cells are looked at this often, s: a load under the toes lasts about 0.15 s."""
SWING_RATE, ONE_SWING = 3.0, 0.7
"""A foot that turns faster than this, rad/s, walks, and for so long, s, it is in the same swing."""
SHORTEST, LONGEST = 3.0, 30.0
"""A window lasts this long, s."""
SWINGS, PATIENCE = 4, 1.0
"""So many swings end a window. A cell that shows no number for so long, s, is missing."""


@define
class CellHealth:
    """The cells of one insole. `update` with every sample, in the order of their time, and take what `usable` leaves of
    it. Costs a sum a sample, and 12 times a second the lowest and highest of each cell."""

    site: Site
    count: int = field(default=0, init=False)
    """How many cells there are; 0 before any."""
    span: CellSpan = field(factory=CellSpan, init=False)
    checked_at: float | None = field(default=None, init=False)
    """When the cells were last looked at, s."""
    window_start: float | None = field(default=None, init=False)
    """When this window did, s."""
    swings: int = field(default=0, init=False)
    """Swings in it."""
    swing_start: float | None = field(default=None, init=False)
    """When the last one began, s."""
    airborne: bool = field(default=False, init=False)
    suspects: dict[CellFault, list[int]] = field(factory=dict, init=False)
    """What the last window said."""
    failed: dict[CellFault, list[int]] = field(factory=dict, init=False)
    excluded: list[int] = field(factory=list, init=False)
    """All failed cells."""
    lively_windows: list[int] = field(factory=list, init=False)
    """In how many windows in a row each cell was."""
    not_numbers: list[tuple[int, float]] = field(factory=list, init=False)
    """Cells without a number now, and since when, s."""
    wrong_count: int | None = field(default=None, init=False)
    """The wrong number of cells that samples have now."""
    wrong_count_since: float = field(default=0.0, init=False)
    wrong_count_reported: bool = field(default=False, init=False)
    loaded_windows: int = field(default=0, init=False)
    """Windows in a row in which the insole did not unload."""
    loaded_since: float = field(default=0.0, init=False)
    constant_windows: int = field(default=0, init=False)
    """The same in which no cell showed anything."""

    def reset(self) -> None:
        """Times begin anew: windows do too. What has failed stays failed."""
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
        """The cells of a sample taken at `t` s, not seen to in any way, () where it has none (inertial sensor and cells
        may come apart); `phase` of the foot, `gyro` in rad/s; `layout` that the device or a calibration told."""
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
        """The cells of the sample just fed with 0 for those that failed or are no numbers; () when there is nothing in
        it that could be used."""
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
        """Samples have another number of cells; True when that is right from now on."""
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
        """Another insole."""
        self.count, self.wrong_count_reported = count, False
        self.failed, self.suspects, self.excluded, self.lively_windows = {}, {}, [], []
        self.reset()

    def _watch_numbers(self, t: float, known_at: float, cells: tuple[float, ...], events: list[Event]) -> None:
        since = dict(self.not_numbers)
        self.not_numbers = [(i, since.get(i, t)) for i, value in enumerate(cells) if not _is_number(value)]
        known = self.failed.get(CellFault.MISSING, [])
        gone = [i for i, window_start in self.not_numbers if t - window_start >= PATIENCE or i in known]
        new = tuple([i for i in gone if i not in known])
        self.failed[CellFault.MISSING] = gone
        self.excluded = self._all_failed()
        if new:
            self._report(t, known_at, CellFault.MISSING, new, events)

    def _swing_starts(self, t: float, phase: Phase, unseen: bool) -> bool:
        """A swing has begun: the foot turns fast, or, where that is `unseen`, is in the air."""
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
        """Which cells were lively; those that had failed and are, twice in a row, are used again."""
        if len(self.lively_windows) != self.count:
            self.lively_windows = [0] * self.count
        suspected = {i for cells in self.suspects.values() for i in cells}
        for i, lively in enumerate(window.lively()):
            if i not in suspected:  # of those, what they used to do is why they are suspected
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
