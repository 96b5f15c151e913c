"""Place on the floor plan (figs. 13 f to h, 14 and 15): by one foot, by two, with walls that drop and with weights.

The way of the paper's case study is walked in FOUR_LOOPS, which has no symmetry; ways of the wearer's own are walked
there and in HALF_TURN, whose halves differ in nothing but where they lie, so that only a heading tells them apart."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from math import hypot

import numpy as np

from solepath.emulate.routes.building import BUILDING, FOUR_LOOPS
from solepath.emulate.routes.ways import BuildingWalk, case_study, wandering
from solepath.emulate.walk import EmulatedWalk
from solepath.events import Event, Placed, TurnMade
from solepath.floorplan.plan import Start
from solepath.papers.footstep_tracker.recipe import FOOTSTEP_TRACKER, FOOTSTEP_TRACKER_PRINTED
from solepath.recipes import Recipe
from solepath.session import Session
from solepath.types import Packet, Site
from solepath.validate import place as emulated_place
from solepath.validate.place import PlaceScore, is_on_floor

from ...emulated.buildings import HALF_TURN
from ...emulated.evidence import HEADING_ERROR
from ..tables import DrawStyle, PictureTrack, Plot, Values, WalkResults
from .wearers import DROPS_AT_WALLS, WearerJob

VARIANTS = {"ours": FOOTSTEP_TRACKER, "dropped at walls": DROPS_AT_WALLS, "printed": FOOTSTEP_TRACKER_PRINTED}


def score_places(job: WearerJob) -> WalkResults:
    """Return the places of one wearer: mean errors from the second turn on, m, and whether the true one was kept, %.

    "(by stride) VARIANT" are errors after each placed stride of the case study, m, and "(by turn) VARIANT" mean errors
    between each of its turns and the next one."""
    values = Values()

    def add(title: str, way: BuildingWalk, walk: EmulatedWalk, events: list[Event]) -> PlaceScore:
        score = emulated_place.score(way, walk.walker, walk.truth, events)
        values[f"place, {title} m"] = (sum(score.off) / len(score.off),) if score.off else ()
        values[f"true one kept, {title} %"] = (100.0 if score.strides and not score.dropped else 0.0,)
        return score

    way = case_study()
    walk = job.walk(way.route)
    one_foot = _run(FOOTSTEP_TRACKER, [packet for packet in walk.packets if packet.site is Site.RIGHT_FOOT], way)
    add("case study, one foot", way, walk, one_foot)
    runs = {name: _run(recipe, walk.packets, way) for name, recipe in VARIANTS.items()}
    drawn, *_ = (add(f"case study, {name}", way, walk, events) for name, events in runs.items())
    for name, events in {"one foot": one_foot, "two feet": runs["ours"]}.items():
        values[f"(by stride) {name}"], values[f"(by turn) {name}"] = _errors(way, walk, events)
    values["place m"] = values["place, case study, ours m"]
    values["steps until decided"] = () if drawn.decided is None else (float(drawn.decided),)

    way = wandering(job.seed, FOUR_LOOPS)
    walk = job.walk(way.route, more=800)
    for name in ("ours", "dropped at walls"):
        add(f"own ways, {name}", way, walk, _run(VARIANTS[name], walk.packets, way))
    way = wandering(job.seed, HALF_TURN)
    walk = job.walk(way.route, more=800)
    error = float(np.random.default_rng([job.seed, 19]).normal(0.0, HEADING_ERROR))
    for name, start in {"no heading": None, "first heading": Start(heading=(way.start.heading or 0.0) + error)}.items():
        add(f"half-turn plan, {name}", way, walk, _run(FOOTSTEP_TRACKER, walk.packets, way, start))
    return WalkResults(values, (_floor(drawn),))


def _run(recipe: Recipe, packets: Sequence[Packet], way: BuildingWalk, start: Start | None = None) -> list[Event]:
    session = Session(recipe, floorplan=way.building.plan, start=start)
    return session.feed(packets) + session.finish()


def _floor(place: PlaceScore) -> Plot:
    walls = [PictureTrack("", (wall.start, wall.end), DrawStyle.TRUTH) for wall in BUILDING.levels[0].walls]
    candidates = PictureTrack("candidates", place.before, DrawStyle.DOTS)
    tracks = (*walls, candidates, PictureTrack("true path", place.path), PictureTrack("place", place.track))
    return Plot("the way of fig. 15", tracks)


def _errors(way: BuildingWalk, walk: EmulatedWalk, events: list[Event]) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Return the error after each placed stride on the floor, m, and its mean between each turn and the next."""
    placed = [event for event in events if isinstance(event, Placed) and is_on_floor(walk.truth, event.t)]
    if not placed:
        return (), ()
    places = way.places(walk.walker, np.array([one.t for one in placed]))
    heights = {level.id: level.elevation for level in way.building.plan.levels}
    off = [
        hypot(one.position[0] - x, one.position[1] - y, heights[one.level] - heights[level])
        for one, (level, x, y) in zip(placed, places, strict=True)
    ]
    turns = [event.t for event in events if isinstance(event, TurnMade) and event.turn is not None]
    ends = [t for t in turns if t > placed[0].t] + [float("inf")]
    means = []
    for start, end in pairwise(ends):
        between = [error for one, error in zip(placed, off, strict=True) if start <= one.t < end]
        means.append(sum(between) / len(between) if between else 0.0)
    return tuple(off), tuple(means)
