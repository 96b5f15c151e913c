"""Load of one insole: tare, full load, centre of pressure, and load of heel and forefoot.

An insole needs no calibration before walking. The tare is the value of each cell when the foot is in the air, where the
shoe still presses on the cells. The full load is the highest minus the lowest sum of all cells in the last 8 to 10 s,
between a foot in the air and one that bears the wearer. Both are learnt from the signal, so newtons and counts work
alike.

There is no `Load` before the sum has once fallen to a small share of its highest value and risen again. Until then a
falling sum would always be the lowest so far, and a foot that is about to leave the ground would seem to be in the air.
The numbers were chosen by hand and not swept."""

from __future__ import annotations

from collections.abc import Iterable

from ...calibration import Newtons
from ...types import Layout
from ...types.attrs import define, field
from ...types.vector import TIME_EPSILON
from ..settings import InsoleSettings
from ..stance.stance import Load

SPAN_DURATION = 2.0
"""Duration of one of the five spans over which the lowest and highest load are kept, s."""
LEAST_LOAD_RANGE = 0.2
"""Smallest difference between lowest and highest load with which the load is known, as a share of the highest."""
AIRBORNE_LOAD = 0.02
"""Load below which the foot is in the air, as a share of the full load."""
LEAST_LOAD = 0.05
"""Load below which the centre of pressure is noise, as a share of the full load."""
HIGHEST_DECAY = 0.9999
"""Share of the highest recent cell value that remains after each sample: at 100 Hz, half of it after 69 s."""
LEAST_AREA_RANGE = 0.05
"""Smallest range of the load of an area with working cells, as a share of the full load."""


def add_up(cells: tuple[float, ...]) -> float:
    """Return the sum of the cells, in order; `fsum` takes twice the time, and `sum` rounds as its Python does."""
    total = 0.0
    for value in cells:
        total += value
    return total


def add_up_area(cells: tuple[float, ...], indices: tuple[int, ...]) -> float:
    """Return the sum of the cells with these indices, of which there is at least one, in ascending order."""
    first = indices[0]
    if indices[-1] - first + 1 == len(indices):  # a slice takes a tenth of the time of picking cells one by one
        return add_up(cells[first : first + len(indices)])
    total = 0.0
    for i in indices:
        total += cells[i]
    return total


@define
class Extremes:
    """The lowest and highest value of the last 8 to 10 s, kept for each of five spans of 2 s; O(1) a sample."""

    span_end: float | None = None
    """End of the current span, s; None before any."""
    lows: list[float] = field(factory=list)
    """Lowest value of each span."""
    highs: list[float] = field(factory=list)
    """Highest value of each span."""
    low: float = 0.0
    """Lowest value of all spans."""
    high: float = 0.0
    """Highest value of all spans."""

    def update(self, t: float, value: float) -> float:
        """Add one value at `t`, s; return its difference from the lowest value."""
        if self.span_end is None or t >= self.span_end - TIME_EPSILON:
            self.span_end = t + SPAN_DURATION
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
    """Converts the cell values of one insole to a `Load`.

    With a calibration, raw values become newtons by a cubic (calibration.Newtons). The calibrated value of each cell in
    the air (its noise) is subtracted, with 0 as the lower limit (Chen et al. 2019: noise "could be removed through
    deleting p_noise", equation (1))."""

    settings: InsoleSettings = InsoleSettings()
    layout: Layout | None = field(default=None, init=False)
    in_newtons: bool = field(default=False, init=False)
    """The device sends newtons, so `settings.newtons` is not used."""
    cells: tuple[float, ...] = field(default=(), init=False)
    """Values of the cells of the current sample without noise, N or unit of the samples; () after their use."""
    sum: float = field(default=0.0, init=False)
    """Sum of `cells`."""
    heel_cells: tuple[int, ...] = field(default=(), init=False)
    """Indices of the cells of the heel area."""
    forefoot_cells: tuple[int, ...] = field(default=(), init=False)
    """Indices of the cells of the forefoot area."""
    total: Extremes = field(factory=Extremes, init=False)
    """Extremes of the total load."""
    heel: Extremes = field(factory=Extremes, init=False)
    """Extremes of the load of the heel area."""
    forefoot: Extremes = field(factory=Extremes, init=False)
    """Extremes of the load of the forefoot area."""
    tare: list[float] = field(factory=list, init=False)
    """Value of each cell in the air, unit of the samples."""
    tare_total: float = field(default=0.0, init=False)
    """Sum of the cells at the sample that gave the tare, unit of the samples."""
    was_airborne: bool = field(default=False, init=False)
    """The foot was in the air in the last sample."""
    load_risen: bool = field(default=False, init=False)
    """The load has risen again after it had fallen, so that it is known."""

    def set_layout(self, layout: Layout) -> None:
        """Set the layout of the cells."""
        self.layout = layout
        settings = self.settings
        heel_end, forefoot_start = settings.heel_end * layout.length, settings.forefoot_start * layout.length
        self.heel_cells = tuple([i for i, cell in enumerate(layout.cells) if cell.x < heel_end])
        if len(self.tare) != len(layout.cells):
            self.tare = [0.0] * len(layout.cells)
        self.forefoot_cells = tuple([i for i, cell in enumerate(layout.cells) if cell.x > forefoot_start])

    def reset(self) -> None:
        """End the current spans because times restart; the extremes stay."""
        self.total.span_end = self.heel.span_end = self.forefoot.span_end = None

    def update(self, t: float, cells: tuple[float, ...], with_centre: bool = True) -> Load | None:
        """Return the load of one sample, as shares of the full load; None while that is unknown.

        `with_centre`: the centre of pressure is computed, too."""
        settings = self.settings
        if settings.newtons is not None and not self.in_newtons:
            cells = in_newtons(settings.newtons, cells)
        if len(settings.noise) == len(cells):
            cells = above(settings.noise, cells)
        self.cells = cells
        total = self.sum = add_up(cells)
        self.total.update(t, total)
        heel = forefoot = None
        if self.layout is not None and len(cells) == len(self.layout.cells):
            if self.heel_cells:
                heel = self.heel.update(t, add_up_area(cells, self.heel_cells))
            if self.forefoot_cells:
                forefoot = self.forefoot.update(t, add_up_area(cells, self.forefoot_cells))
        low, high = self.total.low, self.total.high
        load_range = high - low
        if load_range <= LEAST_LOAD_RANGE * high or load_range <= 0.0:
            self.load_risen = False
            return None
        if not self.load_risen:
            self.load_risen = total - low > LEAST_LOAD_RANGE * high
            if not self.load_risen:
                return None
        share = (total - low) / load_range
        airborne = share < AIRBORNE_LOAD
        # in the first airborne samples the toe has hardly left the ground, so samples with a lower total are better
        if airborne and (not self.was_airborne or total < self.tare_total):
            self.tare = list(cells)
            self.tare_total = total
        self.was_airborne = airborne
        # an area without variation is dead or absent, so it has no load
        if heel is not None:
            heel = heel / load_range if self.heel.high - self.heel.low > LEAST_AREA_RANGE * load_range else None
        if forefoot is not None:
            forefoot = (
                forefoot / load_range
                if self.forefoot.high - self.forefoot.low > LEAST_AREA_RANGE * load_range
                else None
            )
        centre = self.centre_of_pressure(cells) if with_centre and not airborne else None
        return Load(share, heel, forefoot, airborne, cells, centre)

    def above_tare(self, cells: tuple[float, ...]) -> tuple[float, ...]:
        """Return the cells minus their tare, at least 0, unit of `cells`; without a tare the cells as they are."""
        return above(self.tare, cells) if len(cells) == len(self.tare) else cells

    def centre_of_pressure(self, cells: tuple[float, ...]) -> tuple[float, float] | None:
        """Return the centre of pressure (x, y), foot frame, m; None with hardly any load or without a layout.

        It is the mean of the positions of the cells, weighted by their load above tare: equations (2) and (3) of "Smart
        insole-based indoor localization system for Internet of Things applications", with load in place of pressure."""
        layout = self.layout
        if layout is None or not len(cells) == len(layout.cells) == len(self.tare):
            return None
        load, x_sum, y_sum = weighted_sums(cells, self.tare, layout.xs, layout.ys)
        if load <= LEAST_LOAD * (self.total.high - self.total.low):
            return None
        return x_sum / load, y_sum / load


def above(unloaded: Iterable[float], cells: tuple[float, ...]) -> tuple[float, ...]:
    """Return the cells minus their values without load, at least 0."""
    pairs = zip(cells, unloaded, strict=True)
    return tuple([value - least if value > least else 0.0 for value, least in pairs])


def weighted_sums(
    cells: Iterable[float], tare: Iterable[float], xs: Iterable[float], ys: Iterable[float]
) -> tuple[float, float, float]:
    """Return the sums of the loads above tare, of loads times `xs`, and of loads times `ys`; all have one length."""
    total = x_sum = y_sum = 0.0
    for value, unloaded, x, y in zip(cells, tare, xs, ys, strict=True):
        if value > unloaded:
            load = value - unloaded
            total += load
            x_sum += load * x
            y_sum += load * y
    return total, x_sum, y_sum


def in_newtons(newtons: Newtons, cells: tuple[float, ...]) -> tuple[float, ...]:
    """Return raw values in N: 0 below the threshold, and at most the largest calibrated force."""
    a, b, c, d = newtons.coefficients
    threshold, most = newtons.threshold, newtons.most
    forces = [a + value * (b + value * (c + value * d)) for value in cells]
    return tuple([0.0 if force < threshold else min(force, most) for force in forces])


def centre(layout: Layout) -> float | None:
    """Return x of the centre of the foot, half-way between first and last cell, foot frame, m; None without cells.

    Source: "Smart insole-based indoor localization system for Internet of Things applications", IEEE Internet of Things
    Journal 6, 2019. There, cells from 34 to 166 mm have their centre at 100 mm, and this stands for the centre of
    pressure while the foot is in the air."""
    xs = [cell.x for cell in layout.cells]
    return 0.5 * (min(xs) + max(xs)) if xs else None
