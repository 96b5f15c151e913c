"""Writes a walk as one HTML file, to read, mail and print, from all events of its session."""

from __future__ import annotations

from collections.abc import Sequence
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from xml.etree.ElementTree import Element, tostring

from attrs import define, evolve, field

from ...events import (
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
from ...types import Foot, Packet, Phase, Sample
from ..observer import Observer
from ..output import os_errors_naming
from .bounded import T, ThinnedList
from .clock import ReportClock
from .figures.activity import activity_figure
from .figures.cycle import cycle_figure
from .figures.pressure import pressure_figures
from .figures.stride import stride_figures
from .figures.track import TimedPosition, height_figure, plan_figure, track_figure
from .gait_table import gait_tables
from .markup import add, section, sentences, skeleton, table, terms
from .soles import ReportSole
from .words import CAUTION, limitations, link_rows, overview, problems, sensors

MAX_STRIDES, MAX_PLACES, MAX_POINTS = 1200, 1000, 1500
"""Strides of a foot, places on the plan, and points of a track that are kept: more are thinned evenly."""
MAX_CANDIDATES = 40
"""Candidates of a place that are kept, the heaviest."""
HEIGHT_INTERVAL = 0.5
"""Shortest time between two heights of a standing foot that are kept, s."""


NO_STRIDE = "No stride was measured, so that there are no gait parameters."
NO_STEADY = (
    "No stride was steady, so that there are no means: steady strides are neither first nor last of a walk, nor in a "
    "turn, on stairs or with samples missing."
)


def _installed() -> str:
    try:
        return version("solepath")
    except PackageNotFoundError:  # solepath runs from a folder without being installed
        return ""


def _of_both() -> dict[Foot, ThinnedList[T]]:
    return {foot: ThinnedList() for foot in Foot}


@define
class Report:
    """Gathers what a session with `poses` and `pressures` reports, in bounded memory, then writes it.

    `title` is the title of the page, such as the recording's name. `plan` is the plan that the session had. `recipe` is
    the name of the recipe. `when` is the time of the walk as text: the report reads no clock. `version` is that of
    solepath. `observer` belongs to that session; the report feeds it. An event with a number that is not finite is left
    out."""

    title: str
    plan: FloorPlan | None = None
    recipe: str = ""
    when: str = ""
    version: str = field(factory=_installed)
    observer: Observer = field(factory=Observer)
    soles: dict[Foot, ReportSole] = field(factory=dict, init=False)
    strides: dict[Foot, ThinnedList[GaitCycleMeasured]] = field(factory=_of_both, init=False)
    footprints: dict[Foot, ThinnedList[StrideTaken]] = field(factory=_of_both, init=False)
    heights: dict[Foot, ThinnedList[FootMoved]] = field(factory=_of_both, init=False)
    wearer_track: ThinnedList[WearerMoved] = field(factory=ThinnedList, init=False)
    places: ThinnedList[Placed | PlaceLost] = field(factory=ThinnedList, init=False)
    sample_span: tuple[float, float] | None = field(default=None, init=False)
    """Times of the first and the last sample, s."""
    event_span: tuple[float, float] | None = field(default=None, init=False)
    """Times of the earliest and the latest event, s."""

    def take(self, item: Packet | Sample | None, events: Sequence[Event]) -> None:
        """Add what the session was fed and the events that it returned for it.

        An item of None means that nothing came: time passed or the session ended."""
        self.observer.count_item(item, events)
        for event in events:
            if self.observer.add(event):
                self._draw(event)

    def _draw(self, event: Event) -> None:
        self.event_span = _extend(self.event_span, event.t)
        match event:
            case FootMoved():
                self.sample_span = _extend(self.sample_span, event.t)
                self._height(event)
            case FootPressed():
                self.sample_span = _extend(self.sample_span, event.t)
                self._sole(event.foot).add_sample(event)
            case GaitCycleMeasured():
                self.strides[event.foot].add(event, MAX_STRIDES)
                self._sole(event.foot).stride(event)
            case StrideTaken(final=True):
                self.footprints[event.foot].add(event, MAX_POINTS)
            case WearerMoved():
                self.wearer_track.add(event, MAX_POINTS)
            case LayoutKnown(site=site, layout=layout) if site.foot is not None:
                self._sole(site.foot).layout = layout
            case Placed(candidates=candidates):
                self.places.add(evolve(event, candidates=candidates[:MAX_CANDIDATES]), MAX_PLACES)
            case PlaceLost():
                self.places.add(event, MAX_PLACES)
            case _:
                pass

    def _sole(self, foot: Foot) -> ReportSole:
        return self.soles.setdefault(foot, ReportSole())

    def _height(self, event: FootMoved) -> None:
        last = self.heights[event.foot].last
        if event.phase is Phase.STATIONARY and (last is None or not 0.0 <= event.t - last.t < HEIGHT_INTERVAL):
            self.heights[event.foot].add(event, MAX_POINTS)

    @property
    def clock(self) -> ReportClock:
        """Clock of the report's times."""
        start, end = self.sample_span or self.event_span or (0.0, 0.0)
        return ReportClock(start, end)

    def write(self, path: Path) -> None:
        """Write the page to a file, UTF-8. OSError, naming the file, when it cannot be written (the disk is full)."""
        with os_errors_naming(path):
            path.write_bytes(self.text().encode("utf-8"))

    def text(self) -> str:
        """Return the page as HTML."""
        html, main = skeleton(self.title)
        clock = self.clock
        add(main, "h1", self.title)
        self._facts(main, clock)
        part = section(main, "summary", "Summary")
        measured = {foot: some.count for foot, some in self.strides.items()}
        sentences(part, overview(self.observer, clock, self.event_span is not None, measured))
        part = section(main, "gait", "Gait")
        if not gait_tables(part, self.observer.gait):
            add(part, "p", NO_STRIDE if not any(measured.values()) else NO_STEADY)
        shown = add(part, "div", class_="figures")
        for running in (False, True):
            parameters = self.observer.gait.of(running)
            if parameters is not None:
                cycle_figure(shown, parameters)
        stride_figures(shown, {foot: list(some) for foot, some in self.strides.items()}, clock)
        self._track(section(main, "track-part", "Track"), clock)
        part = section(main, "pressure", "Pressure")
        if not pressure_figures(add(part, "div", class_="figures"), self.soles):
            add(part, "p", "There is no pressure in this recording.")
        part = section(main, "activity", "Activities")
        if not activity_figure(add(part, "div", class_="figures"), self.observer.timeline.spans(clock.end), clock):
            add(part, "p", "No activity was reported.")
        self._health(section(main, "health", "Sensors and links"))
        return "<!DOCTYPE html>\n" + tostring(html, encoding="unicode", method="html") + "\n"

    def _facts(self, main: Element, clock: ReportClock) -> None:
        when = f"{clock.start:.1f} to {clock.end:.1f} s of its own clock" if self.event_span else ""
        facts = [("When", self.when), ("Recording", when), ("Sensors", sensors(self.observer))]
        facts += [("Recipe", self.recipe), ("Made by", f"solepath {self.version}".rstrip())]
        terms(main, [(name, words) for name, words in facts if words], class_="facts")
        add(main, "p", CAUTION, class_="caution")

    def _track(self, part: Element, clock: ReportClock) -> None:
        shown = add(part, "div", class_="figures")
        if self.plan is not None and not plan_figure(shown, self.plan, list(self.places)):
            add(shown, "p", "Where on the floor plan the wearer was is not known.")
        footprints = {foot: list(some) for foot, some in self.footprints.items() if len(some)}
        wearer_track: Sequence[TimedPosition] = list(self.wearer_track) or max(footprints.values(), key=len, default=[])
        if not track_figure(shown, wearer_track, footprints, clock):
            add(shown, "p", "There is no track: no foot with a motion sensor took two steps.")
        height_figure(shown, {foot: list(some) for foot, some in self.heights.items()}, clock)

    def _health(self, part: Element) -> None:
        header, *rows = link_rows(self.observer)
        if rows:
            table(part, "What came from each sensor", header, rows, "numbers links")
        found = problems(self.observer)
        if found:
            add(part, "h3", "What was wrong")
            sentences(part, found)
        else:
            add(part, "p", "Nothing was wrong with the sensors and their links.")
        limits = limitations(self.observer)
        if limits:
            add(part, "h3", "What had to be done without")
            sentences(part, limits)


def _extend(span: tuple[float, float] | None, t: float) -> tuple[float, float]:
    return (t, t) if span is None else (min(span[0], t), max(span[1], t))
