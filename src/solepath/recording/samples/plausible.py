"""Search of a table for numbers that are certainly not in SI units, each with what repairs it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise
from math import ceil, fsum, radians
from statistics import median

from attrs import evolve, frozen

from ..errors import UnusableValues, printable
from ..mapping.units import DATETIME, GRAVITY, UNITS
from .table import FootTable

ACC_RANGE = (3.0, 30.0)
"""Allowed range of |acc| at rest, m/s^2, or of its median where a foot never rests: runners have up to 29."""
REST_ROWS = 50
"""Number of samples of a foot at rest: half a second at 100 Hz, longer than a runner's stance."""
REST_SPREAD = 0.1
"""Largest range of |acc| of a foot at rest, as a share: consumer sensors have noise of 1 % and less."""
MAX_ROWS = 20_000
"""Number of samples that are examined."""
TOP = 0.99
"""Share of the angular rates that a limit holds for: a knock may be faster."""
MAX_GYRO = 40.0
"""Largest allowed 99th percentile of |gyro|, rad/s.

Running feet reach 17 rad/s, and most sensors end at 2000 degrees/s, which is 35 rad/s."""
LEAST_GYRO = radians(MAX_GYRO)
"""Smallest 99th percentile of |gyro| with which a unit is offered, rad/s: slow walkers reach three times as much."""
LEAST_COUNT, MAX_COUNT = 12.0, 57_000.0
"""Range of raw values, counts: 16 per g are the fewest that sensors have; three numbers of 16 bits are the most."""
NEAR_NOMINAL = 0.05
"""Largest relative difference from a power of two with which that is the scale of an accelerometer."""
RAW = "raw counts, of which the data sheet says how many are 1 g, and 1 degree/s (16.4 and 131 are usual)"
SENSORS = {"acc": "accelerometer", "gyro": "gyroscope", "t": "clock"}
"""Words for the sensors of quantities."""
MAX_INTERVAL, MIN_INTERVAL = 0.5, 2e-4
"""Allowed range of the median time between samples, s; outside it the unit of time is not s."""
USUAL_INTERVAL = (1e-3, 0.2)
"""Range of the median time between samples for which a unit of time is offered, s: sensors have 5 to 1000 Hz."""
SHARE_AT_REST = 0.2
"""Share of the samples, those with the lowest angular rate, that count as a foot at rest; a walker stands on a foot for
40 % of the time or more."""
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
    scale: str = ""
    """Counts per unit that repair raw values; COUNTS if the numbers do not tell them, "" for other values."""
    action: str = ""
    """Another action that does."""
    is_count: bool = False
    """Flag: these are numbers of samples, not times."""


def find_wrong_units(table: FootTable) -> Iterator[WrongUnit]:
    """Yield each quantity whose unit is certainly not SI; a wrong unit can give a plausible track.

    A unit is offered if the numbers are right with it."""
    interval = table.pace
    if len(table) > 2 and not MIN_INTERVAL <= interval <= MAX_INTERVAL:
        raw = interval / table.factor("t")
        is_count = raw == 1.0 and len({b - a for a, b in pairwise(table.t)}) == 1
        action = f" or, for sample numbers, {table.mapping.write_rate('HZ')}" if is_count else ""
        looks = "this looks like milliseconds or sample numbers" if interval > MAX_INTERVAL else "these are not seconds"
        low, high = USUAL_INTERVAL
        fitting = [one for one, factor in UNITS["t"].items() if one != DATETIME and low <= raw * factor <= high]
        what = f"the median time between samples is {interval:.3g} s: {looks}"
        yield WrongUnit("t", what, fitting[0] if fitting else "", action=action, is_count=is_count)
    forces, rates = table.lengths("acc"), table.lengths("gyro")
    rest = _force_at_rest(table, forces)
    judged = median(forces or [GRAVITY]) if rest is None else rest
    is_raw = False
    if not ACC_RANGE[0] <= judged <= ACC_RANGE[1]:
        wrong = _explain_acc(table, _force_of_slow(forces, rates) if rest is None else rest)
        is_raw = bool(wrong.scale)
        of = "the median of |acc|" if rest is None else "|acc| at rest"
        yield evolve(wrong, what=f"{of} is {judged:.3g} m/s^2, not 9.8: this looks like {wrong.what}")
    top = sorted(rates)[ceil(TOP * (len(rates) - 1))] if rates else 0.0
    if top > MAX_GYRO:
        raw = top / table.factor("gyro")
        fitting = [unit for unit, factor in UNITS["gyro"].items() if LEAST_GYRO <= raw * factor <= MAX_GYRO]
        unit = "" if not fitting or (is_raw and _is_whole(table, "gyro")) else fitting[0]
        scale = "COUNTS" if not unit and raw <= MAX_COUNT else ""
        kind = {"mdeg/s": "thousandths of a degree a second"}.get(unit, unit) if unit else RAW if scale else "no unit"
        what = f"|gyro| reaches {top:.3g} rad/s, faster than a foot turns: this looks like {kind}"
        yield WrongUnit("gyro", what, unit, scale)


def list_unit_problems(tables: Sequence[FootTable]) -> tuple[list[UnusableValues], list[str]]:
    """Return an error for each quantity whose unit is certainly not SI, with what repairs it; and what was left out.

    A sensor whose numbers are wrong while those of the other foot are right is broken, for a unit is that of both: it
    is left out of its table, with a sentence. One that is stuck stays: the session says what is wrong with it."""
    wrong = [list(find_wrong_units(table)) for table in tables]
    right = {
        quantity
        for table, found in zip(tables, wrong, strict=True)
        for quantity in set(table.columns) - {one.quantity for one in found}
    }
    problems: list[UnusableValues] = []
    left_out: list[str] = []
    for table, found in zip(tables, wrong, strict=True):
        units = {one.quantity: one.unit for one in found if one.unit}
        scales = {one.quantity: one.scale for one in found if one.scale}
        for one in found:
            if one.quantity in right:
                if not _is_stuck(table, one.quantity):
                    left_out.append(_leave_out(table, one))
                continue
            repair = table.mapping.write_units(one.quantity, units) if one.unit else ""
            repair += table.mapping.write_scale(scales) if one.scale else ""
            problems.append(UnusableValues(table.path, one.what, table.names[one.quantity], repair + one.action))
    return problems, left_out


def _leave_out(table: FootTable, one: WrongUnit) -> str:
    """Remove the values of a broken sensor, with the angular rates beside a broken accelerometer; return a sentence."""
    fault = one.what.partition(": this looks like")[0]
    for quantity in ("acc", "gyro") if one.quantity == "acc" else (one.quantity,):
        table.columns.pop(quantity, None)
    name, where = SENSORS[one.quantity], printable(str(table.path))
    return f"{where}: {table.foot.value} foot: {fault}, and the other foot is right: its {name} is broken, and left out"


def _is_stuck(table: FootTable, quantity: str) -> bool:
    """Return whether most values of a quantity are exactly those of the sample before, of a second and more."""
    rows = zip(*table.columns[quantity], strict=True)
    repeats = sum([before == after for before, after in pairwise(rows)])
    return len(table) >= LEAST_STUCK and repeats > STUCK_SHARE * len(table)


def _force_at_rest(table: FootTable, forces: Sequence[float]) -> float | None:
    """Return the specific force of the first part in which nothing moves, in the unit of the table; None without one.

    Values that do not even have noise are those of a sensor that is stuck, not of one at rest."""
    for start in range(0, min(len(forces), MAX_ROWS) - REST_ROWS + 1, REST_ROWS):
        part = forces[start : start + REST_ROWS]
        middle = fsum(part) / REST_ROWS
        if min(part) < max(part) and max(part) - min(part) < REST_SPREAD * middle:
            return middle
    return None


def _force_of_slow(forces: Sequence[float], rates: Sequence[float]) -> float:
    """Return the median specific force of the samples with the lowest angular rate."""
    if rates:
        limit = sorted(rates)[ceil(SHARE_AT_REST * (len(rates) - 1))]
        forces = [force for force, rate in zip(forces, rates, strict=True) if rate <= limit]
    return median(forces)


def _explain_acc(table: FootTable, rest: float) -> WrongUnit:
    """Return what specific force looks like that is `rest`, m/s^2, of a foot at rest, and what repairs it."""
    raw = rest / table.factor("acc")
    for unit, factor in UNITS["acc"].items():
        if abs(raw * factor - GRAVITY) < NEAR * GRAVITY:
            return WrongUnit("acc", {"mg": "milli-g"}.get(unit, unit), unit)
    if rest < NO_GRAVITY:
        text = "no specific force at all (gravity removed?)"
        return WrongUnit("acc", text, action="give the columns that the accelerometer measured, with gravity")
    if LEAST_COUNT <= raw <= MAX_COUNT and _is_whole(table, "acc"):
        nominal = min([2.0**k for k in range(4, 16)], key=lambda one: abs(raw - one))
        scale = nominal if abs(raw - nominal) < NEAR_NOMINAL * nominal else raw
        return WrongUnit("acc", RAW, scale=f"{scale:.4g}" if scale != nominal else f"{scale:.0f}")
    return WrongUnit("acc", "raw counts" if rest > GRAVITY else "another unit, or gravity removed")


def _is_whole(table: FootTable, quantity: str) -> bool:
    """Return whether all values are whole numbers in the file, as counts are."""
    factor = table.factor(quantity)
    values = [value / factor for column in table.columns[quantity] for value in column[:MAX_ROWS]]
    return all(abs(value - round(value)) < 1e-6 * max(1.0, abs(value)) for value in values)
