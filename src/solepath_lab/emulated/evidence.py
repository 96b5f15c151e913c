"""Activities and place of emulated walks with pieces of evidence taken away: what each kind of evidence earns.

    solepath-lab emulated evidence [--walks N] [--seed S] [--only ROW] [--processes P] [--json FILE]

prints the tables of docs/activities.md as Markdown. For each seed a wearer walks a route of stairs, elevators and
corridors (train/emulated.py), which gives the activities, and another one through the emulated building (ways.py),
which gives the place. Evidence is taken away where it enters: values of samples, channels of packets, the first
heading, the floor plan."""

from __future__ import annotations

import json
from argparse import Namespace
from collections.abc import Callable, Iterable
from typing import Any

import numpy as np
from attrs import asdict, evolve, field, frozen

from solepath import recipes
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
from ..options import add_command, add_json, add_only, add_processes, add_seeds
from ..processes import run_jobs
from ..train.emulated import RATE, draw_route

FIRST_SEED, WALKS = 5001, 12
"""First seed, none of those for training, and number of walks."""
HEADING_ERROR = 0.1
"""Standard deviation of the first heading that is given, rad: 6 degrees, as a phone's compass may have."""
CELLS = 24
"""Number of cells of each insole."""
STAIRS = (Activity.STAIRS_UP, Activity.STAIRS_DOWN)

Item = Packet | Sample
Removal = Callable[[Item], Item | None]
"""Function that returns what remains of a packet or sample, None for nothing."""


@frozen
class Evidence:
    """A row of the tables: what is taken away."""

    name: str
    remove: Removal | None = None
    """None when packets and samples stay as they are."""
    heading: bool = True
    """Flag: the session has the first heading of the walk through the building."""
    plan: bool = True
    """Flag: the session has the floor plan; without it, the height of the track decides on which level it ends."""


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
    nearest: tuple[float, ...] = field(default=(), repr=False)
    """The same errors of the candidate nearest to the truth, m."""

    def __add__(self, other: WalkOutcome) -> WalkOutcome:
        return WalkOutcome(
            self.activity + other.activity,
            self.flights_right + other.flights_right,
            self.levels_right + other.levels_right,
            self.kept + other.kept,
            self.off + other.off,
            self.nearest + other.nearest,
        )


def _no_gyroscope(item: Item) -> Item | None:
    if isinstance(item, Sample):
        return evolve(item, gyro=None)
    return None if item.channel == "cc2541/gyroscope" else item


def _no_air_pressure(item: Item) -> Item | None:
    if isinstance(item, Sample):
        return evolve(item, air_pressure=None)
    return None if item.channel == "cc2541/barometer" else item


def _no_cells(item: Item) -> Item | None:
    return evolve(item, pressure=None) if isinstance(item, Sample) else item


def _left_foot(item: Item) -> Item | None:
    return item if item.site is Site.LEFT_FOOT else None


EVERYTHING, NO_GYROSCOPE = Evidence("everything"), Evidence("no gyroscope", _no_gyroscope)
ONE_FOOT, NO_AIR_PRESSURE = Evidence("one foot", _left_foot), Evidence("no air pressure", _no_air_pressure)
NO_CELLS = Evidence("no pressure cells", _no_cells)
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
    if evidence.remove is None:
        return items
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
        nearest=scored.nearest,
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


def line(name: str, outcome: WalkOutcome, walks: int, placed: bool = True) -> str:
    """Return a row of a table as Markdown; `placed` is False without a floor plan."""
    activity = outcome.activity
    cells = ["", "", "", ""]
    if activity.samples:
        down = activity.reported_for(Activity.STAIRS_DOWN)
        cells = [
            f"{100.0 * (activity.accuracy or 0.0):.1f} %",
            f"{down.get(Activity.STAIRS_DOWN, 0)} of {sum(down.values())}",
            f"{activity.rides_found} of {activity.rides_true}, {activity.rides_invented}",
            f"{outcome.flights_right} of {walks}",
        ]
    cells.append(f"{outcome.levels_right} of {walks}")
    distances = f"{np.mean(outcome.off):.2f}, {np.quantile(outcome.off, 0.95):.2f} m" if outcome.off else "none"
    cells += [distances, f"{outcome.kept} of {walks}"] if placed else ["", ""]
    return f"| {name} | {' | '.join(cells)} |"


def table(sensors: Sensors, outcomes: dict[str, WalkOutcome], walks: int) -> list[str]:
    """Return the lines of one table as Markdown."""
    lines = [f"| {sensors.title} | {' | '.join(COLUMNS)} |", "|---|" + "---:|" * len(COLUMNS)]
    return lines + [line(row.name, outcomes[row.name], walks, row.plan) for row in sensors.rows]


def _score_job(job: tuple[Sensors, int]) -> dict[str, WalkOutcome]:
    return score_seed(*job)


def add_to(commands: Any) -> None:
    """Add the command to the parser."""
    command = add_command(commands, "evidence", "activities and place with evidence taken away", __doc__ or "")
    add_seeds(command, WALKS, FIRST_SEED)
    add_only(command, "row, such as 'everything'")
    add_processes(command)
    add_json(command)
    command.set_defaults(run=run)


def run(options: Namespace) -> int:
    """Print the tables; return the exit status."""
    figures: dict[str, dict[str, object]] = {}
    for number, every_row in enumerate(TABLES):
        rows = tuple([row for row in every_row.rows if not options.only or row.name in options.only])
        sensors, total = evolve(every_row, rows=rows), {row.name: WalkOutcome() for row in rows}
        seeds = range(options.seed, options.seed + options.walks)
        jobs = [(sensors, seed) for seed in seeds]
        for outcomes in run_jobs(_score_job, jobs, processes=options.processes):
            total = {name: total[name] + outcome for name, outcome in outcomes.items()}
        lines = table(sensors, total, options.walks)
        print("\n".join(([""] if number else []) + lines), flush=True)
        figures[sensors.title] = {name: _figures(outcome) for name, outcome in total.items()}
    if options.json is not None:
        options.json.write_text(json.dumps({"walks": options.walks, "seed": options.seed, "tables": figures}, indent=1))
    return 0


def _figures(outcome: WalkOutcome) -> dict[str, object]:
    """Return the figures of a row for JSON."""
    counts = asdict(
        outcome, recurse=False, filter=lambda attribute, _: attribute.name not in ("activity", "off", "nearest")
    )
    down = outcome.activity.reported_for(Activity.STAIRS_DOWN)
    return {
        **(outcome.activity.figures if outcome.activity.samples else {}),
        "stairs_down": sum(down.values()),
        "stairs_down_right": down.get(Activity.STAIRS_DOWN, 0),
        **counts,
        "place_mean": float(np.mean(outcome.off)) if outcome.off else None,
        "nearest_candidate_mean": float(np.mean(outcome.nearest)) if outcome.nearest else None,
        "place_95": float(np.quantile(outcome.off, 0.95)) if outcome.off else None,
    }
