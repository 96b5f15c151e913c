"""Search of a table for numbers that are certainly not in SI units, each with what repairs it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise
from math import ceil
from statistics import median

from attrs import frozen

from ..errors import UnusableValues
from ..mapping.units import DATETIME, GRAVITY, UNITS
from .table import FootTable

MEDIAN_ACC_RANGE = (3.0, 30.0)
"""Allowed range of the median |acc| of a foot, m/s^2; standing, walking and running have 9.4 to 20."""
TOP = 0.99
"""Share of the angular rates that a limit holds for: a knock may be faster."""
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
STUCK_SHARE = 0.5
"""Share of the samples from which on repeated values are those of a sensor that is stuck: one that measures at half the
rate of its samples repeats every other one."""
LEAST_STUCK = 100
"""Least number of samples of a sensor that is stuck."""
NO_GRAVITY = 0.3
"""Specific force at rest below which gravity was removed, m/s^2 or g: nothing else is so small in any unit."""


@frozen
class WrongUnit:
    """A quantity whose numbers are certainly not SI."""

    quantity: str
    what: str
    """Sentence on its numbers."""
    unit: str = ""
    """Unit that repairs it; "" if none does."""
    action: str = ""
    """Another action that does."""
    is_count: bool = False
    """Flag: these are numbers of samples, not times."""


def find_wrong_units(table: FootTable) -> Iterator[WrongUnit]:
    """Yield each quantity whose unit is certainly not SI; a wrong unit can give a plausible track."""
    interval = table.interval
    if len(table) > 2 and not MIN_INTERVAL <= interval <= MAX_INTERVAL:
        raw = interval / UNITS["t"][table.units.get("t", "s")]
        is_count = raw == 1.0 and len({b - a for a, b in pairwise(table.t)}) == 1
        action = f" or, for sample numbers, {table.mapping.write_setting('rate', 'HZ')}" if is_count else ""
        what = f"the median time between samples is {interval:.3g} s: {_explain_times(table.t, interval)}"
        low, high = USUAL_INTERVAL
        fitting = [one for one, factor in UNITS["t"].items() if one != DATETIME and low <= raw * factor <= high]
        yield WrongUnit("t", what, fitting[0] if fitting else "", action, is_count)
    forces, rates = table.lengths("acc"), table.lengths("gyro")
    middle = median(forces or [GRAVITY])
    if not MEDIAN_ACC_RANGE[0] <= middle <= MEDIAN_ACC_RANGE[1]:
        kind, unit, action = _explain_acc(forces, rates, UNITS["acc"][table.units["acc"]])
        what = f"the median of |acc| is {middle:.3g} m/s^2, not 9.8: this looks like {kind}"
        yield WrongUnit("acc", what, unit, action)
    top = sorted(rates)[ceil(TOP * (len(rates) - 1))] if rates else 0.0
    if top > MAX_GYRO:
        is_degrees = top < MAX_DEGREES
        kind = "deg/s" if is_degrees else "thousandths of a degree a second, or raw counts"
        what = f"|gyro| reaches {top:.3g} rad/s, faster than a foot turns: this looks like {kind}"
        yield WrongUnit("gyro", what, "deg/s" if is_degrees else "mdeg/s")


def list_unit_problems(tables: Sequence[FootTable]) -> list[UnusableValues]:
    """Return an error for each quantity of a foot whose unit is certainly not SI, with what repairs it.

    A sensor that is stuck is no error if that of the other foot is right: the session says what is wrong with it."""
    wrong = [list(find_wrong_units(table)) for table in tables]
    right = {
        quantity
        for table, found in zip(tables, wrong, strict=True)
        for quantity in set(table.columns) - {one.quantity for one in found}
    }
    problems: list[UnusableValues] = []
    for table, found in zip(tables, wrong, strict=True):
        units = {one.quantity: one.unit for one in found if one.unit}
        problems += [
            UnusableValues(
                table.path,
                one.what,
                table.names[one.quantity],
                (table.mapping.write_units(one.quantity, units) if one.unit else "") + one.action,
            )
            for one in found
            if one.quantity not in right or not _is_stuck(table, one.quantity)
        ]
    return problems


def _is_stuck(table: FootTable, quantity: str) -> bool:
    """Return whether most values of a quantity are exactly those of the sample before, of a second and more."""
    rows = zip(*table.columns[quantity], strict=True)
    repeats = sum([before == after for before, after in pairwise(rows)])
    return len(table) >= LEAST_STUCK and repeats > STUCK_SHARE * len(table)


def _explain_times(t: Sequence[float], middle: float) -> str:
    """Return what times, s, look like whose intervals have a median that cannot be right, s."""
    if middle > MAX_INTERVAL:
        return "this looks like milliseconds or sample numbers"
    starts = [row for row, (a, b) in enumerate(pairwise(t), 1) if b - a >= MIN_INTERVAL]
    repeats = "times repeat" if middle == 0.0 else ""
    if starts:
        count, span = starts[-1], t[starts[-1]] - t[0]
        if MIN_INTERVAL <= span / count <= MAX_INTERVAL:
            return (
                f"{repeats and f'{repeats}: '}samples come in bursts of about {count / len(starts):.0f},"
                f" one burst each {span / len(starts):.3g} s, as with the time at which their packet came; give each"
                f" sample its own time, about {span / count:.3g} s after the one before"
            )
    return repeats or "these are not seconds"


def _explain_acc(forces: Sequence[float], rates: Sequence[float], stated: float) -> tuple[str, str, str]:
    """Return what specific force looks like whose median cannot be right, the unit that repairs it, or an action.

    `stated`: value of the unit that the file says, m/s^2."""
    if rates:
        limit = sorted(rates)[ceil(SHARE_AT_REST * (len(rates) - 1))]
        forces = [force for force, rate in zip(forces, rates, strict=True) if rate <= limit]
    rest = median(forces)
    for unit, factor in UNITS["acc"].items():
        if abs(rest / stated * factor - GRAVITY) < NEAR * GRAVITY:
            return {"mg": "milli-g"}.get(unit, unit), unit, ""
    if rest < NO_GRAVITY:
        text = "no specific force at all (gravity removed?)"
        return text, "", "give the columns that the accelerometer measured, with gravity"
    return "raw counts" if rest > GRAVITY else "another unit, or gravity removed", "", ""
