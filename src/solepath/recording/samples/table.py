"""The samples of one foot as columns, and the checks of each column.

There are two kinds of fault. A wrong shape or unit makes a whole column useless, so its error is raised at once. A row
with a value that is not finite, or whose time is out of order, is left out and reported."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from attrs import define
from numpy.typing import NDArray

from ...types import SITE_OF_FOOT, Foot, Sample
from ..bad_rows import MAX_NAMED
from ..errors import RecordingError, UnusableValues, printable

Floats = NDArray[np.float64]

MAX_VALUES = 100_000_000
"""Largest count of numbers in a file of samples, which take 0.8 GB: three hours of two feet with 16 cells at 200 Hz."""
QUANTITIES = ("acc", "gyro", "pressure")
"""Quantities that a table may have."""
BLOCK_SIZE = 4096
"""Number of rows that are converted to samples at a time, so that never all samples are in memory."""

MEDIAN_ACC_RANGE = (3.0, 30.0)
"""Allowed range of the median |acc| of a foot, m/s^2; standing, walking and running have 9.4 to 20."""
MAX_GYRO = 40.0
"""Largest allowed 99th percentile of |gyro|, rad/s.

Running feet reach 17 rad/s, and most sensors end at 2000 degrees/s, which is 35 rad/s."""
MAX_INTERVAL, MIN_INTERVAL = 0.5, 2e-4
"""Allowed range of the median time between samples, s; outside it the unit of time is not s."""


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
    places = [f"after {float(t[before[-1]])!r} s"] if len(before) else []
    places += [f"before {float(t[row + 1 + after[0]])!r} s"] if len(after) else []
    return f"time is out of order: {float(t[row])!r} s {' and '.join(places)}"


def check_units(table: FootTable) -> None:
    """Raise UnusableValues when the numbers are in another unit, or the times are not those of the samples."""
    for quantity, complaint in _find_wrong_units(table.t, table.columns):
        raise UnusableValues(table.path, complaint, table.names[quantity])


def _find_wrong_units(t: Floats, columns: Mapping[str, Floats]) -> Iterator[tuple[str, str]]:
    """Yield each quantity whose unit is certainly not SI, with a complaint; a wrong unit can give a plausible track."""
    if len(t) > 2:
        interval = float(np.median(np.diff(t)))
        if not MIN_INTERVAL <= interval <= MAX_INTERVAL:
            yield "t", f"the median time between samples is {interval:.3g} s: {_explain_times(t, interval)}"
    if "acc" in columns:
        median = float(np.median(_vector_lengths(columns["acc"])))
        low, high = MEDIAN_ACC_RANGE
        if not low <= median <= high:
            yield (
                "acc",
                f"the median of |acc| is {median:.3g} m/s^2, not 9.8: this looks like {_guess_acc_unit(median)}",
            )
    if "gyro" in columns:
        high = float(np.percentile(_vector_lengths(columns["gyro"]), 99.0, method="higher"))
        if high > MAX_GYRO:
            unit = "deg/s" if high < 4000.0 else "thousandths of a degree a second, or raw counts"
            yield "gyro", f"|gyro| reaches {high:.3g} rad/s, faster than a foot turns: this looks like {unit}"


def _explain_times(t: Floats, median: float) -> str:
    """Return what times, s, look like whose intervals have a median that cannot be right, s."""
    if median > MAX_INTERVAL:
        return "this looks like milliseconds or sample numbers"
    starts = np.flatnonzero(np.diff(t) >= MIN_INTERVAL) + 1
    if len(starts):
        count, span = int(starts[-1]), float(t[starts[-1]] - t[0])
        if MIN_INTERVAL <= span / count <= MAX_INTERVAL:
            return (
                f"{'times repeat: ' if median == 0.0 else ''}samples come in bursts of about {count / len(starts):.0f},"
                f" one burst each {span / len(starts):.3g} s, as with the time at which their packet came; give each"
                f" sample its own time, about {span / count:.3g} s after the one before"
            )
    return "times repeat" if median == 0.0 else "these are not seconds"


def _guess_acc_unit(median: float) -> str:
    if median < 0.3:
        return "no specific force at all (gravity removed?)"
    if median < 3.0:
        return "g"
    return "milli-g" if 700.0 < median < 1500.0 else "raw counts"


def _vector_lengths(vectors: Floats) -> Floats:
    with np.errstate(over="ignore"):  # an infinite length fails the checks as well
        return np.asarray(np.sqrt(np.sum(vectors * vectors, axis=1)), dtype=np.float64)
