"""Makes the rows of the gait parameters, with names, units and digits, and their table in plain text.

The tables of the terminal, the page and the report all use these rows."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from math import degrees

from attrs import evolve, frozen

from ...body.gait.means import Figure, GaitParameters, StrideFigures
from ...events import GaitCycleMeasured
from ...types import Foot
from ...walk.walk import Walk
from .table import number, percent, table

DEGREE_UNIT = "deg"
MIN_STRIDES = 30
"""Number of strides, of both feet together, below which standard deviation and coefficient of variation (CV) mean
little (Galna et al. 2013); body/gait/means.py uses the same number."""
PARAMETERS: tuple[tuple[str, str, str, int, float], ...] = (
    ("stride_time", "stride time", "s", 3, 1.0),
    ("step_time", "step time", "s", 3, 1.0),
    ("stride_length", "stride length", "m", 3, 1.0),
    ("speed", "speed", "m/s", 2, 1.0),
    ("clearance", "rise of the sensor", "m", 3, 1.0),
    ("toe_off_angle", "toe-off angle", DEGREE_UNIT, 1, degrees(1.0)),
    ("heel_strike_angle", "heel-strike angle", DEGREE_UNIT, 1, degrees(1.0)),
)
"""Field of StrideFigures, its label, unit in tables, digits after the point, and factor from the SI unit."""
SHARES = (
    ("stance_time", "stance"),
    ("single_support", "single support"),
    ("initial_double_support", "initial double support"),
    ("terminal_double_support", "terminal double support"),
)
"""Times that are shown as a share of the stride time, in percent with one digit."""


@frozen
class GaitRow:
    """The row of one gait parameter, from steady strides.

    `left`, `right`, `both` and `sd` (standard deviation) are in `unit`, and None where they are not known. A share of
    the stride time has no `sd` and no `cv`. When only one foot is known, `both` and `sd` are None, and `cv` is that
    foot's. `cv` and `asymmetry` are shares (0.05 is 5 %), as in Figure and GaitParameters.

    An angle has a `difference`, right - left in `unit`, instead of `cv` and `asymmetry`: angles are measured against
    the flat sole, and a mean near zero, or with another sign in each foot, has no meaningful shares."""

    name: str
    label: str
    unit: str
    digits: int
    left: float | None
    right: float | None
    both: float | None
    sd: float | None = None
    cv: float | None = None
    asymmetry: float | None = None
    difference: float | None = None

    def cells(self, separator: str) -> list[str]:
        """Return the cells of a table: left, right, mean `separator` SD of both, CV in %, asymmetry."""
        left, right, both, sd = [number(one, self.digits) for one in (self.left, self.right, self.both, self.sd)]
        spread = "" if self.sd is None else f"{separator} {sd}"
        return [left, right, both + spread, percent(self.cv), self.asymmetry_text]

    @property
    def asymmetry_text(self) -> str:
        """Asymmetry as a table shows it, with its unit."""
        if self.difference is not None:
            return f"{self.difference:+.{self.digits}f} {self.unit}"
        return "-" if self.asymmetry is None else f"{100.0 * self.asymmetry:+.1f} %"


def gait_rows(parameters: GaitParameters) -> list[GaitRow]:
    """Return a row for each parameter that was measured, in the order of the table."""
    columns = [*[parameters.feet.get(foot, StrideFigures()) for foot in Foot], parameters.both]
    rows = []
    for name, label, unit, digits, scale in PARAMETERS:
        figures: list[Figure | None] = [getattr(column, name) for column in columns]
        if (figure := figures[-1]) is None:
            continue
        left, right, both = [None if one is None else scale * one.mean for one in figures]
        sd, cv, asymmetry, difference = figure.sd and scale * figure.sd, figure.cv, parameters.asymmetry(name), None
        if left is None or right is None:
            both = sd = None
        elif unit == DEGREE_UNIT:
            difference = right - left
        if unit == DEGREE_UNIT:
            cv = asymmetry = None
        rows.append(GaitRow(name, label, unit, digits, left, right, both, sd, cv, asymmetry, difference))
    for name, label in SHARES:
        left, right, both = [share and 100.0 * share for share in [column.share(name) for column in columns]]
        if both is None:
            continue
        asymmetry = None
        if left is None or right is None:
            both = None
        elif min(left, right) > 0.0:  # relative to a flight, a double support below zero, the sign would be wrong
            asymmetry = parameters.asymmetry(name)
        rows.append(GaitRow(name, label, "%", 1, left, right, both, asymmetry=asymmetry))
    return rows


def strides_of(parameters: GaitParameters, foot: Foot) -> int | None:
    """Return the number of a foot's strides in the means; None when it took none."""
    time = parameters.feet.get(foot, StrideFigures()).stride_time
    return None if time is None else time.strides


def sure_rows(
    parameters: GaitParameters, cycles: Iterable[GaitCycleMeasured], without: Collection[str] = ()
) -> tuple[list[GaitRow], list[str]]:
    """Return the rows without variations and asymmetries whose intervals say nothing, and sentences that name these.

    Rows of the names `without` are left out. `cycles` are those of the means. Of the difference of an angle only the
    number of strides counts."""
    from ..outcomes.spread import LEFT_OUT, asymmetry, variability

    known, running = list(cycles), parameters.running
    rows = [row for row in gait_rows(parameters) if row.name not in without]
    few = asymmetry(known, "stride_time", running=running) is None
    unsure: list[tuple[str, GaitRow]] = []
    for row in rows:
        spread = None if row.cv is None else variability(known, row.name, running=running)
        index = None if row.asymmetry is None else asymmetry(known, row.name, running=running)
        if row.cv is not None and (spread is None or spread.is_vague):
            unsure.append(("CV", row))
        if few and row.difference is not None or row.asymmetry is not None and (index is None or index.is_vague):
            unsure.append(("asymmetry", row))
    clauses = []
    for kind, shown in (("CV", [row for row in rows if row.cv is not None]), ("asymmetry", _compared(rows))):
        found = [row.label for name, row in unsure if name == kind]
        clauses += [f"every {kind}" if len(found) == len(shown) else f"{kind} of {', '.join(found)}"] if found else []
    vague = [(kind, row.name) for kind, row in unsure]
    rows = [evolve(row, cv=None) if ("CV", row.name) in vague else row for row in rows]
    rows = [evolve(row, asymmetry=None, difference=None) if ("asymmetry", row.name) in vague else row for row in rows]
    return rows, [LEFT_OUT.format("; ".join(clauses))] if clauses else []


def _compared(rows: Iterable[GaitRow]) -> list[GaitRow]:
    """Return the rows that compare the feet."""
    return [row for row in rows if row.asymmetry is not None or row.difference is not None]


def gait_cells(parameters: GaitParameters, separator: str, rows: Iterable[GaitRow]) -> list[list[str]]:
    """Return the cells of these rows of the table of both feet, with a separator before the standard deviation."""
    columns = [parameters.feet.get(foot, StrideFigures()) for foot in Foot]
    columns.append(parameters.both if len(parameters.feet) == len(Foot) else StrideFigures())
    times = [column.stride_time for column in columns]
    cadences = [None if time is None else 120.0 / time.mean for time in times]
    return [
        ["gait cycles", *[number(strides_of(parameters, foot), 0) for foot in Foot], "-", "-", "-"],
        ["cadence, steps/min", *[number(cadence, 1) for cadence in cadences], "-", "-"],
        *[[f"{row.label}, {row.unit}", *row.cells(separator)] for row in rows],
    ]


def gait_lines(walk: Walk) -> list[str]:
    """Return the lines of a table for walking and one for running, each with a blank line after it.

    A table without steady strides is left out."""
    lines: list[str] = []
    for parameters in filter(None, [walk.gait.of(False), walk.gait.of(True)]):
        what = "running" if parameters.running else "walking"
        known, left_out = sure_rows(parameters, walk.newest_cycles)
        rows = [[name.replace(",", ""), *cells] for name, *cells in gait_cells(parameters, " +-", known)]
        lines.append(table([f"{what}, steady strides", "left", "right", "both +- SD", "CV %", "asymmetry"], rows))
        if parameters.coordination is not None:
            lines.append(f"phase coordination index {percent(parameters.coordination)} %")
        lines += [*left_out, ""]
    return lines
