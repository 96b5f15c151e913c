"""Collects what the report of a walk needs from the events of its session, in bounded memory.

The limits below were chosen by hand and not swept."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping, Sequence
from importlib.metadata import PackageNotFoundError, version
from typing import TYPE_CHECKING

from attrs import define, evolve, field

from ...events import (
    Defect,
    DefectFound,
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
from ...types import Foot, Packet, Phase, Sample, Site
from ..observer import Observer
from .bands import Band
from .bounded import T, ThinnedList
from .clock import ReportClock
from .figures.track import TimedPosition
from .sections.heading import ReportDetails
from .soles import ReportSole

if TYPE_CHECKING:
    from ..outcomes.clinic import Clinic

MAX_STRIDES, MAX_PLACES, MAX_POINTS = 1200, 1000, 1500
"""Largest number of strides of a foot, of places on the plan, and of points of a track; more are thinned evenly."""
MAX_CANDIDATES = 40
"""Largest number of candidates of a place; those with the largest weights are kept."""
HEIGHT_INTERVAL = 0.5
"""Shortest time between two kept heights of a stationary foot, s."""


def _installed() -> str:
    try:
        return version("solepath")
    except PackageNotFoundError:  # solepath runs from a folder without being installed
        return ""


def _list_of_each_foot() -> dict[Foot, ThinnedList[T]]:
    return {foot: ThinnedList() for foot in Foot}


@define
class CollectedWalk:
    """The events of a session with `poses` and `pressures`, in bounded memory, as far as a report needs them.

    `source` is the recording's name. `plan` is the session's floor plan. `recipe` is the name of the recipe. `when` is
    the date and time of the walk, as in "2026-11-26 09:40 UTC". `version` is that of solepath. The report feeds
    `observer`, which counts the session. An event with a number that is not finite is left out."""

    source: str = ""
    plan: FloorPlan | None = None
    recipe: str = ""
    when: str = ""
    version: str = field(factory=_installed)
    observer: Observer = field(factory=Observer)
    details: ReportDetails = field(factory=ReportDetails)
    bands: Mapping[str, Band] = field(factory=dict)
    """Bands of reference by the names of the measures (measures.py)."""
    calibrated: bool = False
    """True if the session has a calibration."""
    before: CollectedWalk | None = None
    """Earlier walk with which this one is compared."""
    clinic: Clinic | None = field(default=None, init=False)
    """Clinical outcomes, which the report shows before the gait; None without any."""
    soles: dict[Foot, ReportSole] = field(factory=dict, init=False)
    strides: dict[Foot, ThinnedList[GaitCycleMeasured]] = field(factory=_list_of_each_foot, init=False)
    newest: deque[GaitCycleMeasured] = field(factory=lambda: deque(maxlen=2 * MAX_STRIDES), init=False)
    """Newest gait cycles of both feet, from which the differences between the feet follow."""
    defects: dict[tuple[Site, Defect], DefectFound] = field(factory=dict, init=False)
    """Newest report of each defect of each site."""
    distances: dict[Foot, ThinnedList[tuple[float, float]]] = field(factory=_list_of_each_foot, init=False)
    """Pairs of the end of a stride, s, and the distance that the foot has gone until then, m."""
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
                self.newest.append(event)
                self._sole(event.foot).add_cycle(event)
            case StrideTaken(final=True):
                self.footprints[event.foot].add(event, MAX_POINTS)
                self.distances[event.foot].add((event.t, self.observer.feet[event.foot].distance), MAX_POINTS)
            case WearerMoved():
                self.wearer_track.add(event, MAX_POINTS)
            case LayoutKnown(site=site, layout=layout) if site.foot is not None:
                self._sole(site.foot).layout = layout
            case Placed(candidates=candidates):
                self.places.add(evolve(event, candidates=candidates[:MAX_CANDIDATES]), MAX_PLACES)
            case PlaceLost():
                self.places.add(event, MAX_PLACES)
            case DefectFound(site=site, defect=defect):
                self.defects[site, defect] = event
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

    @property
    def foot_tracks(self) -> dict[Foot, list[TimedPosition]]:
        """Ends of the strides of each foot that took any."""
        return {foot: list(strides) for foot, strides in self.footprints.items() if len(strides)}

    @property
    def track(self) -> Sequence[TimedPosition]:
        """Track of the wearer or, if it is not known, that of the foot with the most strides."""
        return list(self.wearer_track) or max(self.foot_tracks.values(), key=len, default=[])


def _extend(span: tuple[float, float] | None, t: float) -> tuple[float, float]:
    return (t, t) if span is None else (min(span[0], t), max(span[1], t))
