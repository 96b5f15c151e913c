"""Activities and place of emulated walks with pieces of evidence taken away: what each kind of evidence earns.

    solepath-lab emulated evidence [--walks N] [--seed S] [--only ROW] [--processes P]

prints tables as Markdown. For each seed a wearer walks a route of stairs, elevators and
corridors (train/emulated.py), which gives the activities, and another one through the emulated building (ways.py),
which gives the place. Evidence is taken away where it enters: values of samples, channels of packets, the first
heading, the floor plan."""

from __future__ import annotations

from argparse import Namespace
from collections.abc import Callable, Iterable
from functools import partial
from operator import add
from typing import Any

import numpy as np
from attrs import astuple, evolve, field, frozen

from solepath import recipes
from solepath.cli.common.processes import run_jobs
from solepath.emulate.routes.building import BUILDING
from solepath.emulate.routes.route import Route
from solepath.emulate.routes.ways import BuildingWalk, wandering
from solepath.emulate.sensors.insole_device import Insole
from solepath.emulate.sensors.sensortags import CC2541
from solepath.emulate.walk import EmulatedWalk, SampledWalk, emulate, sampled
from solepath.emulate.wearers.gait import Wearer
from solepath.emulate.wearers.shoe import IN_SOLE
from solepath.events import FlightClimbed
from solepath.floorplan.index import IndexedPlan
from solepath.floorplan.plan import Start
from solepath.session import Session
from solepath.types import SITE_OF_FOOT, Activity, Foot, Packet, Sample, Site
from solepath.validate.place import score
from solepath.walk.walk import Walk

from ..evaluate.activity import score_rides, score_windows
from ..measures.confusion import ActivityScore
from ..tables import markdown
from ..train.emulated import RATE, draw_route

HEADING_ERROR = 0.1
"""Standard deviation of the first heading that is given, rad: 6 degrees, as a phone's compass may have."""
CELLS = 24
"""Number of cells of each insole."""
STAIRS = (Activity.STAIRS_UP, Activity.STAIRS_DOWN)

Item = Packet | Sample


@frozen
class Evidence:
    """A row of the tables: what is taken away."""

    name: str
    quantity: str = ""
    """Field of samples that is not known."""
    channel: str = ""
    """Channel of packets that are left out."""
    site: Site | None = None
    """The only site whose packets and samples are left; None leaves all."""
    heading: bool = True
    """Flag: the session has the first heading of the walk through the building."""
    plan: bool = True
    """Flag: the session has the floor plan; without it, the height of the track decides on which level it ends."""

    def remove(self, item: Item) -> Item | None:
        """Return what remains of a packet or sample, None for nothing."""
        if self.site not in (None, item.site):
            return None
        if isinstance(item, Packet):
            return None if item.channel == self.channel else item
        missing: dict[str, Any] = {self.quantity: None} if self.quantity else {}
        return evolve(item, **missing)


@frozen
class Sensors:
    """A table: a recipe and the sensors on both feet."""

    title: str
    recipe: str
    walk: Callable[[Route, Wearer | None, int], EmulatedWalk | SampledWalk]
    """Function of the route, the wearer and the seed."""
    rows: tuple[Evidence, ...]


@frozen
class WalkOutcome:
    """The scores of one seed or, added, of several."""

    activity: ActivityScore = field(factory=ActivityScore)
    """Score of the windows of two seconds and of the rides; empty for a row that does not change the activities."""
    flights_right: int = 0
    """Number of walks whose flights of stairs, in their order and with their directions, are all right."""
    levels_right: int = 0
    """Number of walks that end on the right level."""
    kept: int = 0
    """Number of walks that never lose the true candidate after the first place."""
    off: tuple[float, ...] = field(default=(), repr=False)
    """Errors of the place after each scored stride (place.py), m."""

    def __add__(self, other: WalkOutcome) -> WalkOutcome:
        return WalkOutcome(*map(add, astuple(self, recurse=False), astuple(other, recurse=False)))


EVERYTHING, NO_GYROSCOPE = Evidence("everything"), Evidence("no gyroscope", "gyro", "cc2541/gyroscope")
ONE_FOOT = Evidence("one foot", site=Site.LEFT_FOOT)
NO_AIR_PRESSURE = Evidence("no air pressure", "air_pressure", "cc2541/barometer")
NO_CELLS = Evidence("no pressure cells", "pressure")
NO_HEADING = Evidence("no first heading", heading=False)
NO_PLAN = Evidence("no floor plan: levels by heights alone", plan=False)


def _tag_walk(route: Route, wearer: Wearer | None, seed: int) -> EmulatedWalk:
    tags = {SITE_OF_FOOT[foot]: CC2541(rate=RATE, mounting=IN_SOLE) for foot in Foot}
    return emulate(route, wearer=wearer, devices=tags, seed=seed)


def _insole_walk(route: Route, wearer: Wearer | None, seed: int) -> SampledWalk:
    insoles = {SITE_OF_FOOT[foot]: Insole(cells=CELLS) for foot in Foot}
    return sampled(route, wearer=wearer, insoles=insoles, seed=seed)


_TAG_ROWS = (EVERYTHING, NO_GYROSCOPE, ONE_FOOT, NO_AIR_PRESSURE, NO_HEADING, NO_PLAN)
_INSOLE_ROWS = (EVERYTHING, NO_GYROSCOPE, ONE_FOOT, NO_CELLS, NO_HEADING, NO_PLAN)
TABLES = (
    Sensors("`default`, insoles at 100 Hz", "default", _insole_walk, _INSOLE_ROWS),
    Sensors("`default`, CC2541 at 20 Hz with barometers", "default", _tag_walk, _TAG_ROWS),
    Sensors("`footstep-tracker`, the same sensors", "footstep-tracker", _tag_walk, _TAG_ROWS),
)
"""The tables, in the order of the page."""
_ELEVATIONS = {level.id: level.elevation for level in BUILDING.levels}


def _items(walk: EmulatedWalk | SampledWalk, evidence: Evidence) -> Iterable[Item]:
    items: Iterable[Item] = walk.packets if isinstance(walk, EmulatedWalk) else walk.samples
    return [left for left in map(evidence.remove, items) if left is not None]


def _score_activities(recipe: str, walk: EmulatedWalk | SampledWalk, evidence: Evidence) -> WalkOutcome:
    session, truth = Session(recipes.by_name(recipe)), walk.truth
    events = session.feed(_items(walk, evidence)) + session.finish()
    found = Walk.of(events)
    windows = score_windows(truth.activities, found.timeline) + score_rides(truth.activities, list(found.rides))
    ups = [event.up for event in events if isinstance(event, FlightClimbed)]
    true_ups = [span[2] is Activity.STAIRS_UP for span in truth.activities if span[2] in STAIRS]
    return WalkOutcome(windows, flights_right=int(ups == true_ups))


def _score_place(
    recipe: str, way: BuildingWalk, walk: EmulatedWalk | SampledWalk, evidence: Evidence, heading: float
) -> WalkOutcome:
    plan = IndexedPlan(BUILDING) if evidence.plan else None
    start = Start(heading=heading) if evidence.plan and evidence.heading else None
    session = Session(recipes.by_name(recipe), floorplan=plan, start=start)
    events = session.feed(_items(walk, evidence)) + session.finish()
    ((true_level, _, _),) = way.places(walk.walker, walk.truth.duration)
    if plan is None:
        here = session.position
        z = _ELEVATIONS[way.start.level] + (0.0 if here is None else here.position[2])
        level = min(_ELEVATIONS, key=lambda name: abs(_ELEVATIONS[name] - z))
        return WalkOutcome(levels_right=int(level == true_level))
    place, scored = session.place, score(way, walk.walker, walk.truth, events)
    return WalkOutcome(
        levels_right=int(place is not None and place.level == true_level),
        kept=int(scored.strides > 0 and scored.dropped == 0),
        off=scored.off,
    )


def score_seed(sensors: Sensors, seed: int) -> dict[str, WalkOutcome]:
    """Return the outcome of each row of a table for both walks of a seed."""
    route, wearer = draw_route(seed)
    way = wandering(seed)
    walk, place_walk = sensors.walk(route, wearer, seed), sensors.walk(way.route, None, seed)
    heading = (way.start.heading or 0.0) + float(np.random.default_rng(seed).normal(0.0, HEADING_ERROR))
    outcomes: dict[str, WalkOutcome] = {}
    for evidence in sensors.rows:
        outcome = _score_place(sensors.recipe, way, place_walk, evidence, heading)
        if evidence in (NO_HEADING, NO_PLAN):  # which activities do not use
            outcomes[evidence.name] = outcome
        else:
            outcomes[evidence.name] = outcome + _score_activities(sensors.recipe, walk, evidence)
    return outcomes


COLUMNS = (
    "windows right", "of stairs down", "rides found, invented", "flights right", "level at the end",
    "place: mean, 95 %", "true candidate kept",
)  # fmt: skip
"""Titles of the columns after the first one."""


def cells(name: str, outcome: WalkOutcome, walks: int, placed: bool = True) -> list[str]:
    """Return the cells of a row; `placed` is False without a floor plan."""
    activity, found = outcome.activity, [""] * 4
    if activity.samples:
        down = activity.reported_for(Activity.STAIRS_DOWN)
        found = [
            f"{100.0 * (activity.accuracy or 0.0):.1f} %",
            f"{down[Activity.STAIRS_DOWN]} of {down.total()}",
            f"{activity.rides_found} of {activity.rides_true}, {activity.rides_invented}",
            f"{outcome.flights_right} of {walks}",
        ]
    distances = f"{np.mean(outcome.off):.2f}, {np.quantile(outcome.off, 0.95):.2f} m" if outcome.off else "none"
    place = [distances, f"{outcome.kept} of {walks}"] if placed else ["", ""]
    return [name, *found, f"{outcome.levels_right} of {walks}", *place]


def table(sensors: Sensors, outcomes: dict[str, WalkOutcome], walks: int) -> list[str]:
    """Return the lines of one table as Markdown."""
    rows = [cells(row.name, outcomes[row.name], walks, row.plan) for row in sensors.rows]
    return markdown.table([sensors.title, *COLUMNS], rows)


def run(options: Namespace) -> int:
    """Print the tables; return the exit status."""
    for number, whole in enumerate(TABLES):
        rows = tuple([row for row in whole.rows if not options.only or row.name in options.only])
        sensors = evolve(whole, rows=rows)
        total = {row.name: WalkOutcome() for row in sensors.rows}
        seeds = range(options.seed, options.seed + options.walks)
        for outcomes in run_jobs(partial(score_seed, sensors), seeds, processes=options.processes):
            total = {name: total[name] + outcome for name, outcome in outcomes.items()}
        print("\n".join([*[""] * bool(number), *table(sensors, total, options.walks)]), flush=True)
    return 0
