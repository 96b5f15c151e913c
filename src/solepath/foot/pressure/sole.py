"""The cells under one foot: where they are, which of them work, and what load they make."""

from __future__ import annotations

from operator import mul

from ...events import Event, FootPressed, LayoutKnown
from ...types import SITE_OF_FOOT, Foot, Layout, Phase, Sample
from ...types.attrs import define, evolve, field
from ..limitations import Limitations
from ..settings import FootSettings
from ..stance.stance import Load
from .cell_health import CellHealth
from .insole import LEAST_LOAD, InsoleLoads
from .layout_guess import LayoutGuess


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
    calibrated_layout: Layout | None = field(default=None, init=False)
    """The calibration's layout, until a sample with as many cells has come."""
    count_checked: bool = field(default=False, init=False)
    """What the calibration says of the cells is of as many as there are, or is not used."""
    layout_changed: bool = field(default=False, init=False)
    """There is another layout than before, of which the other parts have not been told."""

    def __attrs_post_init__(self) -> None:
        self.health = CellHealth(SITE_OF_FOOT[self.foot])
        self.guess = LayoutGuess(self.foot)

    def set_layout(self, layout: Layout, limitations: Limitations) -> None:
        """The device said where its cells are."""
        self.guessed, self.calibrated_layout = False, None
        self._apply_layout(layout, limitations)

    def suppose(self, layout: Layout) -> None:
        """A calibration says where the cells are: it is believed if samples have as many."""
        self.calibrated_layout = layout

    def reset(self) -> None:
        """Times begin anew."""
        self.insole.reset()
        self.health.reset()

    def press(
        self, sample: Sample, known_at: float, phase: Phase, limitations: Limitations, events: list[Event]
    ) -> Load | None:
        """One sample of a foot in this phase; None while the load is not known, or without cells that could be used."""
        t, pressure = sample.t, sample.pressure or ()
        if pressure and not self.count_checked:
            self._check_count(len(pressure), t, known_at, limitations, events)
        if not pressure and not self.pressed:
            return None
        known_layout = None if self.guessed else self.insole.layout
        events += self.health.update(t, known_at, pressure, phase, sample.gyro, known_layout)
        health = self.health
        odd = health.excluded or health.not_numbers or len(pressure) != health.count
        cells = health.usable(pressure) if odd else pressure
        if not cells:
            return None
        self.pressed = True
        layout = self.insole.layout
        if self.guessed and layout is not None and len(layout.cells) != len(cells):
            self._forget_layout()  # it was of another insole
        load = self.insole.update(t, cells)
        if self.settings.needs_pressure and self.insole.layout is None and load is not None:
            self._guess_layout(t, known_at, load, limitations, events)
        return load

    def pressed_by(self, t: float, known_at: float, pressure: tuple[float, ...]) -> FootPressed | None:
        """What the cells of the sample that was just pressed show; None when there was nothing that could be used."""
        insole, health = self.insole, self.health
        if not health.usable(pressure):
            return None
        values = insole.above_tare(insole.cells)
        if health.excluded or health.not_numbers:  # a cubic may make something of their 0
            silent = {*health.excluded, *[i for i, _ in health.not_numbers]}
            values = tuple([0.0 if i in silent else value for i, value in enumerate(values)])
        force = sum(values)
        centre, layout = None, insole.layout
        if layout is not None and not self.guessed and len(values) == len(layout.cells):
            # a foot in the air for long has a small reach of loads; its cells are less than what they have carried
            least = LEAST_LOAD * max(insole.total.high - insole.total.low, insole.highest)
            if force > least:
                centre = (sum(map(mul, layout.xs, values)) / force, sum(map(mul, layout.ys, values)) / force)
        return FootPressed(t=t, known_at=known_at, foot=self.foot, values=values, force=force, centre=centre)

    def _check_count(
        self, count: int, t: float, known_at: float, limitations: Limitations, events: list[Event]
    ) -> None:
        """A sample has `count` cells: whether the calibration is of this insole."""
        layout, noise = self.calibrated_layout, self.insole.settings.noise
        if layout is not None and len(layout.cells) == count:
            self.set_layout(layout, limitations)
            events.append(LayoutKnown(t=t, known_at=known_at, site=SITE_OF_FOOT[self.foot], layout=layout))
            layout = None
        odd = layout is not None or (bool(noise) and len(noise) != count)
        self.count_checked = not odd or limitations.check_cell_count(layout, noise, count, t, known_at, events)
        if odd and self.count_checked:
            self.calibrated_layout = None

    def _apply_layout(self, layout: Layout, limitations: Limitations) -> None:
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
            limitations.queue(what)
        self.layout_changed = True

    def _guess_layout(
        self, t: float, known_at: float, load: Load, limitations: Limitations, events: list[Event]
    ) -> None:
        layout = self.guess.update(t, self.insole.above_tare(load.cells), load.total)
        if layout is not None:
            what = f"nobody says where the cells of the {self.foot.value} insole are: learnt from how steps load them"
            limitations.report(what, t, known_at, events)
            self.guessed = True
            self._apply_layout(layout, limitations)

    def _forget_layout(self) -> None:
        self.guessed = False
        self.guess = LayoutGuess(self.foot)
        self.insole = evolve(self.insole)
