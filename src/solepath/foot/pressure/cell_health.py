"""Detection of failed pressure cells of one insole, and the values that can still be used.

Cells are judged over windows of walking, each of which contains SWINGS_OF_WINDOW swings of the foot.

- DEAD, STUCK, SATURATED, INVERTED and NOISY are reported when two windows in a row show the fault (`CellWindow`).
- STUCK is reported of all cells when two swings in a row, which the gyroscope shows, neither unload nor load them, and
  no missing samples hide that they do. From the first of the two on there is no load, so that the inertial sensor alone
  finds the strides. Cells that are calibrated in newtons are not watched for it.
- MISSING is reported when for MISSING_TIME the cell gives no number, or one that cannot be. This needs no swings.

`usable` returns 0 for failed cells, so load, areas and centre of pressure work without them. A cell that loads again in
two windows in a row is used again. This is not reported, but another failure of the same cell is. If a sample has a
wrong number of cells, its pressure is not used, but its inertial part is; if that lasts for MISSING_TIME, it is a
Limitation. Without a layout it then means another insole.

A cell is "lively" in a window in which it both loads and unloads. The numbers were chosen by hand and not swept."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from math import hypot, pi
from typing import Any

from ...events import CellFault, CellsFailed, Event, InsoleNeverUnloads, Limitation
from ...types import Floats, Layout, Phase, Site, Vec3
from ...types.attrs import define, field, frozen
from ...types.doubles import Doubles, doubles
from ...types.layout import MAX_FULL_SCALE

ABSURD_PRESSURE = 10.0 * MAX_FULL_SCALE
"""Magnitude from which on the value of a cell is none, N or counts: ten times the largest full scale of a layout.

The root of the sum of squares over all cells, which bounds each of them, is compared with it first."""
CHECK_INTERVAL = 0.0795
"""Interval at which the cells are checked, s; a load under the toes lasts about 0.15 s."""
LONGEST_CHANGE = 0.045
"""Longest time between a check and the next sample over which a cell is seen to change, s: 25 samples a second."""
LEAST_SWING_RATE, LEAST_SWING_INTERVAL = 3.0, 0.7
"""Angular rate of a foot in swing, rad/s, and the time for which higher rates then belong to the same swing, s."""
SHORTEST_WINDOW, LONGEST_WINDOW = 3.0, 30.0
"""Shortest and longest duration of a window, s."""
SWINGS_OF_WINDOW, MISSING_TIME = 4, 1.0
"""Number of swings in a window, and time without a number after which a cell is missing, s."""


LIVELY_RANGE = 0.15
"""Range above which a cell is lively, as a share of the largest range."""
SILENT_RANGE = 0.01
"""Largest range of a cell that bears no load, as a share of the largest range."""
CONSTANT_RANGE = 0.0025
"""Largest range of a cell that shows one value or two neighbouring counts, as a share of the largest range."""
RAISED_VALUE = 0.1
"""Excess over the median cell in the air above which a value is not that of an unloaded cell.

It is a share of the largest range."""
NOISY_RATIO = 0.4
"""Square of the mean change of a cell from one sample to the next, over its variance, above which it shows no load.

White noise has 1.3, an input that is at either end of its range 1, and hum of the mains 1 to 3, unless its period is
that of the samples. A load changes a cell only a few times a stride: at 25 Hz a cell that one sample in 27 loads has
0.15 and any other less, at 100 Hz all have less than 0.05."""
LEAST_NOISE = 0.01
"""Smallest mean change that is reported, as a share of the largest range of a cell that is not noisy."""
LIVELY_WINDOWS = 3
"""Number of lively windows in a row after which a cell should load."""
LIVELY_WINDOWS_ALONE = 8
"""Number of lively windows in a row after which a cell should load if its neighbours are unknown."""
INVERTED_POSITION = 0.7
"""Position of the value of a cell in swing within its range above which the cell falls under load, 0 to 1."""
MOST_PRESSED_CELLS = 8
"""Largest number of cells of an insole that has all its cells where the foot presses."""
FULL_SCALE_SHARE = 0.99
"""Share of the full scale from which on a cell is saturated."""
LOADED_SHARE = 0.3
"""Lowest load in N above which an insole does not unload, as a share of its highest load."""
LOADED_SHARE_IN_COUNTS = 0.9
"""Value of LOADED_SHARE for loads in counts, whose zero is unknown."""
UNCHANGED_SHARE = 0.05
"""Largest range of the sum of the cells in a swing that they do not show.

It is a share of the range of the last 8 to 10 s. A contact is seen at 5 % of the load."""
UNCHANGED_SWINGS = 2
"""Number of swings in a row that the cells do not show after which all have failed; in one, the foot may hang."""
HIDDEN_TIME = 0.25
"""Time without samples that may hide what a swing changes, s: a landing and the toe-off before it last as long."""
LEAST_VARIATION = 0.01
"""Largest range of cells that show no load at all, as a share of the highest value."""


WIDEST_NEIGHBOUR_ANGLE = 2.6
"""Widest angle at a cell between two neighbours next to each other if it lies among them, rad; chosen by hand.

A cell with a wider angle lies at the rim of its neighbours."""


def add_up(values: Iterable[float]) -> float:
    """Return the sum, in order; `fsum` takes twice the time, and `sum` rounds as its Python does."""
    total = 0.0
    for value in values:
        total += value
    return total


@define
class CellSpan:
    """The lowest and highest value of each cell, and of their sum, over a span of time."""

    lows: list[float] = field(factory=list)
    """Lowest value of each cell."""
    highs: list[float] = field(factory=list)
    """Highest value of each cell."""
    low: float = 0.0
    """Lowest sum of the cells."""
    high: float = 0.0
    """Highest sum of the cells."""
    last: Floats = ()
    """Sample that was added last, until the next one is compared with it."""
    pairs: int = 0
    """Number of samples that were compared with the next one."""
    sums: Doubles = field(factory=doubles)
    """For each cell, sum of the values of those samples."""
    squares: Doubles = field(factory=doubles)
    """For each cell, sum of their squares."""
    changes: Doubles = field(factory=doubles)
    """For each cell, sum of the magnitudes of their changes to the next sample."""

    def add(self, cells: Floats, excluded: list[int]) -> None:
        """Add one sample; cells with an index in `excluded` do not count in the sum."""
        total = add_up([v for i, v in enumerate(cells) if i not in excluded] if excluded else cells)
        self.last = cells
        if not self.lows:
            self.lows, self.highs = list(cells), list(cells)
            self.low = self.high = total
            self.sums, self.squares, self.changes = [doubles([0.0] * len(cells)) for _ in range(3)]
            return
        # takes half the time of map(min, ...), which calls a function for every cell
        self.lows = [low if low < value else value for low, value in zip(self.lows, cells, strict=True)]
        self.highs = [high if high > value else value for high, value in zip(self.highs, cells, strict=True)]
        self.low, self.high = min(self.low, total), max(self.high, total)

    def compare(self, cells: Floats) -> None:
        """Compare the sample after that of `add` with it."""
        last, self.last, self.pairs = self.last, (), self.pairs + 1
        self.sums = doubles([total + v for total, v in zip(self.sums, last, strict=True)])
        self.squares = doubles([total + v * v for total, v in zip(self.squares, last, strict=True)])
        self.changes = doubles([total + abs(b - a) for total, a, b in zip(self.changes, last, cells, strict=True)])

    def find_noisy(self) -> list[bool]:
        """Return for each cell whether it changes as much from one sample to the next as in the whole span."""
        pairs, largest, shares = self.pairs, 0.0, list[float]()
        for change, square, total, low, high in zip(
            self.changes, self.squares, self.sums, self.lows, self.highs, strict=True
        ):
            is_noise = change * change > NOISY_RATIO * (pairs * square - total * total)
            shares.append(change if is_noise else 0.0)
            largest = largest if is_noise else max(largest, high - low)
        return [0.0 < LEAST_NOISE * largest * pairs < change for change in shares]


def enclosed(layout: Layout, i: int, loading: list[bool]) -> tuple[bool, bool]:
    """Return whether loading neighbours lie on all sides of cell `i`, and whether at least two neighbours load.

    `loading` is True for each cell that loads."""
    neighbours = layout.neighbours[i]
    around = [j for j in neighbours if loading[j]]
    if len(around) < 4 or len(neighbours) - len(around) > 1:
        return False, len(around) >= 2
    angles = [layout.direction(i, j) for j in around]
    angles_between = [b - a for a, b in zip(angles, angles[1:], strict=False)]
    widest_angle = max([*angles_between, angles[0] + 2.0 * pi - angles[-1]])
    return widest_angle < WIDEST_NEIGHBOUR_ANGLE, True


@frozen
class CellWindow:
    """The extremes of the cells in one window of walking, of which those that have not failed are judged.

    The range of a cell is its highest minus its lowest value in the window. Of earlier windows only the number of
    windows in a row in which each cell was lively is used.

    - DEAD: the range of the cell is below 1 % of the largest range, although the cell should load. It should load if
      cells on all its sides load (this needs a layout), if it was lively in several windows in a row, or if the insole
      has at most eight cells, because these are put where the foot presses.
    - STUCK: the cell shows one value, well above that of the other cells in the air.
    - INVERTED: the cell shows its highest values in swing.
    - NOISY: the cell changes as much from one sample to the next as in the whole window, as an open input does.
    - SATURATED: the cell is at the end of its measuring range, even while the foot is in the air (this needs a layout).

    A cell at the rim of the sole or under a high arch may never bear load. A cell there that was dead from the start
    looks the same: it is not reported, and does no harm."""

    lows: list[float]
    """Lowest value of each cell, unit of the samples."""
    ranges: list[float]
    """Range of each cell: highest minus lowest value, unit of the samples."""
    working: list[int]
    """Indices of the cells that have not failed, or of all cells if all have failed: they may load again."""
    largest_range: float
    """Largest range of any working cell, unit of the samples."""
    highest: float
    """Highest value of any working cell, unit of the samples."""
    noisy: list[bool]
    """For each cell, whether it is noisy."""

    @classmethod
    def from_span(cls, span: CellSpan, excluded: list[int]) -> CellWindow:
        """Return the window of a span; `excluded` holds the indices of the failed cells."""
        ranges = [high - low for low, high in zip(span.lows, span.highs, strict=True)]
        working = [i for i in range(len(ranges)) if i not in excluded] or list(range(len(ranges)))
        largest_range = max([ranges[i] for i in working], default=0.0)
        highest = max([span.highs[i] for i in working], default=0.0)
        return cls(span.lows, ranges, working, largest_range, highest, span.find_noisy())

    @property
    def varies(self) -> bool:
        """Flag: at least one cell varies enough to show a load."""
        return self.largest_range > LEAST_VARIATION * self.highest and self.largest_range > 0.0

    @property
    def has_noise(self) -> bool:
        """Flag: a cell without load does not show one value only."""
        return any([0.0 < self.ranges[i] <= SILENT_RANGE * self.largest_range for i in self.working])

    def find_lively(self) -> list[bool]:
        """Return for each cell whether it is lively, and not by noise."""
        least = LIVELY_RANGE * self.largest_range
        return [r > least and not is_noisy for r, is_noisy in zip(self.ranges, self.noisy, strict=True)]

    def find_faults(
        self, layout: Layout | None, lively_windows: list[int], in_air: Floats
    ) -> dict[CellFault, list[int]]:
        """Return the faults of the working cells, each with the indices of its cells.

        `in_air` is the value of each cell in swing, or empty while it is unknown.
        `lively_windows` is, for each cell, the number of earlier windows in a row in which it was lively."""
        lows, ranges, largest_range, lively = self.lows, self.ranges, self.largest_range, self.find_lively()
        air_value = sorted([lows[i] for i in self.working])[len(self.working) // 2]
        full_scale_value = None if layout is None else layout.full_scale
        faults: dict[CellFault, list[int]] = {}
        for i in self.working:
            if full_scale_value is not None and 0.0 < FULL_SCALE_SHARE * full_scale_value <= lows[i]:
                fault = CellFault.SATURATED
            elif self.noisy[i]:
                fault = CellFault.NOISY
            elif i < len(in_air) and self._is_inverted(i, in_air[i]):
                fault = CellFault.INVERTED
            elif ranges[i] > SILENT_RANGE * largest_range:
                continue
            elif lows[i] - air_value > RAISED_VALUE * largest_range:
                if ranges[i] > CONSTANT_RANGE * largest_range:
                    continue
                fault = CellFault.STUCK
            elif self._should_load(i, layout, lively, lively_windows[i]):
                fault = CellFault.DEAD
            else:
                continue
            faults.setdefault(fault, []).append(i)
        return faults

    def _is_inverted(self, i: int, in_air: float) -> bool:
        """Return whether cell `i` is near the upper end of its range in the air, and lively."""
        return (
            self.ranges[i] > LIVELY_RANGE * self.largest_range
            and in_air > self.lows[i] + INVERTED_POSITION * self.ranges[i]
        )

    def _should_load(self, i: int, layout: Layout | None, lively: list[bool], lively_windows: int) -> bool:
        if len(self.ranges) <= MOST_PRESSED_CELLS:
            return True
        if layout is None:
            return (self.ranges[i] == 0.0 and self.has_noise) or lively_windows >= LIVELY_WINDOWS_ALONE
        is_enclosed, any_neighbours = enclosed(layout, i, lively)
        return is_enclosed or (lively_windows >= LIVELY_WINDOWS and any_neighbours)


@define
class CellHealth:
    """The health of the cells of one insole.

    Call `update` with every sample in order of time, then use the cells that `usable` returns. A sample costs one sum;
    12 times a second a sample also updates the extremes of each cell."""

    site: Site
    count: int = 0
    """Number of cells; 0 before any."""
    span: CellSpan = field(factory=CellSpan)
    """Extremes of the cells in the current window."""
    checked_at: float | None = None
    """Time of the last check of the cells, s; None before any."""
    window_start: float | None = None
    """Start of the current window, s; None before any."""
    swings: int = 0
    """Number of swings in the current window."""
    swing_start: float | None = None
    """Start of the last swing, s; None before any."""
    swing: tuple[float, float] | None = None
    """Lowest and highest sum of the cells since `swing_start`; None before any, and once they have changed with it."""
    unchanged_swings: int = 0
    """Number of swings in a row that the cells do not show."""
    airborne: bool = False
    """The foot was in the air in the last sample without an angular rate."""
    suspected: dict[CellFault, list[int]] = field(factory=dict)
    """Faults that the last window showed, each with the indices of its cells."""
    failed: dict[CellFault, list[int]] = field(factory=dict)
    """Faults that were reported and last, each with the indices of its cells."""
    excluded: list[int] = field(factory=list)
    """Indices of all failed cells."""
    lively_windows: list[int] = field(factory=list)
    """For each cell, number of windows in a row in which it was lively."""
    non_numeric: list[tuple[int, float]] = field(factory=list)
    """Index of each cell that gives no number now, and the time since which it gives none, s."""
    wrong_count: int | None = None
    """Number of cells of the current samples if it is wrong; None otherwise."""
    wrong_count_since: float = 0.0
    """Time since which the number of cells is wrong, s."""
    wrong_count_reported: bool = False
    """The wrong number of cells was reported."""
    loaded_windows: int = 0
    """Number of windows in a row in which the insole did not unload."""
    loaded_windows_start: float = 0.0
    """Start of the first window in which the insole did not unload, s."""
    constant_windows: int = 0
    """Number of windows in a row in which no cell showed any load."""

    def reset(self) -> None:
        """Discard the current window, because times restart; failed cells stay failed."""
        self.checked_at = self.window_start = self.swing_start = self.swing = None
        self.span, self.swings, self.non_numeric, self.wrong_count = CellSpan(), 0, [], None

    def update(
        self,
        t: float,
        known_at: float,
        cells: Floats,
        phase: Phase,
        gyro: Vec3 | None = None,
        layout: Layout | None = None,
        in_air: Floats = (),
        load_range: float = 0.0,
    ) -> list[Event]:
        """Return the events of one sample at `t`, s, with raw `cells`.

        `cells` is () for a sample of an inertial sensor that sends separately from the cells. `phase` is that of the
        foot, `gyro` is in rad/s, `layout` comes from the device or a calibration,
        `in_air` is the value of each cell in swing, as far as it is known, and `load_range` is the range of the sum of
        the cells in the last 8 to 10 s, 0 while the load is unknown."""
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
        if self.checked_at is not None and not 0.0 <= t - self.checked_at < HIDDEN_TIME:
            self.swing, self.unchanged_swings = None, 0
        if self.checked_at is None or not 0.0 <= t - self.checked_at < CHECK_INTERVAL:
            self.checked_at = t
            if self.window_start is None or not 0.0 <= t - self.window_start < LONGEST_WINDOW:
                self.window_start, self.swings, self.span = t, 0, CellSpan()
            self.span.add(cells, self.excluded)
        elif self.span.last and t - self.checked_at < LONGEST_CHANGE:
            self.span.compare(cells)
        if gyro is None:
            was_airborne, self.airborne = self.airborne, phase is Phase.SWING
            swing_starts = self.airborne and not was_airborne
        else:
            x, y, z = gyro
            swing_starts = x * x + y * y + z * z >= LEAST_SWING_RATE * LEAST_SWING_RATE and not (
                self.swing_start is not None and 0.0 <= t - self.swing_start < LEAST_SWING_INTERVAL
            )
            if self.swing is not None or swing_starts:
                self._watch_swing(t, known_at, add_up(cells), UNCHANGED_SHARE * load_range, swing_starts, events)
            if swing_starts:
                self.swing_start = t
        if swing_starts:
            self.swings += 1
            if (
                self.swings >= SWINGS_OF_WINDOW
                and self.window_start is not None
                and t - self.window_start >= SHORTEST_WINDOW
            ):
                self._judge(t, known_at, self.window_start, layout, in_air, events)
                self.window_start, self.swings, self.span = t, 0, CellSpan()
        return events

    def usable(self, cells: Floats, unloaded: Floats = ()) -> Floats:
        """Return `cells`, those of the last `update`, with the values without load for what is failed or no number.

        `unloaded` holds the value of each cell without load, or nothing while it is unknown, which is then 0. The
        result is () when no cell can be used."""
        if len(cells) != self.count:
            return ()
        if len({*self.excluded, *[i for i, _ in self.non_numeric]}) == self.count:
            return ()
        usable_cells = list(cells)
        for i in [*self.excluded, *[i for i, _ in self.non_numeric]]:
            usable_cells[i] = unloaded[i] if i < len(unloaded) else 0.0
        return tuple(usable_cells)

    def _watch_swing(
        self, t: float, known_at: float, total: float, least: float, swing_starts: bool, events: list[Event]
    ) -> None:
        """Look whether the `total` of the cells changes by `least` between the push-off of a swing and its landing."""
        if swing_starts:
            if self.swing is not None and least > 0.0:
                self.unchanged_swings += 1
                if self.unchanged_swings == UNCHANGED_SWINGS:
                    working = tuple([i for i in range(self.count) if i not in self.excluded])
                    if working:
                        self._fail(t, known_at, CellFault.STUCK, working, events)
                    self.window_start, self.lively_windows = None, [0] * self.count  # what was before shows no recovery
            self.swing = total, total
        elif self.swing is not None:
            low, high = self.swing
            self.swing = min(low, total), max(high, total)
            if self.swing[1] - self.swing[0] > least:
                self.swing, self.unchanged_swings = None, 0

    def _accept_count(self, t: float, known_at: float, count: int, layout: Layout | None, events: list[Event]) -> bool:
        """Return whether samples with `count` cells, a new number, are used from now on."""
        if self.count == 0:
            self._set_count(count)
            return True
        if count != self.wrong_count or t < self.wrong_count_since:
            self.wrong_count, self.wrong_count_since = count, t
            return False
        if t - self.wrong_count_since < MISSING_TIME:
            return False
        if not self.wrong_count_reported:
            self.wrong_count_reported = True
            known = "samples before had" if layout is None else "the layout of the insole has"
            use = "no pressure is used" if layout is not None or not count else "it is taken for another insole"
            what = f"samples have {count} values of pressure cells, but {known} {self.count}: {use}"
            events.append(Limitation(t=t, known_at=known_at, site=self.site, what=what))
        if layout is None and count:
            self._set_count(count)
            return True
        return False

    def _set_count(self, count: int) -> None:
        """Restart for another insole of `count` cells."""
        self.count, self.wrong_count_reported = count, False
        self.failed, self.suspected, self.excluded, self.lively_windows = {}, {}, [], [0] * count
        self.reset()

    def _watch_numbers(self, t: float, known_at: float, cells: Sequence[Any], events: list[Event]) -> None:
        since = dict(self.non_numeric)
        self.non_numeric = [(i, since.get(i, t)) for i, value in enumerate(cells) if not _is_number(value)]
        reported = self.failed.get(CellFault.MISSING, [])
        missing_cells = [i for i, start in self.non_numeric if t - start >= MISSING_TIME or i in reported]
        new_cells = tuple([i for i in missing_cells if i not in reported])
        self.failed[CellFault.MISSING] = missing_cells
        self.excluded = self._all_failed()
        if new_cells:
            self._report(t, known_at, CellFault.MISSING, new_cells, events)

    def _judge(
        self, t: float, known_at: float, window_start: float, layout: Layout | None, in_air: Floats, events: list[Event]
    ) -> None:
        span = self.span
        if not span.lows:
            return
        window = CellWindow.from_span(span, self.excluded)
        if not window.varies:
            self._count_constant(t, known_at, window_start, window, events)
            return
        self.constant_windows = 0
        in_newtons = layout is not None and layout.scale is not None
        share = LOADED_SHARE if in_newtons else LOADED_SHARE_IN_COUNTS
        zero = 0.0 if in_newtons else add_up([value for i, value in enumerate(in_air) if i not in self.excluded])
        if span.high > 0.0 and span.low - zero > share * (span.high - zero):
            self._count_loaded(t, known_at, window_start, events)
        else:
            self.loaded_windows = 0
        faults = window.find_faults(layout, self.lively_windows, in_air)
        for fault, cells in faults.items():
            new_cells = tuple([i for i in cells if i in self.suspected.get(fault, []) and i not in self.excluded])
            if new_cells:
                self._fail(t, known_at, fault, new_cells, events)
        self.suspected = faults
        self._update_lively(window)

    def _count_constant(
        self, t: float, known_at: float, window_start: float, window: CellWindow, events: list[Event]
    ) -> None:
        if len(self.excluded) == self.count:
            return
        if window.highest > 0.0:
            self._count_loaded(t, known_at, window_start, events)
            return
        self.constant_windows += 1
        if self.constant_windows == 2:
            self._fail(t, known_at, CellFault.DEAD, tuple(window.working), events)

    def _fail(self, t: float, known_at: float, fault: CellFault, cells: tuple[int, ...], events: list[Event]) -> None:
        """Report a fault of cells that worked, and use them no more."""
        self.failed[fault] = sorted([*self.failed.get(fault, []), *cells])
        self.excluded = self._all_failed()
        self._report(t, known_at, fault, cells, events)

    def _count_loaded(self, t: float, known_at: float, window_start: float, events: list[Event]) -> None:
        self.loaded_windows += 1
        if self.loaded_windows == 1:
            self.loaded_windows_start = window_start
        elif self.loaded_windows == 2:
            seconds = t - self.loaded_windows_start
            events.append(InsoleNeverUnloads(t=t, known_at=known_at, site=self.site, seconds=seconds))

    def _update_lively(self, window: CellWindow) -> None:
        """Count the lively windows of each cell; use failed cells again after two in a row."""
        suspected_cells = {i for cells in self.suspected.values() for i in cells}
        for i, lively in enumerate(window.find_lively()):
            if i not in suspected_cells:  # a suspected cell keeps its count, because the count is why it is suspected
                self.lively_windows[i] = min(self.lively_windows[i] + 1, LIVELY_WINDOWS_ALONE) if lively else 0
        for fault, cells in self.failed.items():
            if fault not in (CellFault.MISSING, CellFault.INVERTED):
                self.failed[fault] = [i for i in cells if i in suspected_cells or self.lively_windows[i] < 2]
        self.excluded = self._all_failed()

    def _all_failed(self) -> list[int]:
        return sorted({i for cells in self.failed.values() for i in cells})

    def _report(self, t: float, known_at: float, fault: CellFault, cells: tuple[int, ...], events: list[Event]) -> None:
        events.append(CellsFailed(t=t, known_at=known_at, site=self.site, fault=fault, cells=cells))


def _is_number(value: Any) -> bool:
    return value is not None and bool(-ABSURD_PRESSURE < value < ABSURD_PRESSURE)
