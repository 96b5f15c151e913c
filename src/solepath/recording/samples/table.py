"""The samples of one foot as columns, and the checks of each column, in plain Python: an app may have no numpy.

A row with a value that is not finite, or whose time is out of order, is left out and reported."""

from __future__ import annotations

from array import array
from bisect import bisect_left, bisect_right
from collections.abc import Iterator, Sequence
from itertools import compress, pairwise, repeat
from math import hypot, isfinite, isnan
from pathlib import Path
from statistics import median

from attrs import define, field

from ...types import SITE_OF_FOOT, Foot, Sample
from ...types.doubles import Doubles, doubles
from ..errors import RecordingError
from ..mapping.mapping import MEASURED, NamedColumn, TableMapping
from ..mapping.units import SI, UNITS

MAX_VALUES = 100_000_000
"""Largest count of numbers in a file of samples, which take 0.8 GB: three hours of two feet with 16 cells at 200 Hz."""
FLOAT_SIZE = 8
"""Size of a number in memory, bytes."""
LONGEST_BURST = 32
"""Number of samples over which the time between two of them is averaged; a packet has at most some 20."""


@define
class FootTable:
    """The columns of one foot, SI units: the times, and the components of those of acc, gyro and pressure present."""

    path: Path
    foot: Foot
    names: dict[str, str]
    """Name of each quantity in the file."""
    t: Doubles = field(factory=doubles)
    columns: dict[str, list[Doubles]] = field(factory=dict)
    """Values of each component of a quantity."""
    lines: Sequence[int] | None = None
    """Line number of each row in a text file; None for an archive, whose rows count from 0."""
    is_assumed: bool = False
    """Flag: nothing says of which foot the table is."""
    is_named: bool = True
    """Flag: the file itself says of which foot the table is, not its name alone."""
    is_own: bool = False
    """Flag: the times are in the unit s and under the name of this project, so that they stay as they are."""
    sources: dict[str, tuple[NamedColumn, ...]] = field(factory=dict)
    """Columns of the file that hold each quantity; without `t` in a table that has a rate instead."""
    units: dict[str, str] = field(factory=dict)
    """Unit of each quantity in the file; SI where it says none."""
    mapping: TableMapping = field(factory=TableMapping)
    """Mapping that the user gave for the table."""

    def __len__(self) -> int:
        return len(self.t)

    @property
    def signed(self) -> dict[str, tuple[str, ...]]:
        """Names of the columns of each sensor, with "-" before one whose sign is changed."""
        return {
            quantity: tuple([("-" if one.sign < 0.0 else "") + one.name for one in its_columns])
            for quantity, its_columns in self.sources.items()
            if quantity != "t"
        }

    @property
    def interval(self) -> float:
        """Usual time between two samples, s; 0 with fewer than two."""
        return median([b - a for a, b in pairwise(self.t)]) if len(self) > 1 else 0.0

    @property
    def pace(self) -> float:
        """Usual time between two samples, s, also of those that come in bursts; 0 with fewer than two."""
        span = min(LONGEST_BURST, len(self) - 1)
        return median([b - a for a, b in zip(self.t, self.t[span:], strict=False)]) / span if len(self) > 1 else 0.0

    def factor(self, quantity: str) -> float:
        """Return the value in SI units of 1 in the file."""
        return UNITS[quantity][self.units.get(quantity, SI[quantity])] / self.mapping.scale.get(quantity, 1.0)

    def lengths(self, quantity: str) -> list[float]:
        """Return the length of each vector of a quantity; none for a quantity that is not there."""
        return [hypot(*vector) for vector in zip(*self.columns.get(quantity, ()), strict=True)]

    def locate_value(self, row: int, quantity: str) -> str:
        """Return a text that says where in the file the value of `quantity` in row `row` is."""
        name = self.names[quantity]
        return f"{name}, row {row}" if self.lines is None else f"line {self.lines[row]}, {name}"

    def select(self, is_kept: Sequence[bool]) -> None:
        """Remove the other rows."""
        self.t = doubles(compress(self.t, is_kept))
        self.columns = {q: [doubles(compress(one, is_kept)) for one in its] for q, its in self.columns.items()}
        self.lines = None if self.lines is None else array("q", compress(self.lines, is_kept))

    def make_samples(self) -> Iterator[Sample]:
        """Yield every row as a Sample."""
        site = SITE_OF_FOOT[self.foot]
        values = [zip(*self.columns[q], strict=True) if q in self.columns else repeat(None) for q in MEASURED]
        for t, acc, gyro, pressure in zip(self.t, *values):  # noqa: B905 - what repeats has no end
            yield Sample(t, site, acc, gyro, pressure)


def remove_bad_rows(table: FootTable) -> list[tuple[int, str, str]]:
    """Remove the rows that cannot be used from the table, and return number, place and fault of each.

    These have a value that is not finite (a pressure of NaN is a missing cell), or a time that is out of order: the
    fewest rows are removed without which time never decreases."""
    if not len(table):
        raise RecordingError(table.path, "holds no samples", table.names["t"])
    faults: dict[int, tuple[str, str]] = {}
    for quantity, columns in {"t": [table.t], **table.columns}.items():
        for column in columns:
            for row, value in () if all(map(isfinite, column)) else enumerate(column):
                if not isfinite(value) and not (quantity == "pressure" and isnan(value)):
                    when = "" if quantity == "t" else f" (t = {table.t[row]:.6g} s)"
                    what = f"is {value}, not a finite number{when}"
                    faults.setdefault(row, (table.locate_value(row, quantity), what))
    rows = [row for row in range(len(table)) if row not in faults]
    kept = rows_in_order(table.t, rows)
    for row in sorted({*rows} - {*kept}):
        before = bisect_left(kept, row)
        places = [f"after {table.t[kept[before - 1]]:.10g} s"] if before else []
        places += [f"before {table.t[kept[before]]:.10g} s"] if before < len(kept) else []
        what = f"time is out of order: {table.t[row]:.10g} s {' and '.join(places)}"
        faults[row] = table.locate_value(row, "t"), what
    numbers = range(len(table)) if table.lines is None else table.lines
    found = [(numbers[row], *faults[row]) for row in sorted(faults)]
    if faults:
        table.select([row not in faults for row in range(len(table))])
    return found


def rows_in_order(t: Sequence[float], rows: list[int]) -> list[int]:
    """Return the rows of a longest sequence in which the times never decrease.

    `ends` holds, for each length, the least time at which such a sequence ends (patience sorting)."""
    if all(t[a] <= t[b] for a, b in pairwise(rows)):
        return rows
    ends: list[float] = []
    end_rows: list[int] = []
    previous: dict[int, int] = {}
    for row in rows:
        length = bisect_right(ends, t[row])
        ends[length : length + 1], end_rows[length : length + 1] = [t[row]], [row]
        if length:
            previous[row] = end_rows[length - 1]
    kept = end_rows[-1:]
    while kept[-1] in previous:
        kept.append(previous[kept[-1]])
    return kept[::-1]
