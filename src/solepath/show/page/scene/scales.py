"""Where the colours of pressure end: decided here, so that everybody who watches sees the same colours.

A scale is for both feet, ends at a round number, and only ever grows. It holds what a twentieth of a foot's cells shows
for three samples: an edge of a shoe that presses on one cell, or on all for a hundredth of a second, does not make pale
what a whole forefoot carries. What is higher is drawn as the end of the scale, and `beyond` says that there is such.
"""

from __future__ import annotations

from math import floor, inf, log10
from typing import Any

from attrs import define, field

from ....types import Foot, Layout
from ..messages import rounded

STEPS = (1.0, 2.0, 4.0, 6.0, 8.0, 10.0)
"""Times a power of ten: where a scale may end."""
LEAST = {"kPa": 100.0, "N": 1.0, "counts": 1.0}
"""Where it ends at first: of somebody who stands on both feet, and of one who does nothing."""
SHARE = 20
"""One cell of so many may be higher, and one of fewer."""
LASTS = 3
"""Samples."""


@define
class UnitScale:
    """Of one unit."""

    top: float
    highest: float = 0.0
    """Of any cell so far."""

    def frame(self) -> dict[str, Any]:
        """As one of "scales" of a frame."""
        return {"top": rounded(self.top), "beyond": self.highest > self.top}


@define
class InsoleScale:
    """The insole of a foot: in which unit its cells are drawn, and what it was of late."""

    unit: str
    per_unit: tuple[float, ...] | None
    """What one of the layout's unit is in `unit`, of each cell; None where it is the same."""
    recent: tuple[float, ...] = ()
    """What a twentieth of its cells reached, in the newest samples."""


@define
class Scales:
    """Of all units that are worn, by their names."""

    units: dict[str, UnitScale] = field(factory=dict)
    worn: dict[Foot, InsoleScale] = field(factory=dict)

    def wear(self, foot: Foot, layout: Layout, newtons: bool) -> None:
        """This foot's cells are so. `newtons`: its values are N, not counts."""
        areas = [cell.area for cell in layout.cells]
        per_unit = None
        if newtons and areas and all([area > 0.0 for area in areas]):
            unit, per_unit = "kPa", tuple([0.001 / area for area in areas])
        else:
            unit = "N" if newtons else "counts"
        self.worn[foot] = InsoleScale(unit, per_unit)
        self.units.setdefault(unit, UnitScale(LEAST[unit]))

    def press(self, foot: Foot, values: tuple[float, ...]) -> None:
        """One sample of its cells. Nothing before they are worn: who does not know where cells are draws no map."""
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
        """As "scales" of a frame."""
        return {unit: scale.frame() for unit, scale in self.units.items()}


def scale_end(value: float) -> float:
    """The end of a scale that holds `value`, above zero."""
    power: float = 10.0 ** floor(log10(value))
    return next((step * power for step in STEPS if step * power >= value), 10.0 * power)
