"""Search of a table for numbers that are certainly not in SI units, each with what repairs it."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ..errors import UnusableValues
from ..mapping.units import DATETIME, GRAVITY, UNITS
from .table import Floats, FootTable

MEDIAN_ACC_RANGE = (3.0, 30.0)
"""Allowed range of the median |acc| of a foot, m/s^2; standing, walking and running have 9.4 to 20."""
MAX_GYRO = 40.0
"""Largest allowed 99th percentile of |gyro|, rad/s.

Running feet reach 17 rad/s, and most sensors end at 2000 degrees/s, which is 35 rad/s."""
MAX_INTERVAL, MIN_INTERVAL = 0.5, 2e-4
"""Allowed range of the median time between samples, s; outside it the unit of time is not s."""
USUAL_INTERVAL = (1e-3, 0.2)
"""Range of the median time between samples for which a unit of time is offered, s: sensors have 5 to 1000 Hz."""
SHARE_AT_REST = 0.2
"""Share of the samples, those with the lowest angular rate, that count as a foot at rest; a walker stands on a foot for
40 % of the time or more (docs/gait.md)."""
NEAR = 0.2
"""Largest relative difference between specific force at rest and gravity for which a unit of it is offered."""
NO_GRAVITY = 0.3
"""Specific force at rest below which gravity was removed, m/s^2 or g: nothing else is so small in any unit."""


def find_wrong_units(table: FootTable) -> Iterator[UnusableValues]:
    """Yield an error for each quantity whose unit is certainly not SI; a wrong unit can give a plausible track."""
    yield from _check_times(table)
    if "acc" in table.columns:
        lengths = _vector_lengths(table.columns["acc"])
        median = float(np.median(lengths))
        low, high = MEDIAN_ACC_RANGE
        if not low <= median <= high:
            kind, repair = _explain_acc(table, lengths)
            what = f"the median of |acc| is {median:.3g} m/s^2, not 9.8: this looks like {kind}"
            yield UnusableValues(table.path, what, table.names["acc"], repair)
    if "gyro" in table.columns:
        top = float(np.percentile(_vector_lengths(table.columns["gyro"]), 99.0, method="higher"))
        if top > MAX_GYRO:
            is_degrees = top < 4000.0
            unit = "deg/s" if is_degrees else "thousandths of a degree a second, or raw counts"
            what = f"|gyro| reaches {top:.3g} rad/s, faster than a foot turns: this looks like {unit}"
            repair = table.mapping.write_unit("gyro", "deg/s" if is_degrees else "mdeg/s")
            yield UnusableValues(table.path, what, table.names["gyro"], repair)


def _check_times(table: FootTable) -> Iterator[UnusableValues]:
    if len(table) <= 2:
        return
    intervals = np.diff(table.t)
    interval = float(np.median(intervals))
    if MIN_INTERVAL <= interval <= MAX_INTERVAL:
        return
    stated = table.mapping.units.get("t", "s")
    raw = interval / UNITS["t"].get(stated, 1.0)
    low, high = USUAL_INTERVAL
    fitting = [unit for unit, factor in UNITS["t"].items() if unit != DATETIME and low <= raw * factor <= high]
    repair = table.mapping.write_unit("t", fitting[0]) if fitting else ""
    if interval > MAX_INTERVAL and bool(np.all(intervals == intervals[0])) and raw == 1.0:
        repair += " or, for sample numbers, " + table.mapping.write_setting("rate", "HZ") if repair else ""
    what = f"the median time between samples is {interval:.3g} s: {_explain_times(table.t, interval)}"
    yield UnusableValues(table.path, what, table.names["t"], repair)


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


def _explain_acc(table: FootTable, lengths: Floats) -> tuple[str, str]:
    """Return what specific force looks like whose median cannot be right, and what repairs it."""
    rest = float(np.median(lengths))
    if "gyro" in table.columns:
        rates = _vector_lengths(table.columns["gyro"])
        rest = float(np.median(lengths[rates <= np.quantile(rates, SHARE_AT_REST)]))
    if rest < NO_GRAVITY:
        text = "no specific force at all (gravity removed?)"
        return text, "give the columns that the accelerometer measured, with gravity"
    factors = UNITS["acc"]
    raw = rest / factors[table.mapping.units.get("acc", "m/s^2")]
    for unit, factor in factors.items():
        if abs(raw * factor - GRAVITY) < NEAR * GRAVITY:
            return {"mg": "milli-g"}.get(unit, unit), table.mapping.write_unit("acc", unit)
    return "raw counts" if rest > 3.0 else "another unit, or gravity removed", ""


def _vector_lengths(vectors: Floats) -> Floats:
    with np.errstate(over="ignore"):  # an infinite length fails the checks as well
        return np.asarray(np.sqrt(np.sum(vectors * vectors, axis=1)), dtype=np.float64)
