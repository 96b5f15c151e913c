"""Search of a table for numbers that are certainly not in SI units, each with what repairs it."""

from __future__ import annotations

import numpy as np

from ..errors import UnusableValues
from ..mapping.units import DATETIME, GRAVITY, UNITS
from .table import Floats, FootTable

MEDIAN_ACC_RANGE = (3.0, 30.0)
"""Allowed range of the median |acc| of a foot, m/s^2; standing, walking and running have 9.4 to 20."""
MAX_GYRO = 40.0
"""Largest allowed 99th percentile of |gyro|, rad/s.

Running feet reach 17 rad/s, and most sensors end at 2000 degrees/s, which is 35 rad/s."""
MAX_DEGREES = 4000.0
"""Largest |gyro| that may be in degrees a second: twice the range of most sensors."""
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


def find_wrong_units(table: FootTable) -> list[UnusableValues]:
    """Return an error for each quantity whose unit is certainly not SI; a wrong unit can give a plausible track."""
    faults = {**_check_times(table), **_check_acc(table), **_check_gyro(table)}
    units = {quantity: unit for quantity, (_, unit, _) in faults.items() if unit}
    errors = []
    for quantity, (what, unit, action) in faults.items():
        repair = table.mapping.write_units(quantity, units) + action if unit else action
        errors.append(UnusableValues(table.path, what, table.names[quantity], repair))
    return errors


Fault = tuple[str, str, str]
"""Fault of a quantity, unit that repairs it ("" if none does), and another action that does."""


def _check_times(table: FootTable) -> dict[str, Fault]:
    if len(table) <= 2:
        return {}
    intervals = np.diff(table.t)
    interval = float(np.median(intervals))
    if MIN_INTERVAL <= interval <= MAX_INTERVAL:
        return {}
    raw = interval / UNITS["t"][table.units.get("t", "s")]
    low, high = USUAL_INTERVAL
    fitting = [unit for unit, factor in UNITS["t"].items() if unit != DATETIME and low <= raw * factor <= high]
    is_count = raw == 1.0 and bool(np.all(intervals == intervals[0]))
    action = f" or, for sample numbers, {table.mapping.write_setting('rate', 'HZ')}" if is_count else ""
    what = f"the median time between samples is {interval:.3g} s: {_explain_times(table.t, interval)}"
    return {"t": (what, fitting[0] if fitting else "", action)}


def _check_acc(table: FootTable) -> dict[str, Fault]:
    if "acc" not in table.columns:
        return {}
    lengths = _vector_lengths(table.columns["acc"])
    median = float(np.median(lengths))
    low, high = MEDIAN_ACC_RANGE
    if low <= median <= high:
        return {}
    kind, unit, action = _explain_acc(table, lengths)
    what = f"the median of |acc| is {median:.3g} m/s^2, not 9.8: this looks like {kind}"
    return {"acc": (what, unit, action)}


def _check_gyro(table: FootTable) -> dict[str, Fault]:
    if "gyro" not in table.columns:
        return {}
    top = float(np.percentile(_vector_lengths(table.columns["gyro"]), 99.0, method="higher"))
    if top <= MAX_GYRO:
        return {}
    is_degrees = top < MAX_DEGREES
    unit = "deg/s" if is_degrees else "thousandths of a degree a second, or raw counts"
    what = f"|gyro| reaches {top:.3g} rad/s, faster than a foot turns: this looks like {unit}"
    return {"gyro": (what, "deg/s" if is_degrees else "mdeg/s", "")}


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


def _explain_acc(table: FootTable, lengths: Floats) -> Fault:
    """Return what specific force looks like whose median cannot be right, and what repairs it."""
    rest = float(np.median(lengths))
    if "gyro" in table.columns:
        rates = _vector_lengths(table.columns["gyro"])
        rest = float(np.median(lengths[rates <= np.quantile(rates, SHARE_AT_REST)]))
    raw = rest / UNITS["acc"][table.units.get("acc", "m/s^2")]
    for unit, factor in UNITS["acc"].items():
        if abs(raw * factor - GRAVITY) < NEAR * GRAVITY:
            return {"mg": "milli-g"}.get(unit, unit), unit, ""
    if rest < NO_GRAVITY:
        text = "no specific force at all (gravity removed?)"
        return text, "", "give the columns that the accelerometer measured, with gravity"
    return "raw counts" if rest > GRAVITY else "another unit, or gravity removed", "", ""


def _vector_lengths(vectors: Floats) -> Floats:
    with np.errstate(over="ignore"):  # an infinite length fails the checks as well
        return np.asarray(np.sqrt(np.sum(vectors * vectors, axis=1)), dtype=np.float64)
