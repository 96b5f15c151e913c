"""The samples of one foot as columns, and the checks of each column.

There are two kinds of fault. A fault of a whole column (its shape, its unit) is raised at once, because none of its
values can be trusted. A fault from one row on (a value that is not finite, time that runs backwards) ends the table
there, so that the rows before are used and the error comes after them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from operator import itemgetter
from pathlib import Path
from typing import Any

import numpy as np
from attrs import define
from numpy.typing import NDArray

from ...types import SITE_OF_FOOT, Foot, Sample
from ..errors import RecordingError, printable

Floats = NDArray[np.float64]

QUANTITIES = ("acc", "gyro", "pressure")
"""Quantities that a table may hold."""
BLOCK_SIZE = 4096
"""Rows that are turned into samples at a time, so that memory holds the arrays and not a tuple for every sample."""

ACC_AT_REST = (3.0, 30.0)
"""Range of the median |acc| of any recording on a foot, m/s^2; standing, walking and running lie in 9.4 to 20."""
MAX_GYRO = 40.0
"""Largest 99th percentile of |gyro|, rad/s.

Feet that run reach 17; 40 rad/s is beyond the 2000 deg/s range of most sensors."""
MAX_INTERVAL, MIN_INTERVAL = 0.5, 2e-4
"""Range of the median time between samples, s: outside it the times are not seconds."""


@define
class FootTable:
    """The columns of one foot: `t` (n,), acc and gyro (n,3) and pressure (n,k) where there are any, SI units."""

    path: Path
    foot: Foot
    names: dict[str, str]
    """Name of each quantity in the file."""
    t: Floats
    columns: dict[str, Floats]
    lines: list[int] | None = None
    """Line of each row in a text file; None for an array file, whose rows count from 0."""
    flaw: RecordingError | None = None
    """Reason why the table ends where it ends, when that is not the end of the file."""

    def __len__(self) -> int:
        return len(self.t)

    def place(self, row: int, quantity: str) -> str:
        """Return the place of a value in the file, for a sentence."""
        name = self.names[quantity]
        return f"{name}, row {row}" if self.lines is None else f"line {self.lines[row]}, {name}"

    def samples(self) -> Iterator[Sample]:
        """Yield every row as a Sample."""
        site = SITE_OF_FOOT[self.foot]
        empty = [None] * BLOCK_SIZE
        for start in range(0, len(self), BLOCK_SIZE):
            rows = slice(start, start + BLOCK_SIZE)
            t = self.t[rows].tolist()
            acc, gyro, pressure = (
                map(tuple, self.columns[q][rows].tolist()) if q in self.columns else iter(empty) for q in QUANTITIES
            )
            for at, a, g, p in zip(t, acc, gyro, pressure, strict=False):
                yield Sample(at, site, a, g, p)


def as_floats(path: Path, name: str, value: NDArray[Any], width: int | None) -> Floats:
    """Return `value` as float64 of shape (n,) for width 0, (n, width), or (n, any) for None.

    RecordingError for another shape or type."""
    if value.dtype.kind not in "fiu":
        raise RecordingError(path, f"holds {printable(str(value.dtype), 40)}, not numbers", name)
    expected = "(n,)" if width == 0 else f"(n, {'cells' if width is None else width})"
    fits = value.ndim == 1 if width == 0 else value.ndim == 2 and value.shape[1] > 0 and width in (None, value.shape[1])
    if not fits:
        raise RecordingError(path, f"has the shape {value.shape} instead of {expected}", name)
    return value.astype(np.float64)


def check_table(table: FootTable) -> FootTable:
    """Return the table, ended before its first row that cannot be used; RecordingError when none of it can be."""
    if not len(table):
        raise RecordingError(table.path, "holds no samples", table.names["t"])
    end, what, quantity = _first_bad_row(table)
    if end < len(table):
        table.flaw = RecordingError(table.path, what, table.place(end, quantity))
        if end == 0:
            raise table.flaw
        table.t = table.t[:end]
        table.columns = {q: column[:end] for q, column in table.columns.items()}
    for quantity, complaint in _complaints(table.t, table.columns):
        raise RecordingError(table.path, complaint, table.names[quantity])
    return table


def _first_bad_row(table: FootTable) -> tuple[int, str, str]:
    bad: list[tuple[int, str, str]] = [(len(table), "", "t")]
    for quantity, column in {"t": table.t, **table.columns}.items():
        values = column.reshape(len(table), -1)
        # cells without a number are missing cells, which the session reports
        sound = np.isfinite(values) | np.isnan(values) if quantity == "pressure" else np.isfinite(values)
        rows = np.flatnonzero(~sound.all(axis=1))
        if len(rows):
            value = next(v for v in values[rows[0], ~sound[rows[0]]].tolist())
            when = f" (t = {table.t[rows[0]]:.6g} s)" if quantity != "t" else ""
            bad.append((int(rows[0]), f"is {value}, not a finite number{when}", quantity))
    decreases = np.flatnonzero(
        np.diff(table.t) < 0.0
    )  # false where a time is not a number; these rows were found above
    if len(decreases):
        row = int(decreases[0]) + 1
        before, after = float(table.t[row - 1]), float(table.t[row])
        bad.append((row, f"time runs backwards, from {before!r} s to {after!r} s", "t"))
    return min(bad, key=itemgetter(0))


def _complaints(t: Floats, columns: Mapping[str, Floats]) -> Iterator[tuple[str, str]]:
    """Yield the quantities whose unit is plainly not SI; with a wrong unit the track would look plausible."""
    if len(t) > 2:
        step = float(np.median(np.diff(t)))
        if not MIN_INTERVAL <= step <= MAX_INTERVAL:
            likely = (
                "this looks like milliseconds or sample numbers" if step > MAX_INTERVAL else "these are not seconds"
            )
            if step == 0.0:
                likely = "times repeat"
            yield "t", f"the median time between samples is {step:.3g} s: {likely}"
    if "acc" in columns:
        median = float(np.median(_lengths(columns["acc"])))
        low, high = ACC_AT_REST
        if not low <= median <= high:
            yield "acc", f"the median of |acc| is {median:.3g} m/s^2, not 9.8: this looks like {_acc_unit(median)}"
    if "gyro" in columns:
        high = float(np.percentile(_lengths(columns["gyro"]), 99.0))
        if high > MAX_GYRO:
            unit = "deg/s" if high < 4000.0 else "raw counts"
            yield "gyro", f"|gyro| reaches {high:.3g} rad/s, faster than a foot turns: this looks like {unit}"


def _acc_unit(median: float) -> str:
    if median < 0.3:
        return "no specific force at all (gravity removed?)"
    if median < 3.0:
        return "g"
    return "milli-g" if 700.0 < median < 1500.0 else "raw counts"


def _lengths(vectors: Floats) -> Floats:
    with np.errstate(over="ignore"):  # an infinite length fails the checks as well
        return np.asarray(np.sqrt(np.sum(vectors * vectors, axis=1)), dtype=np.float64)
