"""The samples of one foot as columns, and the checks of each column.

A wrong shape makes a whole column useless, so its error is raised at once. A row with a value that is not finite, or
whose time is out of order, is left out and reported."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from attrs import define, field
from numpy.typing import NDArray

from ...types import SITE_OF_FOOT, Foot, Sample
from ..bad_rows import MAX_NAMED
from ..errors import RecordingError, printable
from ..mapping.mapping import TableMapping

Floats = NDArray[np.float64]

MAX_VALUES = 100_000_000
"""Largest count of numbers in a file of samples, which take 0.8 GB: three hours of two feet with 16 cells at 200 Hz."""
QUANTITIES = ("acc", "gyro", "pressure")
"""Quantities that a table may have."""
BLOCK_SIZE = 4096
"""Number of rows that are converted to samples at a time, so that never all samples are in memory."""


@define
class FootTable:
    """The columns of one foot, SI units: `t` (n,), and those present of acc (n,3), gyro (n,3) and pressure (n,k)."""

    path: Path
    foot: Foot
    names: dict[str, str]
    """Name of each quantity in the file."""
    t: Floats
    columns: dict[str, Floats]
    lines: NDArray[np.int64] | None = None
    """Line number of each row in a text file; None for an archive, whose rows count from 0."""
    is_assumed: bool = False
    """Flag: nothing says of which foot the table is."""
    is_named: bool = True
    """Flag: the file itself says of which foot the table is, not its name alone."""
    is_own: bool = True
    """Flag: the times are in the unit s and under the name of this project, so that they stay as they are."""
    units: dict[str, str] = field(factory=dict)
    """Unit of each quantity in the file; SI where it says none."""
    signed: dict[str, tuple[str, ...]] = field(factory=dict)
    """Names of the columns of each quantity, with "-" before one whose sign is changed; empty for an archive."""
    mapping: TableMapping = field(factory=TableMapping)
    """Mapping that the user gave for the table."""

    def __len__(self) -> int:
        return len(self.t)

    def locate_value(self, row: int, quantity: str) -> str:
        """Return a text that says where in the file the value of `quantity` in row `row` is."""
        name = self.names[quantity]
        return f"{name}, row {row}" if self.lines is None else f"line {self.lines[row]}, {name}"

    def make_samples(self) -> Iterator[Sample]:
        """Yield every row as a Sample."""
        site = SITE_OF_FOOT[self.foot]
        empty = [None] * BLOCK_SIZE
        for start in range(0, len(self), BLOCK_SIZE):
            rows = slice(start, start + BLOCK_SIZE)
            t = self.t[rows].tolist()
            acc, gyro, pressure = (
                map(tuple, self.columns[q][rows].tolist()) if q in self.columns else iter(empty) for q in QUANTITIES
            )
            for sample_t, a, g, p in zip(t, acc, gyro, pressure, strict=False):
                yield Sample(sample_t, site, a, g, p)


def to_floats(path: Path, name: str, value: NDArray[Any], width: int | None) -> Floats:
    """Return `value` as float64; RecordingError for another type, or for another shape than `width` requires.

    The shape is (n,) for a width of 0, (n, any) for None, and else (n, width)."""
    if value.dtype.kind not in "fiu":
        raise RecordingError(path, f"holds {printable(str(value.dtype), 40)}, not numbers", name)
    expected = "(n,)" if width == 0 else f"(n, {'cells' if width is None else width})"
    fits = value.ndim == 1 if width == 0 else value.ndim == 2 and value.shape[1] > 0 and width in (None, value.shape[1])
    if not fits:
        raise RecordingError(path, f"has the shape {value.shape} instead of {expected}", name)
    return value.astype(np.float64)


@define
class RowFaults:
    """The rows of a table that cannot be used: their numbers in the file, and place and fault of the first ones."""

    numbers: NDArray[np.int64]
    named: list[tuple[int, str, str]]
    """Number, place and fault of the first rows."""


def remove_bad_rows(table: FootTable) -> RowFaults:
    """Remove the rows that cannot be used from the table, and return them.

    These have a value that is not finite (a pressure of NaN is a missing cell), or a time that is out of order: the
    fewest rows are removed without which time never decreases."""
    if not len(table):
        raise RecordingError(table.path, "holds no samples", table.names["t"])
    numbers = np.arange(len(table)) if table.lines is None else table.lines
    bad = np.zeros(len(table), dtype=bool)
    faults: dict[int, tuple[str, str]] = {}
    for quantity, column in {"t": table.t, **table.columns}.items():
        values = column.reshape(len(table), -1)
        is_usable = np.isfinite(values) | np.isnan(values) if quantity == "pressure" else np.isfinite(values)
        is_bad = ~is_usable.all(axis=1)
        for row in np.flatnonzero(is_bad & ~bad)[:MAX_NAMED].tolist():
            value = next(v for v in values[row, ~is_usable[row]].tolist())
            time_text = f" (t = {table.t[row]:.6g} s)" if quantity != "t" else ""
            faults[row] = (table.locate_value(row, quantity), f"is {value}, not a finite number{time_text}")
        bad |= is_bad
    finite = np.flatnonzero(~bad)
    out_of_order = finite[_out_of_order(table.t[finite])]
    bad[out_of_order] = True
    for row in out_of_order[:MAX_NAMED].tolist():
        faults[row] = (table.locate_value(row, "t"), _describe_order(table.t, bad, row))
    if bad.any():
        table.t = table.t[~bad]
        table.columns = {q: column[~bad] for q, column in table.columns.items()}
        table.lines = None if table.lines is None else table.lines[~bad]
    return RowFaults(numbers[bad], [(int(numbers[row]), *faults[row]) for row in sorted(faults)[:MAX_NAMED]])


def _out_of_order(t: Floats) -> NDArray[np.int64]:
    """Return the fewest indices without which the times never decrease: those beside a longest sequence that does not.

    `ends` holds, for each length, the least time at which such a sequence ends (patience sorting)."""
    if len(t) < 2 or not np.any(np.diff(t) < 0.0):
        return np.empty(0, dtype=np.int64)
    ends: list[float] = []
    end_rows: list[int] = []
    previous = np.full(len(t), -1, dtype=np.int64)
    for row, time in enumerate(t.tolist()):
        length = bisect_right(ends, time)
        if length == len(ends):
            ends.append(time)
            end_rows.append(row)
        else:
            ends[length], end_rows[length] = time, row
        if length:
            previous[row] = end_rows[length - 1]
    kept = np.zeros(len(t), dtype=bool)
    row = end_rows[-1]
    while row >= 0:
        kept[row] = True
        row = int(previous[row])
    return np.flatnonzero(~kept)


def _describe_order(t: Floats, bad: NDArray[np.bool_], row: int) -> str:
    before, after = np.flatnonzero(~bad[:row]), np.flatnonzero(~bad[row + 1 :])
    places = [f"after {float(t[before[-1]]):.10g} s"] if len(before) else []
    places += [f"before {float(t[row + 1 + after[0]]):.10g} s"] if len(after) else []
    return f"time is out of order: {float(t[row]):.10g} s {' and '.join(places)}"
