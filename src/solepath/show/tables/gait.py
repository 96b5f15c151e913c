"""Makes the rows of the gait parameters, with names, units and digits, and their table in plain text.

The tables of the terminal, the page and the report all use these rows."""

from __future__ import annotations

from math import degrees

from attrs import frozen

from ...body.gait.means import Figure, GaitMeans, GaitParameters
from ...types import Foot
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
    sd: float | None
    cv: float | None
    asymmetry: float | None
    difference: float | None

    def cells(self, separator: str) -> list[str]:
        """Return the cells of a table: left, right, mean `separator` SD of both, CV in %, asymmetry."""
        both = number(self.both, self.digits) + (
            "" if self.sd is None else f"{separator} {number(self.sd, self.digits)}"
        )
        feet = [number(value, self.digits) for value in (self.left, self.right)]
        return [*feet, both, percent(self.cv), self.asymmetry_text]

    @property
    def asymmetry_text(self) -> str:
        """Asymmetry as a table shows it, with its unit."""
        if self.difference is not None:
            return f"{self.difference:+.{self.digits}f} {self.unit}"
        return "-" if self.asymmetry is None else f"{100.0 * self.asymmetry:+.1f} %"


def gait_rows(parameters: GaitParameters) -> list[GaitRow]:
    """Return a row for each parameter that was measured, in the order of the table."""
    feet = [parameters.feet.get(foot) for foot in Foot]
    rows = []
    for name, label, unit, digits, scale in PARAMETERS:
        figure: Figure | None = getattr(parameters.both, name)
        if figure is None:
            continue
        figures: list[Figure | None] = [None if one is None else getattr(one, name) for one in feet]
        left, right = [None if one is None else scale * one.mean for one in figures]
        both = sd = difference = None
        if left is not None and right is not None:
            both = scale * figure.mean
            sd = None if figure.sd is None else scale * figure.sd
            difference = right - left if unit == DEGREE_UNIT else None
        cv, asymmetry = (None, None) if unit == DEGREE_UNIT else (figure.cv, parameters.asymmetry(name))
        rows.append(GaitRow(name, label, unit, digits, left, right, both, sd, cv, asymmetry, difference))
    for name, label in SHARES:
        share = parameters.both.share(name)
        if share is not None:
            shares = [None if one is None else one.share(name) for one in feet]
            left, right = [None if one is None else 100.0 * one for one in shares]
            both = None if left is None or right is None else 100.0 * share
            # a double support below zero is a flight phase; relative to a mean below zero the sign would be wrong
            has_no_asymmetry = left is None or right is None or min(left, right) <= 0.0
            asymmetry = None if has_no_asymmetry else parameters.asymmetry(name)
            rows.append(GaitRow(name, label, "%", 1, left, right, both, None, None, asymmetry, None))
    return rows


def strides_of(parameters: GaitParameters, foot: Foot) -> int | None:
    """Return the number of a foot's strides in the means; None when it took none."""
    figures = parameters.feet.get(foot)
    return None if figures is None or figures.stride_time is None else figures.stride_time.strides


def gait_lines(means: GaitMeans) -> list[str]:
    """Return the lines of a table for walking and one for running, each with a blank line after it.

    A table without steady strides is left out."""
    lines: list[str] = []
    for running in (False, True):
        parameters = means.of(running)
        if parameters is not None:
            lines += [*_table(parameters), ""]
    return lines


def _table(parameters: GaitParameters) -> list[str]:
    what = "running" if parameters.running else "walking"
    header = [f"{what}, steady strides", "left", "right", "both +- SD", "CV %", "asymmetry"]
    strides = [number(strides_of(parameters, foot), 0) for foot in Foot]
    rows = [["strides", *strides, "-", "-", "-"]]
    rows.append(["cadence steps/min", "-", "-", number(parameters.cadence, 1), "-", "-"])
    for row in gait_rows(parameters):
        rows.append([f"{row.label} {row.unit}", *row.cells(" +-")])
    lines = table(header, rows).splitlines()
    if parameters.coordination is not None:
        lines.append(f"phase coordination index {percent(parameters.coordination)} %")
    return lines
