"""Reading of recorded ranges between the feet, which have times of their own.

A .csv file has the columns `t`, s, and `range`, m; other columns are ignored. A .npz archive has the keys `t_range`, s,
and `range`, m, and may be that of the other samples."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np

from ...types import SITE_OF_FOOT, Foot, Sample
from ..errors import RecordingError, open_file
from .npz import read_arrays
from .table import Floats

MAX_MEDIAN = 1.5
"""Largest median range of feet in metres, m; feet are 0.05 to 1 m apart in a step."""


def read_ranges(path: Path | str, foot: Foot = Foot.RIGHT) -> list[Sample]:
    """Return the ranges in a .csv or .npz file as samples of `foot`, in the order of time.

    Merge them with the other samples by time: `sorted([*samples, *read_ranges(path)], key=attrgetter("t"))`.
    RecordingError is raised for a file that cannot be used, with the place of the fault."""
    path = Path(path)
    match path.suffix.lower():
        case ".npz":
            arrays = read_arrays(path, {"t_range", "range"}.__contains__)
            if set(arrays) != {"t_range", "range"}:
                raise RecordingError(path, "has no keys t_range and range")
            t, ranges = (np.asarray(arrays[key], dtype=np.float64) for key in ("t_range", "range"))
            if t.ndim != 1 or t.shape != ranges.shape:
                raise RecordingError(path, f"has the shape {ranges.shape} but t_range has {t.shape}", "range")
        case ".csv":
            t, ranges = _read_columns(path)
        case _:
            raise RecordingError(path, "is neither .npz nor .csv, so it holds no ranges")
    usable = np.isfinite(t) & np.isfinite(ranges) & (ranges > 0.0)
    t, ranges = t[usable], ranges[usable]
    if not len(t):
        raise RecordingError(path, "holds no ranges")
    median = float(np.median(ranges))
    if median > MAX_MEDIAN:
        unit = "cm" if median < 100.0 else "mm"
        raise RecordingError(
            path, f"the median is {median:.3g} m, which no feet are apart: this looks like {unit}", "range"
        )
    order = np.argsort(t, kind="stable")
    site = SITE_OF_FOOT[foot]
    return [Sample(at, site, range=one) for at, one in zip(t[order].tolist(), ranges[order].tolist(), strict=True)]


def _read_columns(path: Path) -> tuple[Floats, Floats]:
    """Return the columns t and range of a table; a blank range is no range."""
    with open_file(path) as file:
        lines = file.read().decode("utf-8-sig", errors="replace").splitlines()
    names = [name.strip().lower() for name in next(csv.reader(lines[:1]), [])]
    if "t" not in names or "range" not in names:
        raise RecordingError(path, "names no columns t and range", "line 1")
    columns = (names.index("t"), names.index("range"))
    found: list[tuple[float, float]] = []
    for number, row in enumerate(csv.reader(lines[1:]), 2):
        try:
            if row and row[columns[1]].strip():
                found.append((float(row[columns[0]]), float(row[columns[1]])))
        except (IndexError, ValueError) as error:
            raise RecordingError(path, "has no numbers t and range", f"line {number}") from error
    rows = np.array(found, dtype=np.float64).reshape(-1, 2)
    return rows[:, 0], rows[:, 1]
