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
from .cell_window import USED_TO_ALONE, CellWindow, unloads
from .cells import CellSpan

RARELY = 0.0795
"""Cells are looked at this often, s: a load under the toes lasts about 0.15 s."""
FAST, ONE_SWING = 3.0, 0.7
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
    looked: float | None = field(default=None, init=False)
    """When the cells were last looked at, s."""
    began: float | None = field(default=None, init=False)
    """When this window did, s."""
    swung: int = field(default=0, init=False)
    """Swings in it."""
    swing: float | None = field(default=None, init=False)
    """When the last one began, s."""
    airborne: bool = field(default=False, init=False)
    suspects: dict[CellFault, list[int]] = field(factory=dict, init=False)
    """What the last window said."""
    failed: dict[CellFault, list[int]] = field(factory=dict, init=False)
    out: list[int] = field(factory=list, init=False)
    """All failed cells."""
    lively: list[int] = field(factory=list, init=False)
    """In how many windows in a row each cell was."""
    numberless: list[tuple[int, float]] = field(factory=list, init=False)
    """Cells without a number now, and since when, s."""
    odd: int | None = field(default=None, init=False)
    """The wrong number of cells that samples have now."""
    odd_since: float = field(default=0.0, init=False)
    odd_said: bool = field(default=False, init=False)
    held: int = field(default=0, init=False)
    """Windows in a row in which the insole did not unload."""
    held_since: float = field(default=0.0, init=False)
    unmoved: int = field(default=0, init=False)
    """The same in which no cell showed anything."""

    def reset(self) -> None:
        """Times begin anew: windows do too. What has failed stays failed."""
        self.looked = self.began = self.swing = None
        self.span, self.swung, self.numberless, self.odd = CellSpan(), 0, [], None

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
            self._anew(len(layout.cells))
        if len(cells) != self.count and not self._counted(t, known_at, len(cells), layout, events):
            return events
        self.odd = None
        try:
            numbers = -ABSURD_TOTAL < sum(cells) < ABSURD_TOTAL
        except (TypeError, OverflowError):
            numbers = False
        if self.numberless or not numbers:
            self._watch_numbers(t, known_at, cells, events)
            cells = self.usable(cells)
            if not cells:
                return events
        if self.looked is None or not 0.0 <= t - self.looked < RARELY:
            self.looked = t
            if self.began is None or not 0.0 <= t - self.began < LONGEST:
                self.began, self.swung, self.span = t, 0, CellSpan()
            self.span.add(cells, self.out)
        x, y, z = (FAST, FAST, FAST) if gyro is None else gyro
        if x * x + y * y + z * z >= FAST * FAST and self._swings(t, phase, gyro is None):
            self.swung += 1
            if self.swung >= SWINGS and self.began is not None and t - self.began >= SHORTEST:
                self._judge(t, known_at, self.began, layout, events)
                self.began, self.swung, self.span = t, 0, CellSpan()
        return events

    def usable(self, cells: tuple[float, ...]) -> tuple[float, ...]:
        """The cells of the sample just fed with 0 for those that failed or are no numbers; () when there is nothing in
        it that could be used."""
        if len(cells) != self.count:
            return ()
        if not self.numberless:
            if not self.out:
                return cells
            left = list(cells)
        else:
            left = [value if _number(value) else 0.0 for value in cells]
            if len(self.numberless) == self.count:
                return ()
        for i in self.out:
            left[i] = 0.0
        return tuple(left)

    def _counted(self, t: float, known_at: float, count: int, layout: Layout | None, events: list[Event]) -> bool:
        """Samples have another number of cells; True when that is right from now on."""
        if self.count == 0:
            if count == 0:
                return False
            self._anew(count)
            return True
        if count != self.odd or t < self.odd_since:
            self.odd, self.odd_since = count, t
            return False
        if t - self.odd_since < PATIENCE:
            return False
        if not self.odd_said:
            missing = tuple(range(count, self.count)) or tuple(range(self.count, count))
            self.odd_said = True
            self._say(t, known_at, CellFault.MISSING, missing, events)
        if layout is None and count:
            self._anew(count)
            return True
        return False

    def _anew(self, count: int) -> None:
        """Another insole."""
        self.count, self.odd_said = count, False
        self.failed, self.suspects, self.out, self.lively = {}, {}, [], []
        self.reset()

    def _watch_numbers(self, t: float, known_at: float, cells: tuple[float, ...], events: list[Event]) -> None:
        since = dict(self.numberless)
        self.numberless = [(i, since.get(i, t)) for i, value in enumerate(cells) if not _number(value)]
        known = self.failed.get(CellFault.MISSING, [])
        gone = [i for i, began in self.numberless if t - began >= PATIENCE or i in known]
        new = tuple([i for i in gone if i not in known])
        self.failed[CellFault.MISSING] = gone
        self.out = self._all_failed()
        if new:
            self._say(t, known_at, CellFault.MISSING, new, events)

    def _swings(self, t: float, phase: Phase, unseen: bool) -> bool:
        """A swing has begun: the foot turns fast, or, where that is `unseen`, is in the air."""
        if unseen:
            before, self.airborne = self.airborne, phase is Phase.SWING
            return self.airborne and not before
        if self.swing is not None and 0.0 <= t - self.swing < ONE_SWING:
            return False
        self.swing = t
        return True

    def _judge(self, t: float, known_at: float, began: float, layout: Layout | None, events: list[Event]) -> None:
        span = self.span
        if not span.lows:
            return
        window = CellWindow.of(span, self.out)
        if not window.moves:
            self._nothing_moves(t, known_at, began, window, events)
            return
        self.unmoved = 0
        if unloads(span, layout):
            self.held = 0
        else:
            self._hold(t, known_at, began, events)
        faults = window.faults(layout, self.lively)
        for fault, cells in faults.items():
            new = tuple([i for i in cells if i in self.suspects.get(fault, [])])
            if new:
                self.failed[fault] = sorted([*self.failed.get(fault, []), *new])
                self._say(t, known_at, fault, new, events)
        self.suspects = faults
        self._follow(window)

    def _nothing_moves(self, t: float, known_at: float, began: float, window: CellWindow, events: list[Event]) -> None:
        working = window.working
        if window.highest > 0.0:
            self._hold(t, known_at, began, events)
            return
        self.unmoved += 1
        if self.unmoved == 2 and working:
            self.failed[CellFault.DEAD] = sorted([*self.failed.get(CellFault.DEAD, []), *working])
            self._say(t, known_at, CellFault.DEAD, tuple(working), events)
            self.out = self._all_failed()

    def _hold(self, t: float, known_at: float, began: float, events: list[Event]) -> None:
        self.held += 1
        if self.held == 1:
            self.held_since = began
        elif self.held == 2:
            seconds = t - self.held_since
            events.append(InsoleNeverUnloads(t=t, known_at=known_at, site=self.site, seconds=seconds))

    def _follow(self, window: CellWindow) -> None:
        """Which cells were lively; those that had failed and are, twice in a row, are used again."""
        if len(self.lively) != self.count:
            self.lively = [0] * self.count
        suspected = {i for cells in self.suspects.values() for i in cells}
        for i, lively in enumerate(window.lively()):
            if i not in suspected:  # of those, what they used to do is why they are suspected
                self.lively[i] = min(self.lively[i] + 1, USED_TO_ALONE) if lively else 0
        for fault, cells in self.failed.items():
            if fault is not CellFault.MISSING:
                self.failed[fault] = [i for i in cells if i in suspected or self.lively[i] < 2]
        self.out = self._all_failed()

    def _all_failed(self) -> list[int]:
        return sorted({i for cells in self.failed.values() for i in cells})

    def _say(self, t: float, known_at: float, fault: CellFault, cells: tuple[int, ...], events: list[Event]) -> None:
        events.append(CellsFailed(t=t, known_at=known_at, site=self.site, fault=fault, cells=cells))


def _number(value: float | None) -> bool:
    return value is not None and -ABSURD_TOTAL < value < ABSURD_TOTAL
