"""Chooses the ends of the colour scales of pressure, once for all watchers, so that all see the same colours.

A scale is for both feet, ends at a round number, and only ever grows. While a foot is on the ground, each cell has its
highest pressure of that stance, as in the picture of peak pressures that gait laboratories use. The scale grows when
more than a quarter of a foot's cells exceeded its end within one stance. So the first strides set it, the heel and the
forefoot of a step reach its end, the load of standing is seen as well, and an edge that presses on a few cells does not
make the rest pale. A higher value is drawn as the end of the scale, and "beyond" says that there was one.
Numbers without a source were chosen by hand and not swept."""

from __future__ import annotations

from math import floor, log10
from operator import mul
from typing import Any

from attrs import define, field

from ....calibration import Calibration
from ....types import Foot, Layout
from ..messages import plain

END_MULTIPLES = (1.0, 2.0, 4.0, 6.0, 8.0, 10.0)
"""Multiples of a power of ten at which a scale may end."""
FIRST_ENDS = {"kPa": 100.0, "N": 1.0, "counts": 1.0}
"""First end of a scale in each unit: in kPa the pressure of standing on both feet, in N and counts almost no load."""
BEYOND_SHARE = 0.25
"""Share of a foot's cells that may be above the end of the scale in a stance; a small insole may have one such cell."""
MIN_SAMPLES = 3
"""Number of consecutive samples in which a cell must have a value for it to count."""


@define
class UnitScale:
    """The colour scale of one unit, from 0 to `end`."""

    end: float
    highest: float = 0.0
    """Highest value of any cell so far."""


@define
class InsoleScale:
    """The unit in which a foot's cells are drawn, and their recent values."""

    unit: str
    factors: tuple[float, ...] | None
    """Factor for each cell from the sample's unit to `unit`; None where the units are the same."""
    recent: tuple[tuple[float, ...], ...] = ()
    """The newest samples in a row with a cell above the end of the scale, in `unit`."""
    peaks: tuple[float, ...] = ()
    """Highest value of each cell in those samples of the present stance, in `unit`."""

    def add(self, values: tuple[float, ...]) -> float:
        """Add a sample with a cell above the end; return the value that the allowed share of cells exceeded."""
        self.recent = (*self.recent[1 - MIN_SAMPLES :], values)
        if len(self.recent) < MIN_SAMPLES:
            return 0.0
        lasting = tuple(map(min, *self.recent))
        self.peaks = tuple(map(max, self.peaks, lasting)) if len(self.peaks) == len(lasting) else lasting
        allowed = min(max(1, int(BEYOND_SHARE * len(lasting))), len(lasting) - 1)
        return sorted(self.peaks, reverse=True)[allowed]


@define
class Scales:
    """The colour scales of all units in use, and the insole of each foot."""

    units: dict[str, UnitScale] = field(factory=dict)
    insoles: dict[Foot, InsoleScale] = field(factory=dict)

    def set_layout(self, foot: Foot, layout: Layout, newtons: bool) -> None:
        """Set the layout of a foot's cells; `newtons` says that their values are N, not counts."""
        areas = [cell.area for cell in layout.cells]
        factors = None
        if newtons and areas and all([area > 0.0 for area in areas]):
            unit, factors = "kPa", tuple([0.001 / area for area in areas])  # N over m^2 is Pa
        else:
            unit = "N" if newtons else "counts"
        self.insoles[foot] = InsoleScale(unit, factors)
        self.units.setdefault(unit, UnitScale(FIRST_ENDS[unit]))

    def add_sample(self, foot: Foot, values: tuple[float, ...]) -> None:
        """Add one sample of a foot's cells; it is ignored while the layout of the cells is unknown."""
        insole = self.insoles.get(foot)
        if insole is None or not values:
            return
        factors = insole.factors
        scale = self.units[insole.unit]
        largest = max(values if factors is None else map(mul, values, factors), default=0.0)
        scale.highest = max(scale.highest, largest)
        if not largest > scale.end:
            insole.recent = ()
            return
        reached = insole.add(values if factors is None else tuple(map(mul, values, factors)))
        if reached > scale.end:
            scale.end = scale_end(reached)

    def end_stance(self, foot: Foot) -> None:
        """Forget the peaks of a stance: the foot is in the air."""
        insole = self.insoles.get(foot)
        if insole is not None:
            insole.peaks = ()

    def frame(self) -> dict[str, Any]:
        """Return the member "scales" of a frame."""
        return {unit: {"top": plain(one.end), "beyond": one.highest > one.end} for unit, one in self.units.items()}


def scale_end(value: float) -> float:
    """Return the least end of a scale that is at or above `value`; `value` is above zero."""
    power: float = 10.0 ** floor(log10(value))
    return next((multiple * power for multiple in END_MULTIPLES if multiple * power >= value), 10.0 * power)


def newtons_of(calibration: Calibration | None) -> tuple[Foot, ...]:
    """Return the feet whose calibration turns an insole's counts into N."""
    return tuple(foot for foot in Foot if calibration is not None and calibration.insole(foot).newtons is not None)
