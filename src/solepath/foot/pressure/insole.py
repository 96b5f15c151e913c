"""Pressure cells under one foot: tare, full load, centre of pressure, load of heel and forefoot, and layout.

An insole needs no calibration before walking. The tare is the value of each cell when the foot is in the air, where the
shoe still presses on the cells. The full load is the highest minus the lowest sum of all cells in the last 8 to 10 s,
between a foot in the air and one that bears the wearer. Both are learnt from the signal, so newtons and counts work
alike.

There is no `Load` before the sum has once fallen to a small share of its highest value and risen again. Until then a
falling sum would always be the lowest so far, and a foot that is about to leave the ground would seem to be in the air.
Cells that never show a small value, because of their voltage divider, or that show values below zero, because they were
set to zero under the wearer, have no load before two swings have shown their level without load (unloaded.py). From
then on the load is measured from that level, wherever it is, and follows it.
The numbers were chosen by hand and not swept."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import repeat
from math import fsum
from operator import add

from ...calibration import Newtons
from ...events import Event, FootPressed, LayoutKnown
from ...types import SITE_OF_FOOT, Cell, Floats, Foot, Layout, Phase, Sample, Vec2
from ...types.attrs import define, field, state, stateful
from ...types.vector import TIME_EPSILON
from ..limitations import Limitations
from ..settings import FootSettings, InsoleSettings
from ..stance.stance import Load
from .cell_health import CellHealth, add_up
from .jumps import LEAST_STEP, LEAST_STEP_OF_TWO, Jumps
from .unloaded import UnloadedLevel

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

# what is said of the cells of one insole, with the name of its foot
BURST = "now and then many cells of the {} insole show one and the same value for a moment; those samples are not used"
STEP = "all cells of the {} insole have jumped by the same amount, as when a supply voltage changes; it is taken off"
INVERTED = "the cells of the {} insole fall under load, as if wired the other way round; their values are turned"
MOVED = "the cells of the {} insole show other values without load than before; these are learnt anew in each swing"


@define
class Extremes:
    """The lowest and highest value of the last 8 to 10 s, kept for each of five spans of 2 s; O(1) a sample."""

    span_end: float | None = None
    """Time from which on a value starts the next span, s; None before any."""
    lows: list[float] = field(factory=list)
    """Lowest value of each span."""
    highs: list[float] = field(factory=list)
    """Highest value of each span."""
    low: float = 0.0
    """Lowest value of all spans."""
    high: float = 0.0
    """Highest value of all spans."""

    def update(self, t: float, value: float) -> None:
        """Add one value at `t`, s."""
        if self.span_end is None or t >= self.span_end:
            self.span_end = t + SPAN_DURATION - TIME_EPSILON
            self.lows = [*self.lows[-4:], value]
            self.highs = [*self.highs[-4:], value]
            self.low = min(self.lows)
            self.high = max(self.highs)
        elif value < self.lows[-1]:
            self.lows[-1] = value
            self.low = min(self.low, value)
        elif value > self.highs[-1]:
            self.highs[-1] = value
            self.high = max(self.high, value)

    def shift(self, by: float) -> None:
        """Add `by` to all values."""
        self.lows, self.highs = [low + by for low in self.lows], [high + by for high in self.highs]
        self.low, self.high = self.low + by, self.high + by


@stateful
class InsoleLoads:
    """Converts the cell values of one insole to a `Load`.

    With a calibration, raw values become newtons by a cubic (calibration.Newtons). The calibrated value of each cell in
    the air (its noise) is subtracted, with 0 as the lower limit (Chen et al. 2019: noise "could be removed through
    deleting p_noise", equation (1))."""

    settings: InsoleSettings = field(default=InsoleSettings())
    layout: Layout | None = None
    in_newtons: bool = False
    """The device sends newtons, so `settings.newtons` is not used."""
    cells: Floats = ()
    """Values of the cells of the current sample without noise, N or unit of the samples; () after their use."""
    sum: float = 0.0
    """Sum of `cells` above the level without load, as far as it is known."""
    heel_cells: tuple[int, ...] = ()
    """Indices of the cells of the heel area."""
    forefoot_cells: tuple[int, ...] = ()
    """Indices of the cells of the forefoot area."""
    total: Extremes = state(factory=Extremes)
    """Extremes of the total load."""
    heel: Extremes = state(factory=Extremes)
    """Extremes of the load of the heel area."""
    forefoot: Extremes = state(factory=Extremes)
    """Extremes of the load of the forefoot area."""
    tare: Floats = ()
    """Value of each cell in the air, unit of the samples."""
    tare_total: float = 0.0
    """Sum of the cells at the sample that gave the tare, unit of the samples."""
    was_airborne: bool = False
    """The foot was in the air in the last sample."""
    unloaded: UnloadedLevel = state(factory=UnloadedLevel)
    """Level of the total load while the foot is in the air."""
    turned: UnloadedLevel = state(factory=UnloadedLevel)
    """The same of the load with its sign changed, until it is known which of the two is right."""
    jumps: Jumps = state(factory=Jumps)
    """Steps and bursts of all cells."""
    inverted: bool = False
    """The values of all cells fall under load, so that their signs are changed before `update`."""
    trouble: str = ""
    """What was wrong with the cells since this was last set to ""; one of BURST, STEP, INVERTED and MOVED."""
    load_risen: bool = False
    """The load has risen again after it had fallen, so that it is known."""

    def set_layout(self, layout: Layout) -> None:
        """Set the layout of the cells."""
        self.layout = layout
        settings = self.settings
        heel_end, forefoot_start = settings.heel_end * layout.length, settings.forefoot_start * layout.length
        self.heel_cells = tuple([i for i, cell in enumerate(layout.cells) if cell.x < heel_end])
        if len(self.tare) != len(layout.cells):
            self.tare = (0.0,) * len(layout.cells)
        self.forefoot_cells = tuple([i for i, cell in enumerate(layout.cells) if cell.x > forefoot_start])

    def reset(self) -> None:
        """End the current spans because times restart; the extremes stay."""
        self.total.span_end = self.heel.span_end = self.forefoot.span_end = None
        self.unloaded.restart()
        self.turned.restart()
        self.jumps = Jumps(bursts=self.jumps.bursts)

    def update(self, t: float, cells: Floats, with_centre: bool = True) -> Load | None:
        """Return the load of one sample, as shares of the full load; None while that is unknown.

        `with_centre`: the centre of pressure is computed, too."""
        settings = self.settings
        newtons, noise = None if self.in_newtons else settings.newtons, settings.noise
        if newtons is not None:
            cells = in_newtons(newtons, cells)
        if len(noise) == len(cells):
            cells = above(noise if newtons is None else in_newtons(newtons, noise), cells)
        self.cells = cells
        total = add_up(cells)
        last_range = self.total.high - self.total.low if self.load_risen else 0.0
        jumps, least = self.jumps, (LEAST_STEP if len(cells) > 2 else LEAST_STEP_OF_TWO) * last_range
        if jumps.burst is not None or jumps.before or abs(total - jumps.total) > least > 0.0:
            if jumps.is_burst(t, total, cells, last_range, self.total.low):
                if jumps.bursts > 1:
                    self.trouble = BURST
                return None
            if jumps.is_jump(t, total, cells, least / len(cells)):
                return None
            if step := jumps.find_step(cells, least / len(cells)):
                self.trouble = STEP
                self._shift(step, len(cells))
        jumps.t, jumps.total, jumps.cells = t, total, cells
        heel_sum = forefoot_sum = 0.0
        self.total.update(t, total)
        has_areas = self.layout is not None and len(cells) == len(self.layout.cells)
        if has_areas:
            for i in self.heel_cells:
                heel_sum += cells[i]
            for i in self.forefoot_cells:
                forefoot_sum += cells[i]
            self.heel.update(t, heel_sum)
            self.forefoot.update(t, forefoot_sum)
        low, high = self.total.low, self.total.high
        level = self.unloaded.update(t, total, cells, high - low)
        # swings that lie on top, and none below, are those of cells that are wired the other way round
        if self.unloaded.sure_ground is None and not self.inverted:
            self.turned.update(t, -total, cells, high - low)
            if self.turned.sure_ground is not None and not self.unloaded.grounds:
                self.trouble = INVERTED
                self._turn()
                return None
        if self.unloaded.moved:
            self.trouble, self.unloaded.moved = MOVED, False
        self.sum = total if level is None else total - level
        full = high if level is None else high - level
        # values far below zero are not those of unloaded cells at zero: whoever set them to zero stood on them
        is_net = level is None and low < -LEAST_LOAD_RANGE * high
        if high - low <= LEAST_LOAD_RANGE * full or high <= low or is_net:
            self.load_risen = False
            return None
        if level is not None:
            low = level
        load_range = high - low
        if not self.load_risen:
            self.load_risen = total - low > LEAST_LOAD_RANGE * full
            if not self.load_risen:
                return None
        share = (total - low) / load_range
        airborne = share < AIRBORNE_LOAD
        # in the first airborne samples the toe has hardly left the ground, so samples with a lower total are better
        if airborne and (not self.was_airborne or total < self.tare_total):
            self.tare = cells
            self.tare_total = total
        self.was_airborne = airborne
        # an area without variation is dead or absent, so it has no load
        heel = forefoot = None
        if has_areas and self.heel.high - self.heel.low > LEAST_AREA_RANGE * load_range:
            heel = (heel_sum - self.heel.low) / load_range
        if has_areas and self.forefoot.high - self.forefoot.low > LEAST_AREA_RANGE * load_range:
            forefoot = (forefoot_sum - self.forefoot.low) / load_range
        centre = self.centre_of_pressure(cells) if with_centre and not airborne else None
        unloaded = () if level is None else self.tare
        return Load(share, heel, forefoot, airborne, cells, centre, unloaded)

    def _turn(self) -> None:
        """Discard what was learnt, because the signs of the values change from now on."""
        self.inverted = True
        self.total, self.heel, self.forefoot = Extremes(), Extremes(), Extremes()
        self.tare, self.was_airborne, self.load_risen = (0.0,) * len(self.tare), False, False
        self.unloaded, self.jumps = self.turned.turned(), Jumps()

    def _shift(self, step: float, count: int) -> None:
        """Add `step` to everything that was learnt of the values of each of `count` cells."""
        self.tare = tuple([value + step for value in self.tare])
        self.tare_total += count * step
        self.unloaded.shift(count * step)
        self.total.shift(count * step)
        self.heel.shift(len(self.heel_cells) * step)
        self.forefoot.shift(len(self.forefoot_cells) * step)

    def above_tare(self, cells: Floats) -> Floats:
        """Return the cells minus their tare, at least 0, unit of `cells`; without a tare the cells as they are."""
        return above(self.tare, cells) if len(cells) == len(self.tare) else cells

    def centre_of_pressure(self, cells: Floats) -> Vec2 | None:
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


def above(unloaded: Iterable[float], cells: Floats) -> Floats:
    """Return the cells minus their values without load, at least 0."""
    pairs = zip(cells, unloaded, strict=True)
    return tuple([value - least if value > least else 0.0 for value, least in pairs])


def weighted_sums(
    cells: Iterable[float], tare: Iterable[float], xs: Iterable[float], ys: Iterable[float]
) -> tuple[float, float, float]:
    """Return the sums of the loads above tare, of loads times `xs`, and of loads times `ys`; all have one length.

    In Chen et al. 2019 copY, from heel to toe, is x_sum / total, and copX is y_sum / total, equations (3) and (2)."""
    total = x_sum = y_sum = 0.0
    for value, unloaded, x, y in zip(cells, tare, xs, ys, strict=True):
        if value > unloaded:
            load = value - unloaded
            total += load
            x_sum += load * x
            y_sum += load * y
    return total, x_sum, y_sum


def in_newtons(newtons: Newtons, cells: Floats) -> Floats:
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


ASSUMED_LENGTH = 0.26
"""Length of an insole of unknown size, m: that of size 42."""
REAR_POSITION, FRONT_POSITION = 0.1, 0.9
"""Positions of the first and the last loaded cell, measured from the heel, as shares of the length, 0 to 1."""
ESTIMATED_LAYOUT_ID = 0
"""Value of `Layout.id` for an estimated layout."""
STANCES_OF_ESTIMATE = 2
"""Number of complete stances that an estimate needs."""
STANCE_START_LOAD, STANCE_END_LOAD = 0.10, 0.05
"""Loads at which a stance starts and ends, as shares of the full load, 0 to 1."""
SHORTEST_STANCE, LONGEST_STANCE = 0.25, 2.0
"""Shortest and longest stance of walking, s."""
LEAST_CELL_LOAD = 0.02
"""Smallest load of a cell whose position is estimated, as a share of the most loaded cell's.

Other cells get the middle of the insole."""


@define
class LayoutGuess:
    """Estimates an unknown layout of pressure cells from the order in which a stance loads them.

    The cells of the heel bear the start of each stance and those of the toes its end. So the mean time of a cell's load
    within the stance grows from heel to toe. The signal does not show where a cell lies from left to right.

    Call `update` with every sample until it returns a layout. A sample costs two additions a cell."""

    foot: Foot
    stance_start: float | None = None
    """Start of the current stance, s; None while the foot is in the air."""
    was_airborne: bool = False
    """The foot was in the air before this stance, so the start of the stance is known."""
    loads: list[float] = field(factory=list)
    """For each cell, sum of its load over this stance."""
    moments: list[float] = field(factory=list)
    """For each cell, sum of its load times the time since the start of this stance, s."""
    weights: list[float] = field(factory=list)
    """For each cell, sum of its load over all stances."""
    relative_times: list[float] = field(factory=list)
    """For each cell, sum over all stances of its load times the relative time in the stance (0 to 1)."""
    stances: int = 0
    """Number of complete stances so far."""

    def update(self, t: float, cells: Floats, load_share: float) -> Layout | None:
        """Add one sample; return the layout once it is known.

        `cells` holds the values minus those in the air, `load_share` their total as a share of the full load."""
        if self.stance_start is None:
            if load_share > STANCE_START_LOAD:
                self.stance_start = t
                self.loads = list(cells)
                self.moments = [0.0] * len(cells)
            else:
                self.was_airborne = True
            return None
        time_since_start = t - self.stance_start
        if load_share >= STANCE_END_LOAD and time_since_start < LONGEST_STANCE and len(cells) == len(self.loads):
            self.loads = list(map(add, self.loads, cells))
            self.moments = [moment + time_since_start * cell for moment, cell in zip(self.moments, cells, strict=True)]
            return None
        is_complete, self.stance_start = self.was_airborne, None
        self.was_airborne = load_share < STANCE_END_LOAD
        if not is_complete or not SHORTEST_STANCE <= time_since_start < LONGEST_STANCE:
            return None
        if len(self.weights) != len(self.loads):
            self.weights, self.relative_times, self.stances = [0.0] * len(self.loads), [0.0] * len(self.loads), 0
        self.weights = list(map(add, self.weights, self.loads))
        self.relative_times = [
            m + moment / time_since_start for m, moment in zip(self.relative_times, self.moments, strict=True)
        ]
        self.stances += 1
        return self._layout() if self.stances >= STANCES_OF_ESTIMATE else None

    def _layout(self) -> Layout | None:
        weights = self.weights
        least = LEAST_CELL_LOAD * max(weights)
        mean_times = [m / w if w > least else None for m, w in zip(self.relative_times, weights, strict=True)]
        known_times = sorted([middle for middle in mean_times if middle is not None])
        if not known_times or known_times[-1] <= known_times[0]:
            return None
        earliest, latest = known_times[0], known_times[-1]
        metres_per_time = (FRONT_POSITION - REAR_POSITION) * ASSUMED_LENGTH / (latest - earliest)
        xs = [
            0.5 * ASSUMED_LENGTH
            if middle is None
            else REAR_POSITION * ASSUMED_LENGTH + (middle - earliest) * metres_per_time
            for middle in mean_times
        ]
        return Layout(ESTIMATED_LAYOUT_ID, self.foot, tuple([Cell(x, 0.0) for x in xs]), ASSUMED_LENGTH)


@stateful
class Sole:
    """The pressure cells of one foot.

    Failed cells are not used. If the layout is unknown and the recipe needs pressure, the layout is estimated."""

    foot: Foot = field()
    settings: FootSettings = field(default=FootSettings())
    insole: InsoleLoads = field(init=False)
    had_cells: bool = False
    """At least one sample with usable cells was added."""
    health: CellHealth = field(init=False)
    guess: LayoutGuess = field(init=False)
    layout_estimated: bool = False
    """The layout is an estimate."""
    calibrated_layout: Layout | None = None
    """Layout of the calibration that waits for a sample with the same number of cells; None when none waits."""
    count_checked: bool = False
    """It is decided whether the calibration is used: it matches the number of cells, or was rejected."""
    highest: float = 0.0
    """Highest recent value of any cell of a pressure event, unit of the cells; it decays slowly."""
    layout_changed: bool = False
    """The layout has changed, and detector and cues have not received it yet."""

    def __attrs_post_init__(self) -> None:
        self.health = CellHealth(SITE_OF_FOOT[self.foot])
        self.guess = LayoutGuess(self.foot)
        self.insole = InsoleLoads(self.settings.insole)
        self.calibrated_layout = self.settings.layout

    def set_layout(self, layout: Layout, limitations: Limitations) -> None:
        """Set the layout that the device has sent, or that of a calibration that matches the samples."""
        self.layout_estimated, self.calibrated_layout = False, None
        self._apply_layout(layout, limitations)

    def reset(self) -> None:
        """Discard what depends on unbroken samples, because times restart."""
        self.insole.reset()
        self.health.reset()

    def add_sample(
        self, sample: Sample, known_at: float, phase: Phase, with_centre: bool, limitations: Limitations,
        events: list[Event],
    ) -> Load | None:  # fmt: skip
        """Return the load of one sample of a foot in this phase; None while it is unknown, or without usable cells.

        `with_centre`: the centre of pressure is computed, too."""
        t, pressure = sample.t, sample.pressure or ()
        if pressure and not self.count_checked:
            self._check_count(len(pressure), t, known_at, limitations, events)
        known_layout = None if self.layout_estimated else self.insole.layout
        if self.insole.inverted:
            pressure = tuple([None if value is None else -value for value in pressure])
        in_air = self.insole.unloaded.sure_cells
        health, total = self.health, self.insole.total
        # the range is that of values as they are sent, which calibrated newtons are not
        as_sent = self.insole.in_newtons or self.insole.settings.newtons is None
        load_range = total.high - total.low if self.insole.load_risen and as_sent else 0.0
        events += health.update(t, known_at, pressure, phase, sample.gyro, known_layout, in_air, load_range)
        has_unusable_cells = health.excluded or health.non_numeric or len(pressure) != health.count
        cells = health.usable(pressure, self.insole.tare) if has_unusable_cells else pressure
        if not cells:
            return None
        self.had_cells = True
        if health.unchanged_swings:
            return None
        layout = self.insole.layout
        if self.layout_estimated and layout is not None and len(layout.cells) != len(cells):
            self.layout_estimated, self.highest = False, 0.0  # it was estimated for another insole
            self.guess, self.insole = LayoutGuess(self.foot), InsoleLoads(self.settings.insole)
        load = self.insole.update(t, cells, with_centre)
        if self.insole.trouble:
            limitations.report(self.insole.trouble.format(self.foot.value), t, known_at, events)
            self.insole.trouble = ""
        if self.settings.needs_pressure and self.insole.layout is None and load is not None:
            guessed = self.guess.update(t, self.insole.above_tare(load.cells), load.total)
            if guessed is not None:
                text = f"nobody says where the cells of the {self.foot.value} insole are"
                limitations.report(f"{text}: learnt from how steps load them", t, known_at, events)
                self.layout_estimated = True
                self._apply_layout(guessed, limitations)
        return load

    def make_event(self, t: float, known_at: float, pressure: Floats) -> FootPressed | None:
        """Return the pressure event of the sample of the last `add_sample`; None if no cell could be used."""
        insole, health = self.insole, self.health
        if not health.usable(pressure):
            return None
        self.highest = max(self.highest * HIGHEST_DECAY, *insole.cells)
        values = insole.above_tare(insole.cells)
        if health.excluded or health.non_numeric:  # the calibration's cubic may turn 0 into a force
            failed_cells = {*health.excluded, *[i for i, _ in health.non_numeric]}
            values = tuple([0.0 if i in failed_cells else value for i, value in enumerate(values)])
        force = fsum(values)  # in the unit of the cells
        centre, layout = None, insole.layout
        if layout is not None and not self.layout_estimated:
            # after a long time in the air the range of loads is small; then the highest cell value sets the limit
            least_force = LEAST_LOAD * max(insole.total.high - insole.total.low, self.highest)
            if force > least_force:
                load, x_sum, y_sum = weighted_sums(values, repeat(0.0, len(values)), layout.xs, layout.ys)
                centre = (x_sum / load, y_sum / load)
        return FootPressed(t=t, known_at=known_at, foot=self.foot, values=values, force=force, centre=centre)

    def _check_count(
        self, count: int, t: float, known_at: float, limitations: Limitations, events: list[Event]
    ) -> None:
        """Check that the calibration matches the `count` cells of a sample, and use its layout if it does."""
        layout, noise = self.calibrated_layout, self.insole.settings.noise
        if layout is not None and len(layout.cells) == count:
            self.set_layout(layout, limitations)
            events.append(LayoutKnown(t=t, known_at=known_at, site=SITE_OF_FOOT[self.foot], layout=layout))
            layout = None
        mismatch = layout is not None or (bool(noise) and len(noise) != count)
        self.count_checked = not mismatch or limitations.rejects_calibration(layout, noise, count, t, known_at, events)
        if mismatch and self.count_checked:
            self.calibrated_layout = None

    def _apply_layout(self, layout: Layout, limitations: Limitations) -> None:
        self.insole.set_layout(layout)
        insole = self.insole
        if (
            insole.settings.newtons is not None
            and not insole.in_newtons
            and layout.scale is not None
            and not self.layout_estimated
        ):
            insole.in_newtons = True
            text = f"the {self.foot.value} insole tells newtons itself: the calibration's cubic is not used"
            limitations.queue(text)
        self.layout_changed = True
