"""A walk as one file: every event of its session in, a page to read, mail and print out."""

from __future__ import annotations

from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from xml.etree.ElementTree import Element

from attrs import define, evolve, field

from ...events import (
    ActivityChanged,
    Event,
    FootMoved,
    FootPressed,
    GaitCycleMeasured,
    LayoutKnown,
    Placed,
    PlaceLost,
    StrideTaken,
    WearerMoved,
)
from ...floorplan.plan import FloorPlan
from ...types import Foot, Phase
from ..tally import Tally
from .bounded import Thinned, coarser, sound
from .clock import ReportClock
from .figures.activity import activity_figure
from .figures.cycle import cycle_figure
from .figures.pressure import pressure_figures
from .figures.stride import DrawnStride, stride_figures
from .figures.track import Stood, height_figure, plan_figure, track_figure
from .gait_table import gait_tables
from .links import Links
from .markup import add, sentences, table
from .page import save, section, skeleton
from .soles import ReportSole
from .words import CAUTION, link_rows, overview, sensors, without, wrong

STRIDES, PLACES, POINTS = 1200, 1000, 1500
"""Kept of a foot's strides, of places on the plan, and of points of a track: more are thinned evenly."""
CANDIDATES = 40
"""Kept of a place's, the heaviest."""
CHANGES = 2000
"""Of activities; of more, the shortest are left out."""
OFTEN = 0.5
"""s: the height of a foot that stands is not looked at more often."""


NO_STRIDE = "No stride was measured, so that there are no gait parameters."
NO_STEADY = (
    "No stride was steady, so that there are no means: steady strides are neither first nor last of a walk, nor in a "
    "turn, on stairs or with samples missing."
)


def _installed() -> str:
    try:
        return version("solepath")
    except PackageNotFoundError:  # run from a folder of its own
        return ""


def _points() -> dict[Foot, Thinned[Stood]]:
    return {foot: Thinned(POINTS) for foot in Foot}


@define
class Report:
    """Gathers what a session with `poses` and `pressures` says, in bounded memory; then writes it down.

    `title`: what the page is called, such as the recording's name. `plan`: that the session had. `recipe`: its name.
    `when`: of the walk, as it shall be read: nothing in here looks at a clock. `version`: of solepath.
    An event with a number that is none is left out.
    """

    title: str
    plan: FloorPlan | None = None
    recipe: str = ""
    when: str = ""
    version: str = field(factory=_installed)
    # state
    tally: Tally = field(factory=Tally, init=False)
    links: Links = field(factory=Links, init=False)
    soles: dict[Foot, ReportSole] = field(factory=dict, init=False)
    strides: dict[Foot, Thinned[DrawnStride]] = field(init=False)
    prints: dict[Foot, Thinned[Stood]] = field(factory=_points, init=False)
    heights: dict[Foot, Thinned[Stood]] = field(factory=_points, init=False)
    way: Thinned[Stood] = field(factory=lambda: Thinned(POINTS), init=False)
    places: Thinned[Placed | PlaceLost] = field(factory=lambda: Thinned(PLACES), init=False)
    changes: int = field(default=0, init=False)
    """Of the activity, since the timeline was made coarser."""
    shortest: float = field(default=1.0, init=False)
    """s: what is left out of a timeline that is too long."""
    sampled: tuple[float, float] | None = field(default=None, init=False)
    """First and last sample, s ..."""
    spanned: tuple[float, float] | None = field(default=None, init=False)
    """... and of all events."""

    def __attrs_post_init__(self) -> None:
        self.strides = {foot: Thinned(STRIDES) for foot in Foot}

    def add(self, event: Event) -> None:
        """One event, in the order in which the session told them."""
        if not sound(event):
            return
        self.links.hear(event)
        self.spanned = _wider(self.spanned, event.t)
        match event:
            case FootMoved():
                self.sampled = _wider(self.sampled, event.t)
                self._height(event)
                return
            case FootPressed():
                self.sampled = _wider(self.sampled, event.t)
                self._sole(event.foot).press(event)
                return
            case GaitCycleMeasured():
                if event.stride_time < 1e-3:
                    return
                self.strides[event.foot].add(DrawnStride.of(event))
                self._sole(event.foot).stride(event)
            case StrideTaken(final=True):
                self.prints[event.foot].add(Stood(event.t, event.position))
            case WearerMoved():
                self.way.add(Stood(event.t, event.position))
                return
            case LayoutKnown(site=site, layout=layout) if site.foot is not None:
                self._sole(site.foot).layout = layout
            case Placed(candidates=candidates):
                self.places.add(evolve(event, candidates=candidates[:CANDIDATES]))
            case PlaceLost():
                self.places.add(event)
            case _:
                pass
        self.tally.add(event)
        if isinstance(event, ActivityChanged):
            self._changed(event.t)

    def _sole(self, foot: Foot) -> ReportSole:
        return self.soles.setdefault(foot, ReportSole())

    def _height(self, event: FootMoved) -> None:
        last = self.heights[event.foot].last
        if event.phase is Phase.STATIONARY and (last is None or not 0.0 <= event.t - last.t < OFTEN):
            self.heights[event.foot].add(Stood(event.t, event.position))

    def _changed(self, t: float) -> None:
        self.changes += 1
        if self.changes >= CHANGES:
            while len(self.tally.timeline.spans(t)) > CHANGES // 2:
                self.tally.timeline = coarser(self.tally.timeline, t, self.shortest)
                self.shortest *= 2.0
            self.changes = CHANGES // 2

    @property
    def clock(self) -> ReportClock:
        """How times are told."""
        begin, end = self.sampled or self.spanned or (0.0, 0.0)
        return ReportClock(begin, end)

    def write(self, path: Path) -> None:
        """The page into a file, UTF-8. OSError, naming the file, when it cannot be written (the disk is full)."""
        save(self.drawn(), path)

    def drawn(self) -> Element:
        """The page as an <html> element."""
        html, main = skeleton(self.title)
        clock = self.clock
        add(main, "h1", self.title)
        self._facts(main, clock)
        part = section(main, "summary", "Summary")
        measured = {foot: some.count for foot, some in self.strides.items()}
        sentences(part, overview(self.tally, clock, self.spanned is not None, measured, self.links.lasted()))
        part = section(main, "gait", "Gait")
        if not gait_tables(part, self.tally.gait):
            add(part, "p", NO_STRIDE if not any(measured.values()) else NO_STEADY)
        shown = add(part, "div", class_="figures")
        for running in (False, True):
            parameters = self.tally.gait.of(running)
            if parameters is not None:
                cycle_figure(shown, parameters)
        stride_figures(shown, {foot: list(some) for foot, some in self.strides.items()}, clock)
        self._track(section(main, "track-part", "Track"), clock)
        part = section(main, "pressure", "Pressure")
        if not pressure_figures(add(part, "div", class_="figures"), self.soles):
            add(part, "p", "There is no pressure in this recording.")
        part = section(main, "activity", "Activities")
        if not activity_figure(add(part, "div", class_="figures"), self.tally.timeline.spans(clock.end), clock):
            add(part, "p", "No activity was told.")
        self._health(section(main, "health", "Sensors and links"))
        return html

    def _facts(self, main: Element, clock: ReportClock) -> None:
        facts = add(main, "dl", class_="facts")
        when = f"{clock.begin:.1f} to {clock.end:.1f} s of its own clock" if self.spanned else ""
        told = [("When", self.when), ("Recording", when), ("Sensors", sensors(self.links))]
        told += [("Recipe", self.recipe), ("Made by", f"solepath {self.version}".rstrip())]
        for name, words in told:
            if words:
                add(facts, "dt", name)
                add(facts, "dd", words)
        add(main, "p", CAUTION, class_="caution")

    def _track(self, part: Element, clock: ReportClock) -> None:
        shown = add(part, "div", class_="figures")
        if self.plan is not None and not plan_figure(shown, self.plan, list(self.places)):
            add(shown, "p", "Where on the floor plan the wearer was is not known.")
        prints = {foot: list(some) for foot, some in self.prints.items() if len(some)}
        way = list(self.way) or max(prints.values(), key=len, default=[])
        if not track_figure(shown, way, prints, clock):
            add(shown, "p", "There is no track: no foot with a motion sensor took two steps.")
        height_figure(shown, {foot: list(some) for foot, some in self.heights.items()}, clock)

    def _health(self, part: Element) -> None:
        header, *rows = link_rows(self.links)
        if rows:
            table(part, "What came from each sensor", header, rows, "numbers links")
        told = wrong(self.tally)
        if told:
            add(part, "h3", "What was wrong")
            sentences(part, told)
        else:
            add(part, "p", "Nothing was wrong with the sensors and their links.")
        limits = without(self.tally)
        if limits:
            add(part, "h3", "What had to be done without")
            sentences(part, limits)


def _wider(span: tuple[float, float] | None, t: float) -> tuple[float, float]:
    return (t, t) if span is None else (min(span[0], t), max(span[1], t))
