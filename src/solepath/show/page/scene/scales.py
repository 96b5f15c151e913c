"""Ends of the colour scales of pressure, decided here so that all watchers see the same colours.

A scale is for both feet, ends at a round number, and only ever grows. Its end is at least what a twentieth of a foot's
cells reaches for three samples. An edge of a shoe that presses on one cell, or on all for a hundredth of a second,
therefore does not make the load of a whole forefoot pale. A higher value is drawn as the end of the scale, and `beyond`
says that there is one."""

from __future__ import annotations

from math import floor, inf, log10
from typing import Any

from attrs import define, field

from ....types import Foot, Layout
from ..messages import rounded

STEPS = (1.0, 2.0, 4.0, 6.0, 8.0, 10.0)
"""Multiples of a power of ten at which a scale may end."""
LEAST = {"kPa": 100.0, "N": 1.0, "counts": 1.0}
"""First end of a scale in each unit: the pressure of standing on both feet in kPa, no load in N and counts."""
SHARE = 20
"""Number of cells of which one may be higher than the scale; a smaller insole may have one such cell too."""
LASTS = 3
"""Number of samples for which a value must last."""


@define
class UnitScale:
    """Scale of one unit."""

    top: float
    highest: float = 0.0
    """Highest value of any cell so far."""

    def frame(self) -> dict[str, Any]:
        """Return one member of "scales" of a frame."""
        return {"top": rounded(self.top), "beyond": self.highest > self.top}


@define
class InsoleScale:
    """Unit of the cells of a foot's insole, and their recent values."""

    unit: str
    per_unit: tuple[float, ...] | None
    """Value in `unit` of one of the layout's unit, for each cell; None where the units are the same."""
    recent: tuple[float, ...] = ()
    """Value that a twentieth of the cells reached in each of the newest samples."""


@define
class Scales:
    """Scales of all units that are in use, by their names."""

    units: dict[str, UnitScale] = field(factory=dict)
    worn: dict[Foot, InsoleScale] = field(factory=dict)

    def wear(self, foot: Foot, layout: Layout, newtons: bool) -> None:
        """Set the layout of a foot's cells; `newtons` says that their values are N, not counts."""
        areas = [cell.area for cell in layout.cells]
        per_unit = None
        if newtons and areas and all([area > 0.0 for area in areas]):
            unit, per_unit = "kPa", tuple([0.001 / area for area in areas])
        else:
            unit = "N" if newtons else "counts"
        self.worn[foot] = InsoleScale(unit, per_unit)
        self.units.setdefault(unit, UnitScale(LEAST[unit]))

    def press(self, foot: Foot, values: tuple[float, ...]) -> None:
        """Add one sample of a foot's cells; before its layout is known, none, since no map is drawn without it."""
        worn = self.worn.get(foot)
        if worn is None or not values:
            return
        if worn.per_unit is not None:
            values = tuple([value * one for value, one in zip(values, worn.per_unit, strict=False)])
        scale = self.units[worn.unit]
        largest = max(values, default=0.0)
        if scale.highest < largest < inf:
            scale.highest = largest
        if not largest > scale.top:
            worn.recent = ()
            return
        at = min(max(1, len(values) // SHARE), len(values) - 1)
        worn.recent = (*worn.recent[1 - LASTS :], sorted(values, reverse=True)[at])
        reached = min(worn.recent)
        if len(worn.recent) == LASTS and scale.top < reached < inf:
            scale.top = scale_end(reached)

    def frame(self) -> dict[str, Any]:
        """Return the member "scales" of a frame."""
        return {unit: scale.frame() for unit, scale in self.units.items()}


def scale_end(value: float) -> float:
    """Return the end of a scale that holds `value`, which is above zero."""
    power: float = 10.0 ** floor(log10(value))
    return next((step * power for step in STEPS if step * power >= value), 10.0 * power)
