"""Writes a walk as one HTML file, to read, mail and print, from the events of its session.

The limits below were chosen by hand and not swept."""

from __future__ import annotations

from collections.abc import Sequence
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import TYPE_CHECKING
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
from .figures.space import space_figure
from .figures.stride import stride_figures
from .figures.track import TimedPosition, height_figure, plan_figure, track_figure
from .gait_table import gait_tables
from .markup import add, section, sentences, skeleton, table, terms
from .soles import ReportSole
from .words import CAUTION, defects, limitations, link_rows, overview, problems, sensors

if TYPE_CHECKING:
    from ..outcomes.clinic import Clinic

MAX_STRIDES, MAX_PLACES, MAX_POINTS = 1200, 1000, 1500
"""Largest number of strides of a foot, of places on the plan, and of points of a track; more are thinned evenly."""
MAX_CANDIDATES = 40
"""Largest number of candidates of a place; those with the largest weights are kept."""
HEIGHT_INTERVAL = 0.5
"""Shortest time between two kept heights of a stationary foot, s."""

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


def _list_of_each_foot() -> dict[Foot, ThinnedList[T]]:
    return {foot: ThinnedList() for foot in Foot}


@define
class Report:
    """Collects the events of a session with `poses` and `pressures`, in bounded memory, then writes the report.

    `title` is the title of the page, such as the recording's name. `plan` is the session's floor plan. `recipe` is the
    name of the recipe. `when` is the date and time of the walk, as text. `version` is that of solepath. The report
    feeds `observer`, which counts the session. An event with a number that is not finite is left out."""

    title: str
    plan: FloorPlan | None = None
    recipe: str = ""
    when: str = ""
    version: str = field(factory=_installed)
    observer: Observer = field(factory=Observer)
    clinic: Clinic | None = field(default=None, init=False)
    """Clinical outcomes, which the report shows before the gait; None without any."""
    soles: dict[Foot, ReportSole] = field(factory=dict, init=False)
    strides: dict[Foot, ThinnedList[GaitCycleMeasured]] = field(factory=_list_of_each_foot, init=False)
    footprints: dict[Foot, ThinnedList[StrideTaken]] = field(factory=_list_of_each_foot, init=False)
    heights: dict[Foot, ThinnedList[FootMoved]] = field(factory=_list_of_each_foot, init=False)
    wearer_track: ThinnedList[WearerMoved] = field(factory=ThinnedList, init=False)
    places: ThinnedList[Placed | PlaceLost] = field(factory=ThinnedList, init=False)
    sample_span: tuple[float, float] | None = field(default=None, init=False)
    """Times of the first and the last sample, s."""
    event_span: tuple[float, float] | None = field(default=None, init=False)
    """Times of the earliest and the latest event, s."""

    def take(self, item: Packet | Sample | None, events: Sequence[Event]) -> None:
        """Add a packet or sample that the session was fed, and the events that it returned.

        None as the item means that nothing came: time passed or the session ended."""
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
                self._sole(event.foot).add_cycle(event)
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
        """Clock from the first to the last sample, or from the first to the last event if there are no samples."""
        start, end = self.sample_span or self.event_span or (0.0, 0.0)
        return ReportClock(start, end)

    def write(self, path: Path) -> None:
        """Write the page to a file, UTF-8; raise OSError, naming the file, when it cannot be written."""
        with os_errors_naming(path):
            path.write_bytes(self.text().encode("utf-8"))

    def text(self) -> str:
        """Return the page as HTML."""
        html, main = skeleton(self.title)
        clock = self.clock
        add(main, "h1", self.title)
        self._facts(main, clock)
        parent = section(main, "summary", "Summary")
        if self.observer.defects:
            add(parent, "h3", "What cannot be right")
            sentences(parent, defects(self.observer))
        stride_counts = {foot: strides.count for foot, strides in self.strides.items()}
        sentences(parent, overview(self.observer, clock, self.event_span is not None, stride_counts))
        if self.clinic is not None:
            from .clinical import clinical_sections

            clinical_sections(main, self.clinic)
        parent = section(main, "gait", "Gait")
        if not gait_tables(parent, self.observer.gait):
            add(parent, "p", NO_STRIDE if not any(stride_counts.values()) else NO_STEADY)
        figures = add(parent, "div", class_="figures")
        for running in (False, True):
            parameters = self.observer.gait.of(running)
            if parameters is not None:
                cycle_figure(figures, parameters)
        stride_figures(figures, {foot: list(strides) for foot, strides in self.strides.items()}, clock)
        self._track(section(main, "track-part", "Track"), clock)
        parent = section(main, "pressure", "Pressure")
        if not pressure_figures(add(parent, "div", class_="figures"), self.soles):
            add(parent, "p", "There is no pressure in this recording.")
        parent = section(main, "activity", "Activities")
        if not activity_figure(add(parent, "div", class_="figures"), self.observer.timeline.spans(clock.end), clock):
            add(parent, "p", "No activity was reported.")
        self._health(section(main, "health", "Sensors and links"))
        return "<!DOCTYPE html>\n" + tostring(html, encoding="unicode", method="html") + "\n"

    def _facts(self, main: Element, clock: ReportClock) -> None:
        when = f"{clock.start:.1f} to {clock.end:.1f} s of its own clock" if self.event_span else ""
        facts = [("When", self.when), ("Recording", when), ("Sensors", sensors(self.observer))]
        facts += [("Recipe", self.recipe), ("Made by", f"solepath {self.version}".rstrip())]
        terms(main, [(name, words) for name, words in facts if words], class_="facts")
        add(main, "p", CAUTION, class_="caution")

    def _track(self, parent: Element, clock: ReportClock) -> None:
        figures = add(parent, "div", class_="figures")
        if self.plan is not None and not plan_figure(figures, self.plan, list(self.places)):
            add(figures, "p", "Where on the floor plan the wearer was is not known.")
        footprints = {foot: list(strides) for foot, strides in self.footprints.items() if len(strides)}
        wearer_track: Sequence[TimedPosition] = list(self.wearer_track) or max(footprints.values(), key=len, default=[])
        if not track_figure(figures, wearer_track, footprints, clock):
            add(figures, "p", "There is no track: no foot with a motion sensor took two strides.")
        space_figure(figures, wearer_track)
        height_figure(figures, {foot: list(heights) for foot, heights in self.heights.items()}, clock)

    def _health(self, parent: Element) -> None:
        header, *rows = link_rows(self.observer)
        if rows:
            table(parent, "What came from each sensor", header, rows, "numbers links")
        faults = problems(self.observer)
        if faults:
            add(parent, "h3", "What was wrong")
            sentences(parent, faults)
        else:
            add(parent, "p", "Nothing was wrong with the sensors and their links.")
        limits = limitations(self.observer)
        if limits:
            add(parent, "h3", "What had to be done without")
            sentences(parent, limits)


def _extend(span: tuple[float, float] | None, t: float) -> tuple[float, float]:
    return (t, t) if span is None else (min(span[0], t), max(span[1], t))
