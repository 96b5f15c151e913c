"""The right floor: walks over each kind of connector of a house, with a known start and without one.

    solepath-lab emulated floors [--walks N] [--seed S] [--only KIND]

prints tables as Markdown: with a known start, walks that end on the right floor within 3 m of
the wearer, walks whose floor is decided at the end and right, and walks with a floor that was decided and wrong, at
the end or, as when a flight is counted twice, anywhere; without a start, walks with the true place among the candidates
at the end. A wearer is drawn for each walk, comes to a connector of the house, takes it up or down, and walks away."""

from __future__ import annotations

from argparse import Namespace
from collections.abc import Callable
from functools import partial
from math import cos, pi, sin
from operator import add
from pathlib import Path

import numpy as np
from attrs import astuple, frozen

from solepath import recipes
from solepath.cli.common.processes import run_jobs
from solepath.emulate.routes.building import EDGE_OFFSET, GOING, GROUND, LANE_OFFSET, STOREY
from solepath.emulate.routes.course import Course
from solepath.emulate.routes.escalator import Escalator
from solepath.emulate.routes.path import ahead
from solepath.emulate.walk import emulate
from solepath.emulate.wearers.curves import Rng
from solepath.emulate.wearers.gait import Wearer
from solepath.events import Candidate, Placed
from solepath.floorplan.importers.reading import read_floorplan
from solepath.floorplan.index import IndexedPlan
from solepath.floorplan.plan import Start
from solepath.session import Session
from solepath.types import SITE_OF_FOOT, Foot
from solepath.validate.place import is_near

from ..tables import markdown
from .reliability import DEVICES, TITLES
from .wearers import random_wearer

LENGTH, DEPTH, HALF_WIDTH = 46.0, 14.0, 1.2
"""Length and depth of the ring of corridors, along their middles, and half of their width, m."""
EDGE = 3.0
"""Distance from the middle of the south corridor to the first edge of a straight flight, or to an escalator, m."""
STRAIGHT_RISERS = 20
"""Number of risers of a straight flight."""
STRAIGHT, ESCALATORS, TURNING, LIFTS = (7.0, 25.0), (12.0, 35.5), (18.0, 41.5), (21.5, 31.0)
"""Places of both connectors of each kind along the corridors, m."""
RAMP = 8.0, 1.0 / 12.0
"""Length of a ramp, m, and its rise over run, the steepest for wheelchairs (ADA Standards, 405.2)."""
HOUSE = read_floorplan(Path(__file__).with_name("house.geojson"))
"""A house of three storeys without symmetry: a ring of corridors with a spur, and shafts between the two long ones.

It has two connectors of each kind. Straight flights and escalators join its first two floors."""


@frozen
class FloorWalk:
    """A walk over a connector, from where it starts to where it ends."""

    course: Course
    levels: tuple[str, ...]
    """Levels of the walk in their order."""


def _follow(course: Course) -> None:
    """Set the place of a course after moves of its route."""
    end, heading = course.route.end, course.start.heading or 0.0
    (x, y), (c, s) = course.start.place or (0.0, 0.0), (cos(heading), sin(heading))
    course.position = (x + c * end.x - s * end.y, y + s * end.x + c * end.y)
    course.heading = heading + end.heading


def _aside(x: float, least: float, rng: Rng) -> float:
    """Return a way of `least` to 14 m along a corridor from `x`, m, to a side on which there is room for it."""
    return float(rng.uniform(least, 14.0)) * (1.0 if x < 14.0 or (x < LENGTH - 14.0 and rng.uniform() < 0.5) else -1.0)


def _arrive(level: str, x: float, y: float, corridor: float, rng: Rng) -> Course:
    """Return a course along the corridor to the place (x, y) of a connector."""
    away = _aside(x, 6.0, rng)
    offset = float(rng.uniform(-0.3, 0.3))
    course = Course(level, (x + away, corridor + offset), pi if away > 0.0 else 0.0)
    course.stand()
    course.walk_along([(x, corridor + offset), (x, y)])
    return course


def _leave(course: Course, corridor: float, rng: Rng) -> None:
    """Continue a course from a connector along the corridor."""
    x, _ = course.position
    away = _aside(x, 8.0, rng)
    course.walk_along([(x, corridor), (x + away, corridor)])
    course.stand()


def _straight(rng: Rng, kind: str, up: bool, back: bool = False) -> FloorWalk:
    """Return a walk over a straight flight, or an escalator on which the wearer stands or walks."""
    x = float(rng.choice(STRAIGHT if kind == "straight" else ESCALATORS))
    bottom, top = EDGE - ahead(True, GOING), EDGE + (STRAIGHT_RISERS - 1) * GOING + ahead(False, GOING)
    if kind != "straight":
        bottom, top = EDGE, EDGE + Escalator(STOREY).run
    levels = ["0", "1"] if up else ["1", "0"]
    course = _arrive(levels[0], x, bottom if up else top, 0.0 if up else DEPTH, rng)
    for k, way in enumerate([up, not up] if back else [up]):
        if k:
            course.walk(1.0)
            course.face(0.5 * pi if way else -0.5 * pi)
            course.walk(abs(course.position[1] - (bottom if way else top)))
        if kind == "straight":
            course.flight(way, STRAIGHT_RISERS)
        else:
            height = STOREY if way else -STOREY
            course.escalator(levels[1], height, walking=kind == "escalator, walking")
    _leave(course, DEPTH if up is not back else 0.0, rng)
    return FloorWalk(course, (*levels, levels[0]) if back else tuple(levels))


def _turning(rng: Rng, up: bool, storeys: int = 1, back: bool = False) -> FloorWalk:
    """Return a walk over stairs with a half-turn on the landing, over so many storeys, or up and back at once."""
    x, level = float(rng.choice(TURNING)), int(rng.integers(3 - storeys)) + (0 if up else storeys)
    lane = LANE_OFFSET if up else -LANE_OFFSET
    edge = HALF_WIDTH + EDGE_OFFSET - ahead(up, GOING)
    course, levels = _arrive(str(level), x + lane, edge, 0.0, rng), [level]
    ways = [up, not up] if back else [up] * storeys
    for k, way in enumerate(ways):
        if k:
            course.walk(0.8)
            if back:
                course.face(0.5 * pi)
            else:
                course.bend(pi if up else -pi, LANE_OFFSET)
            course.walk(HALF_WIDTH + EDGE_OFFSET - ahead(way, GOING) - course.position[1])
        course.level = GROUND  # the course knows two levels
        course.climb(way)
        levels.append(levels[-1] + (1 if way else -1))
    _leave(course, 0.0, rng)
    return FloorWalk(course, tuple(map(str, levels)))


def _lift(rng: Rng, up: bool, back: bool = False) -> FloorWalk:
    """Return a walk into a lift, by a storey, or there and back at once, and out of it."""
    x, level = float(rng.choice(LIFTS)), int(rng.integers(2)) + (not up)
    course, levels = _arrive(str(level), x, 2.6, 0.0, rng), [level]
    course.face(-0.5 * pi)
    for way in [up, not up] if back else [up]:
        levels.append(levels[-1] + (1 if way else -1))
        course.ride(str(levels[-1]), STOREY if way else -STOREY)
    _leave(course, 0.0, rng)
    return FloorWalk(course, tuple(map(str, levels)))


def _ramp(rng: Rng, up: bool) -> FloorWalk:
    """Return a walk over a ramp within a floor, which is no way to another one."""
    level, forwards = str(int(rng.integers(3))), rng.uniform() < 0.5
    course = Course(level, (8.0 if forwards else LENGTH - 8.0, 0.0), 0.0 if forwards else pi)
    course.stand()
    course.walk(float(rng.uniform(4.0, 8.0)))
    course.route = course.route.walk(RAMP[0], slope=RAMP[1] if up else -RAMP[1])
    _follow(course)
    course.walk(float(rng.uniform(8.0, 14.0)))
    course.stand()
    return FloorWalk(course, (level,))


KINDS: dict[str, Callable[[Rng, bool], FloorWalk]] = {
    "straight stairs": lambda rng, up: _straight(rng, "straight", up),
    "turning stairs": lambda rng, up: _turning(rng, up),
    "escalator, standing": lambda rng, up: _straight(rng, "escalator, standing", up),
    "escalator, walking": lambda rng, up: _straight(rng, "escalator, walking", up),
    "ramp within a floor": _ramp,
    "lift": lambda rng, up: _lift(rng, up),
    "two storeys in a row": lambda rng, up: _turning(rng, up, 2),
    "straight stairs and back": lambda rng, up: _straight(rng, "straight", up, back=True),
    "turning stairs and back": lambda rng, up: _turning(rng, up, back=True),
    "lift and back": lambda rng, up: _lift(rng, up, back=True),
}
"""A walk of each kind of way from one floor to another, upwards or downwards."""


@frozen
class FloorScore:
    """The score of one walk, each 1 or 0, or of several, added."""

    walks: int = 0
    right: int = 0
    """With a known start, the last place is the true one."""
    decided: int = 0
    """With a known start, the level at the end is decided (Placed.level_decided) and the true one."""
    wrong: int = 0
    """With a known start, a level is decided that is not the true one at the end, or that is not in the walk at all."""
    found: int = 0
    """Without a start, the true place is among the last candidates."""

    def __add__(self, other: FloorScore) -> FloorScore:
        return FloorScore(*map(add, astuple(self), astuple(other)))


def draw(kind: str, seed: int) -> tuple[FloorWalk, Wearer]:
    """Return a walk of a kind, and its wearer."""
    rng = np.random.default_rng([seed, 59])
    way = KINDS[kind](rng, bool(rng.integers(2)))
    return way, random_wearer(rng)[0]


def score_walk(recipe: str, job: tuple[str, int]) -> tuple[str, FloorScore]:
    """Return the kind of a walk, and its score with a recipe."""
    kind, seed = job
    way, wearer = draw(kind, seed)
    devices = {SITE_OF_FOOT[foot]: DEVICES[recipe] for foot in Foot}
    walk = emulate(way.course.route, wearer=wearer, devices=devices, seed=seed)
    end, plan = way.course.place(walk.walker, walk.truth.duration), IndexedPlan(HOUSE)

    def places(start: Start | None) -> tuple[tuple[Candidate, ...], list[str]]:
        """Return the last candidates, and the levels that were decided, "" at the end if none is then."""
        session = Session(recipes.by_name(recipe), floorplan=plan, start=start)
        placed = [one for one in session.feed(walk.packets) + session.finish() if isinstance(one, Placed)]
        decided = [one.level for one in placed if one.level_decided]
        last = session.place
        return () if last is None else last.candidates, [*decided, last.level if last and last.level_decided else ""]

    last, decided = places(way.course.start)
    others = places(None)[0] if len(way.levels) > 1 else last  # nothing tells a place without stairs or lifts
    is_true = [is_near(one, way.levels[-1], *end) for one in others]
    is_right = bool(last) and is_near(last[0], way.levels[-1], *end)
    is_wrong = decided[-1] not in ("", way.levels[-1]) or not set(decided) <= {"", *way.levels}
    return kind, FloorScore(1, is_right, decided[-1] == way.levels[-1], is_wrong, any(is_true))


def run(options: Namespace) -> int:
    """Print a table for each recipe; return the exit status."""
    kinds = [kind for kind in KINDS if not options.only or kind in options.only]
    jobs = [(kind, options.seed + k) for kind in kinds for k in range(options.walks)]
    for recipe in DEVICES:
        scores = dict.fromkeys(kinds, FloorScore())
        for kind, one in run_jobs(partial(score_walk, recipe), jobs, processes=options.processes):
            scores[kind] += one
        rows = [
            [kind, *[f"{part} of {one.walks}" for part in (one.right, one.decided, one.wrong, one.found)]]
            for kind, one in scores.items()
        ]
        columns = ("right place at the end", "right floor decided", "wrong floor decided", "no start: true place kept")
        print("\n".join([*markdown.table([TITLES[recipe], *columns], rows), ""]), flush=True)
    return 0
