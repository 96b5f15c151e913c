"""Joining of the files of one foot: accelerometer, gyroscope and insole, each with times of its own on one clock."""

from __future__ import annotations

from array import array
from bisect import bisect_left, bisect_right
from collections.abc import Sequence

from attrs import evolve

from ...types import Foot
from ..errors import RecordingError, printable
from ..mapping.mapping import MEASURED
from .table import FootTable, floats

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
        if own and not _add_problems(foot, own, problems):
            joined.append(own[0] if len(own) == 1 else _join(own, problems))
    return joined


def _add_problems(foot: Foot, tables: Sequence[FootTable], problems: list[RecordingError]) -> bool:
    """Add that two files hold the same quantity, or none the accelerometer; return whether there is such a problem."""
    count = len(problems)
    holders = {q: [table for table in tables if q in table.columns] for q in MEASURED}
    for quantity, (first, second, *_) in {q: own for q, own in holders.items() if len(own) > 1}.items():
        what = f"holds {quantity} of the {foot.value} foot, as {printable(first.path.name, 60)} does"
        repair = "name the foot of each file: --foot left,right, or in Python [Foot.LEFT, Foot.RIGHT] after the files"
        problems.append(RecordingError(second.path, what, repair=repair))
    if holders["gyro"] and not holders["acc"]:
        turning = holders["gyro"][0]
        what = f"names {turning.names['gyro']} but not acc"
        repair = "give the file of the accelerometer as well, or its columns: --columns acc=X,Y,Z"
        problems.append(RecordingError(turning.path, what, "" if turning.lines is None else "line 1", repair))
    return len(problems) > count


def _join(tables: Sequence[FootTable], problems: list[RecordingError]) -> FootTable:
    """Return the tables of one foot as one, at the times of the sensor with the most samples a second."""
    rates = {table.path: 1.0 / table.interval if table.interval > 0.0 else 0.0 for table in tables}
    fast = [table for table in tables if rates[table.path] >= (1.0 - SAME_RATE) * max(rates.values())]
    base = min(fast, key=lambda one: min(MEASURED.index(quantity) for quantity in one.columns))
    is_used = [True] * len(base)
    columns, names, sources = dict(base.columns), dict(base.names), dict(base.sources)
    for other in tables:
        if other is base:
            continue
        covered = _covered(base.t, other)
        if not any(covered):
            what = f"holds no time that {printable(base.path.name, 60)} holds, too ({_span(other)}, not {_span(base)})"
            repair = "take times of the same clock from both: --columns t=NAME"
            problems.append(RecordingError(other.path, what, other.names["t"], repair))
            continue
        is_used = [a and b for a, b in zip(is_used, covered, strict=True)]
        for quantity, its_columns in other.columns.items():
            columns[quantity] = [_interpolated(base.t, other.t, values) for values in its_columns]
            names[quantity] = other.names[quantity]
        sources = other.sources | sources
    joined = evolve(base, columns=columns, names=names, sources=sources)
    joined.select(is_used)
    return joined


def _covered(t: array[float], other: FootTable) -> list[bool]:
    """Return for each time whether samples of the other sensor are near enough before and after it."""
    times, longest = other.t, LONGEST_BRIDGED * other.interval
    covered = []
    for now in t:
        after = min(max(bisect_left(times, now), 1), len(times) - 1)
        is_near = times[after] - times[after - 1] <= longest or now in (times[after], times[after - 1])
        covered.append(times[0] <= now <= times[-1] and is_near)
    return covered


def _interpolated(t: array[float], times: array[float], values: array[float]) -> array[float]:
    """Return the values at the times `t`, on straight lines between those before and after."""
    found = floats()
    for now in t:
        after = bisect_right(times, now)
        first, last = max(after - 1, 0), min(after, len(times) - 1)
        slope = (values[last] - values[first]) / ((times[last] - times[first]) or 1.0)
        found.append(slope * (now - times[first]) + values[first] if after else values[0])
    return found


def _span(table: FootTable) -> str:
    return f"{table.t[0]:.10g} to {table.t[-1]:.10g} s"
