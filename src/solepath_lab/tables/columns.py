"""How figures are shown: columns.csv has a title, unit, digits, better direction and words by the name in JSON.

`nees`, `held` and `heading_nees` are defined in emulated/heading.py, `drift` in measures/drift.py.

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
    words: str
    """What it is."""

    def show(self, value: float | None) -> str:
        """Return a value in SI units as text; a dash for None."""
        return shown(value, self.unit, self.digits)


FIGURES = {
    row["name"]: Figure(row["title"], row["unit"], int(row["digits"]), row["better"], row["words"])
    for row in read_rows(__file__, "columns.csv")
}
"""Figures by name in JSON."""
