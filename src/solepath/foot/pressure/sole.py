"""The cells under one foot: where they are, which of them work, and what load they make."""

from __future__ import annotations

from operator import mul

from ...events import Event, FootPressed, LayoutKnown
from ...types import SITE_OF_FOOT, Foot, Layout, Phase, Sample
from ...types.attrs import define, evolve, field
from ..limits import Limits
from ..settings import FootSettings
from ..stance.stance import Load
from .cell_health import CellHealth
from .guess import LayoutGuess
from .insole import LEAST_LOAD, InsoleLoads


@define
class Sole:
    """Cells that failed are left out. Where nobody says where the cells are, it is learnt if the recipe needs them."""

    foot: Foot
    insole: InsoleLoads
    settings: FootSettings = FootSettings()
    pressed: bool = field(default=False, init=False)
    """Cells were heard of."""
    health: CellHealth = field(init=False)
    guess: LayoutGuess = field(init=False)
    guessed: bool = field(default=False, init=False)
    """The layout is a guess."""
    supposed: Layout | None = field(default=None, init=False)
    """The calibration's layout, until a sample with as many cells has come."""
    compared: bool = field(default=False, init=False)
    """What the calibration says of the cells is of as many as there are, or is not used."""
    layout_changed: bool = field(default=False, init=False)
    """There is another layout than before, of which the other parts have not been told."""

    def __attrs_post_init__(self) -> None:
        self.health = CellHealth(SITE_OF_FOOT[self.foot])
        self.guess = LayoutGuess(self.foot)

    def set_layout(self, layout: Layout, limits: Limits) -> None:
        """The device said where its cells are."""
        self.guessed, self.supposed = False, None
        self._lay_out(layout, limits)

    def suppose(self, layout: Layout) -> None:
        """A calibration says where the cells are: it is believed if samples have as many."""
        self.supposed = layout

    def reset(self) -> None:
        """Times begin anew."""
        self.insole.reset()
        self.health.reset()

    def press(self, sample: Sample, known_at: float, phase: Phase, limits: Limits, events: list[Event]) -> Load | None:
        """One sample of a foot in this phase; None while the load is not known, or without cells that could be used."""
        t, pressure = sample.t, sample.pressure or ()
        if pressure and not self.compared:
            self._compare(len(pressure), t, known_at, limits, events)
        if not pressure and not self.pressed:
            return None
        told = None if self.guessed else self.insole.layout
        events += self.health.update(t, known_at, pressure, phase, sample.gyro, told)
        health = self.health
        odd = health.out or health.numberless or len(pressure) != health.count
        cells = health.usable(pressure) if odd else pressure
        if not cells:
            return None
        self.pressed = True
        layout = self.insole.layout
        if self.guessed and layout is not None and len(layout.cells) != len(cells):
            self._forget_layout()  # it was of another insole
        load = self.insole.update(t, cells)
        if self.settings.needs_pressure and self.insole.layout is None and load is not None:
            self._guess_layout(t, known_at, load, limits, events)
        return load

    def pressed_by(self, t: float, known_at: float, pressure: tuple[float, ...]) -> FootPressed | None:
        """What the cells of the sample that was just pressed show; None when there was nothing that could be used."""
        insole, health = self.insole, self.health
        if not health.usable(pressure):
            return None
        values = insole.above_tare(insole.cells)
        if health.out or health.numberless:  # a cubic may make something of their 0
            silent = {*health.out, *[i for i, _ in health.numberless]}
            values = tuple([0.0 if i in silent else value for i, value in enumerate(values)])
        force = sum(values)
        centre, layout = None, insole.layout
        if layout is not None and not self.guessed and len(values) == len(layout.cells):
            # a foot in the air for long has a small reach of loads; its cells are less than what they have carried
            least = LEAST_LOAD * max(insole.total.high - insole.total.low, insole.highest)
            if force > least:
                centre = (sum(map(mul, layout.xs, values)) / force, sum(map(mul, layout.ys, values)) / force)
        return FootPressed(t=t, known_at=known_at, foot=self.foot, values=values, force=force, centre=centre)

    def _compare(self, count: int, t: float, known_at: float, limits: Limits, events: list[Event]) -> None:
        """A sample has `count` cells: whether the calibration is of this insole."""
        layout, noise = self.supposed, self.insole.settings.noise
        if layout is not None and len(layout.cells) == count:
            self.set_layout(layout, limits)
            events.append(LayoutKnown(t=t, known_at=known_at, site=SITE_OF_FOOT[self.foot], layout=layout))
            layout = None
        odd = layout is not None or (bool(noise) and len(noise) != count)
        self.compared = not odd or limits.misfit(layout, noise, count, t, known_at, events)
        if odd and self.compared:
            self.supposed = None

    def _lay_out(self, layout: Layout, limits: Limits) -> None:
        self.insole.set_layout(layout)
        insole = self.insole
        if (
            insole.settings.newtons is not None
            and not insole.in_newtons
            and layout.scale is not None
            and not self.guessed
        ):
            insole.in_newtons = True
            what = f"the {self.foot.value} insole tells newtons itself: the calibration's cubic is not used"
            limits.later(what)
        self.layout_changed = True

    def _guess_layout(self, t: float, known_at: float, load: Load, limits: Limits, events: list[Event]) -> None:
        layout = self.guess.update(t, self.insole.above_tare(load.cells), load.total)
        if layout is not None:
            what = f"nobody says where the cells of the {self.foot.value} insole are: learnt from how steps load them"
            limits.say(what, t, known_at, events)
            self.guessed = True
            self._lay_out(layout, limits)

    def _forget_layout(self) -> None:
        self.guessed = False
        self.guess = LayoutGuess(self.foot)
        self.insole = evolve(self.insole)
