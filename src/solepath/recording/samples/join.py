"""Joining of the files of one foot: accelerometer, gyroscope and insole, each with times of its own on one clock."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterator, Sequence

from attrs import evolve

from ...types import Foot
from ...types.doubles import doubles
from ..errors import RecordingError, printable
from ..mapping.mapping import MEASURED
from .table import FootTable

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
        faults = list(_find_problems(foot, own))
        if own and not faults:
            joined.append(own[0] if len(own) == 1 else _join(own, faults))
        problems += faults
    return joined


def _find_problems(foot: Foot, tables: Sequence[FootTable]) -> Iterator[RecordingError]:
    """Yield that two files hold the same quantity, or none the accelerometer."""
    holders = {q: [table for table in tables if q in table.columns] for q in MEASURED}
    for quantity, (first, second, *_) in {q: own for q, own in holders.items() if len(own) > 1}.items():
        what = f"holds {quantity} of the {foot.value} foot, as {printable(first.path.name, 60)} does"
        repair = "name the foot of each file: --foot left,right, or in Python [Foot.LEFT, Foot.RIGHT] after the files"
        yield RecordingError(second.path, what, repair=repair)
    if holders["gyro"] and not holders["acc"]:
        turning = holders["gyro"][0]
        what = f"names {turning.names['gyro']} but not acc"
        repair = "give the file of the accelerometer as well, or its columns: --columns acc=X,Y,Z"
        yield RecordingError(turning.path, what, "" if turning.lines is None else "line 1", repair)


def _join(tables: Sequence[FootTable], problems: list[RecordingError]) -> FootTable:
    """Return the tables of one foot as one, at the times of the sensor with the most samples a second."""
    rates = [1.0 / table.interval if table.interval > 0.0 else 0.0 for table in tables]
    fast = [table for table, rate in zip(tables, rates, strict=True) if rate >= (1.0 - SAME_RATE) * max(rates)]
    base = min(fast, key=lambda one: min(map(MEASURED.index, one.columns)))
    joined, is_used = evolve(base, columns=dict(base.columns)), [True] * len(base)
    for other in [table for table in tables if table is not base]:
        rows = list(_interpolate(base.t, other))
        if not any(rows):
            what = f"holds no time that {printable(base.path.name, 60)} holds, too ({_span(other)}, not {_span(base)})"
            repair = "take times of the same clock from both: --columns t=NAME"
            problems.append(RecordingError(other.path, what, other.names["t"], repair))
            continue
        is_used = [is_one and row is not None for is_one, row in zip(is_used, rows, strict=True)]
        blank = [0.0] * sum(map(len, other.columns.values()))
        values = map(doubles, zip(*[row or blank for row in rows], strict=True))
        joined.columns |= {q: [next(values) for _ in columns] for q, columns in other.columns.items()}
        joined.names, joined.sources = other.names | joined.names, other.sources | joined.sources
    joined.select(is_used)
    return joined


def _interpolate(t: Sequence[float], other: FootTable) -> Iterator[list[float] | None]:
    """Yield for each time the values of another sensor, on straight lines between its samples before and after.

    None for a time at which these are not near enough."""
    times, longest = other.t, LONGEST_BRIDGED * other.interval
    columns = [column for columns in other.columns.values() for column in columns]
    for now in t:
        after = bisect_right(times, now)
        first, last = max(after - 1, 0), min(after, len(times) - 1)
        gap = times[last] - times[first]
        is_near = times[0] <= now <= times[-1] and (gap <= longest or now == times[first])
        share = now - times[first]
        slopes = ((one[first], (one[last] - one[first]) / (gap or 1.0)) for one in columns)
        yield [slope * share + start for start, slope in slopes] if is_near else None


def _span(table: FootTable) -> str:
    return f"{table.t[0]:.10g} to {table.t[-1]:.10g} s"
