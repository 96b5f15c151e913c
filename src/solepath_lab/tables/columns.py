"""How figures are shown: columns.csv has a column's title, its unit, digits and better direction by the name in JSON.

ARMSE2d is the RMS 2D error / sqrt 2. `relative` is the error (RMS 2D, mean or end error) as a share of the path length.
`end_error` is the distance between the ends of a closed loop, `position_end` that from the estimated to the true end.
`authors` is the mean error of the system of the data set's authors. `stride_error_track` is the mean stride length
error by the live positions. `nees`, `held` and `heading_nees` are defined in emulated/heading.py, `drift` in
measures/drift.py. `off` is the median magnitude of the offsets. `uturn_invented` is a number a recording.

Errors, spreads and numbers of invented events should be small. Biases should be near zero. F1 and shares found should
be large. Numbers of true events, path lengths and other people's results have no better direction."""

from __future__ import annotations

from math import degrees

from attrs import frozen

from solepath.show.tables.table import number

from ..descriptions import read_rows

SCALES = {"": 1.0, "m": 1.0, "%": 100.0, "ms": 1000.0, "degrees": degrees(1.0), "degrees/min": degrees(60.0)}
"""Factor from SI units, and from shares, to each unit."""


def shown(value: float | None, unit: str, digits: int) -> str:
    """Return a value in SI units as a number of this unit; a dash for None."""
    return number(None if value is None else SCALES[unit] * value, digits)


@frozen
class Figure:
    """How one figure is shown."""

    title: str
    """Title of its column."""
    unit: str
    digits: int
    better: str
    """Direction in which the figure is better: "less", "more", "nearer to zero", or none."""

    def show(self, value: float | None) -> str:
        """Return a value in SI units as text; a dash for None."""
        return shown(value, self.unit, self.digits)


FIGURES = {
    row["name"]: Figure(row["title"], row["unit"], int(row["digits"]), row["better"])
    for row in read_rows(__file__, "columns.csv")
}
"""Figures by name in JSON."""
