"""Pressure cells as the foot room uses them: tare, load, centre of pressure and areas.

Nobody calibrates an insole before walking. The tare is what the cells show when the foot is in the air (a shoe presses
on them even then), the full load what they show when it carries the body; both are learnt from the signal, so newtons
and counts serve alike. Until the load has once fallen to a fraction of itself and risen again nothing is known and
there is no `Load`: a load that still falls is always the least so far, and a foot about to step would be in the air.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from operator import itemgetter, mul

from ...calibration import Calibration, Newtons
from ...types import Foot, Layout
from ...types.attrs import define, evolve, field
from ...types.vector import TIE
from ..settings import InsoleSettings
from ..stance.stance import Load

SPAN = 2.0
"""Length of one of the five spans over which the lowest and highest load are kept, s."""
CONTRAST = 0.2
"""Lowest and highest load must differ by this share of the highest before they mean anything."""
AIRBORNE = 0.02
"""Below this share of the full load the foot is in the air."""
LEAST_LOAD = 0.05
"""Below this share of the full load the centre of pressure is noise."""
LEAST_AREA_RANGE = 0.05
"""An area whose load varies by less than this share of the full load is no area."""


@define
class Extremes:
    """The lowest and highest value of the last 8 to 10 s, from five spans of 2 s. O(1) a sample."""

    ends: float | None = field(default=None, init=False)
    lows: list[float] = field(factory=list, init=False)
    highs: list[float] = field(factory=list, init=False)
    low: float = field(default=0.0, init=False)
    high: float = field(default=0.0, init=False)

    def update(self, t: float, value: float) -> float:
        """One more value, at `t`, s: by how much it is above the lowest."""
        if self.ends is None or t >= self.ends - TIE:
            self.ends = t + SPAN
            self.lows = [*self.lows[-4:], value]
            self.highs = [*self.highs[-4:], value]
            self.low = min(self.lows)
            self.high = max(self.highs)
            return value - self.low
        if value < self.lows[-1]:
            self.lows[-1] = value
            self.low = min(self.low, value)
        if value > self.highs[-1]:
            self.highs[-1] = value
            self.high = max(self.high, value)
        return value - self.low


@define
class InsoleLoads:
    """One insole: cell values in, `Load` out.

    With a calibration raw values become newtons by a cubic (calibration.Newtons), and each cell's noise in the air is
    taken off, never below 0 (Chen et al. 2019: noise "could be removed through deleting p_noise", equation (1)).
    """

    settings: InsoleSettings = InsoleSettings()
    layout: Layout | None = field(default=None, init=False)
    in_newtons: bool = field(default=False, init=False)
    """The device does, so `newtons` are not used."""
    cells: tuple[float, ...] = field(default=(), init=False)
    """Values of the sample that is being used, noise taken off; () once it was."""
    sum: float = field(default=0.0, init=False)
    """Of them."""
    heel_cells: tuple[int, ...] = field(default=(), init=False)
    forefoot_cells: tuple[int, ...] = field(default=(), init=False)
    total: Extremes = field(factory=Extremes, init=False)
    heel: Extremes = field(factory=Extremes, init=False)
    forefoot: Extremes = field(factory=Extremes, init=False)
    highest: float = field(default=0.0, init=False)
    tare: list[float] = field(factory=list, init=False)
    """Each cell in the air, unit of the samples."""
    tare_total: float = field(default=0.0, init=False)
    was_airborne: bool = field(default=False, init=False)
    load_risen: bool = field(default=False, init=False)
    """The load has come up again from its lowest."""

    def calibrated(self, foot: Foot, calibration: Calibration) -> InsoleLoads:
        """The same with what is known of this foot's insole."""
        known = calibration.insole(foot)
        newtons, noise = known.newtons or self.settings.newtons, known.noise or self.settings.noise
        return evolve(self, settings=evolve(self.settings, newtons=newtons, noise=noise))

    def set_layout(self, layout: Layout) -> None:
        """The device said where its cells are."""
        self.layout = layout
        settings = self.settings
        heel_end, forefoot_start = settings.heel_end * layout.length, settings.forefoot_start * layout.length
        self.heel_cells = tuple([i for i, cell in enumerate(layout.cells) if cell.x < heel_end])
        if len(self.tare) != len(layout.cells):
            self.tare = [0.0] * len(layout.cells)
        self.forefoot_cells = tuple([i for i, cell in enumerate(layout.cells) if cell.x > forefoot_start])

    def reset(self) -> None:
        """Times begin anew: the extremes are kept, but their spans end here."""
        self.total.ends = self.heel.ends = self.forefoot.ends = None

    def update(self, t: float, cells: tuple[float, ...]) -> Load | None:
        """The load as shares of the wearer's full load, or None while that is not known."""
        settings = self.settings
        if settings.newtons is not None and not self.in_newtons:
            cells = in_newtons(settings.newtons, cells)
        if len(settings.noise) == len(cells):
            pairs = zip(cells, settings.noise, strict=True)
            cells = tuple([value - zero if value > zero else 0.0 for value, zero in pairs])
        self.cells = cells
        total = self.sum = sum(cells)
        self.total.update(t, total)
        largest = max(cells) if cells else 0.0
        self.highest = max(self.highest * 0.9999, largest)
        heel = forefoot = None
        if self.layout is not None and len(cells) == len(self.layout.cells):
            if self.heel_cells:
                heel = self.heel.update(t, sum(picker(self.heel_cells)(cells)))
            if self.forefoot_cells:
                forefoot = self.forefoot.update(t, sum(picker(self.forefoot_cells)(cells)))
        low, high = self.total.low, self.total.high
        reach = high - low
        if reach <= CONTRAST * high or reach <= 0.0:
            self.load_risen = False
            return None
        if not self.load_risen:
            self.load_risen = total - low > CONTRAST * high
            if not self.load_risen:
                return None
        share = (total - low) / reach
        airborne = share < AIRBORNE
        if airborne and (not self.was_airborne or total < self.tare_total):  # the toe has hardly left yet at first
            self.tare = list(cells)
            self.tare_total = total
        self.was_airborne = airborne
        # an area that never carries anything is dead, or there is none: nothing can be told by it
        if heel is not None:
            heel = heel / reach if self.heel.high - self.heel.low > LEAST_AREA_RANGE * reach else None
        if forefoot is not None:
            forefoot = forefoot / reach if self.forefoot.high - self.forefoot.low > LEAST_AREA_RANGE * reach else None
        highest = largest / self.highest if self.highest > 0.0 else 0.0
        centre = None if airborne else self.centre_of_pressure(cells)
        return Load(share, heel, forefoot, highest, airborne, cells, centre)

    def above_tare(self, cells: tuple[float, ...]) -> tuple[float, ...]:
        """The cells less what they show in the air, as far as that is known; unit of the samples."""
        if len(cells) != len(self.tare):
            return cells
        return tuple([value - zero if value > zero else 0.0 for value, zero in zip(cells, self.tare, strict=True)])

    def centre_of_pressure(self, cells: tuple[float, ...]) -> tuple[float, float] | None:
        """(x, y) in the foot frame, m: the mean of the cells' places weighted by their load above tare. None with
        hardly any load or without a layout. Equations (2) and (3) of "Smart insole-based indoor localization system
        for Internet of Things applications", with load in place of pressure."""
        layout = self.layout
        if layout is None or not len(cells) == len(layout.cells) == len(self.tare):
            return None
        loads = [value - zero if value > zero else 0.0 for value, zero in zip(cells, self.tare, strict=True)]
        load = sum(loads)
        if load <= LEAST_LOAD * (self.total.high - self.total.low):
            return None
        return (sum(map(mul, layout.xs, loads)) / load, sum(map(mul, layout.ys, loads)) / load)


@lru_cache(maxsize=16)
def picker(indices: tuple[int, ...]) -> Callable[[tuple[float, ...]], tuple[float, ...]]:
    """Takes these of a tuple, as a tuple, in a third of the time of a loop."""
    few = slice(indices[0], indices[0] + 1)
    return itemgetter(*indices) if len(indices) > 1 else itemgetter(few)


def in_newtons(newtons: Newtons, cells: tuple[float, ...]) -> tuple[float, ...]:
    """Raw values as N: 0 below the threshold, and no more than the most that was calibrated."""
    a, b, c, d = newtons.coefficients
    least, most = newtons.threshold, newtons.most
    forces = [a + value * (b + value * (c + value * d)) for value in cells]
    return tuple([0.0 if force < least else min(force, most) for force in forces])
