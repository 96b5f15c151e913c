"""Joining of the files of one foot: accelerometer, gyroscope and insole, each with times of its own on one clock."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from attrs import evolve
from numpy.typing import NDArray

from ...types import Foot
from ..errors import RecordingError, printable
from .table import QUANTITIES, Floats, FootTable

SAME_RATE = 0.02
"""Relative difference of two rates up to which the times of the accelerometer are used."""
LONGEST_BRIDGED = 3.0
"""Longest time between two samples over which values are interpolated, in usual intervals of that sensor: two samples
may be missing. Over more, the joined samples have a gap too."""


def join_files(tables: Sequence[FootTable], problems: list[RecordingError]) -> list[FootTable]:
    """Return one table for each foot; what cannot be joined is added to `problems`."""
    joined = []
    for foot in Foot:
        own = [table for table in tables if table.foot is foot]
        if not own or _add_problems(foot, own, problems):
            continue
        joined.append(own[0] if len(own) == 1 else _join(foot, own, problems))
    return joined


def _add_problems(foot: Foot, tables: Sequence[FootTable], problems: list[RecordingError]) -> bool:
    """Add that two files hold the same quantity, or none the accelerometer; return whether there is such a problem."""
    count = len(problems)
    for quantity in QUANTITIES:
        holders = [table for table in tables if quantity in table.columns]
        if len(holders) > 1:
            what = f"holds {quantity} of the {foot.value} foot, as {printable(holders[0].path.name, 60)} does"
            repair = (
                "name the foot of each file: --foot left,right, or in Python [Foot.LEFT, Foot.RIGHT] after the files"
            )
            problems.append(RecordingError(holders[1].path, what, repair=repair))
    turning = [table for table in tables if "gyro" in table.columns]
    if turning and not any("acc" in table.columns for table in tables):
        what = f"names {turning[0].names['gyro']} but not acc"
        repair = "give the file of the accelerometer as well, or its columns: --columns acc=X,Y,Z"
        where = "" if turning[0].lines is None else "line 1"
        problems.append(RecordingError(turning[0].path, what, where, repair))
    return len(problems) > count


def _join(foot: Foot, tables: Sequence[FootTable], problems: list[RecordingError]) -> FootTable:
    """Return the tables of one foot as one, at the times of the sensor with the most samples a second."""
    fastest = max(map(_rate, tables))
    base = next(
        table
        for quantity in QUANTITIES
        for table in tables
        if quantity in table.columns and _rate(table) >= (1.0 - SAME_RATE) * fastest
    )
    usable = np.ones(len(base), dtype=bool)
    columns, names, signed = dict(base.columns), dict(base.names), dict(base.signed)
    for other in tables:
        if other is base:
            continue
        covered = _covered(base.t, other.t)
        if not covered.any():
            what = f"holds no time that {printable(base.path.name, 60)} holds, too ({_span(other)}, not {_span(base)})"
            repair = "take times of the same clock from both: --columns t=NAME"
            problems.append(RecordingError(other.path, what, other.names["t"], repair))
            continue
        usable &= covered
        for quantity, column in other.columns.items():
            columns[quantity] = np.stack([np.interp(base.t, other.t, values) for values in column.T], axis=1)
            names[quantity] = other.names[quantity]
        signed |= other.signed
    return evolve(
        base,
        t=base.t[usable],
        columns={quantity: column[usable] for quantity, column in columns.items()},
        lines=None if base.lines is None else base.lines[usable],
        names=names,
        signed=signed,
    )


def _rate(table: FootTable) -> float:
    """Return the usual number of samples a second, Hz."""
    interval = float(np.median(np.diff(table.t))) if len(table) > 1 else 0.0
    return 1.0 / interval if interval > 0.0 else 0.0


def _covered(t: Floats, other: Floats) -> NDArray[np.bool_]:
    """Return for each time whether samples of the other sensor are near enough before and after it."""
    if len(other) < 2:
        return np.isin(t, other)
    after = np.clip(np.searchsorted(other, t), 1, len(other) - 1)
    width = other[after] - other[after - 1]
    is_near = width <= LONGEST_BRIDGED * float(np.median(np.diff(other)))
    is_exact = (t == other[after]) | (t == other[after - 1])
    covered: NDArray[np.bool_] = (other[0] <= t) & (t <= other[-1]) & (is_near | is_exact)
    return covered


def _span(table: FootTable) -> str:
    return f"{table.t[0]:.10g} to {table.t[-1]:.10g} s"
