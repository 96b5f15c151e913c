"""How well the place on the plan of an emulated wearer's building was found.

A step is scored while its wearer is on a floor: not on stairs and in lifts, where the level is neither, nor for `PAUSE`
after them, within which nobody can have told that they are over.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import hypot

import numpy as np
from attrs import field, frozen

from ...emulate.routes.building import BUILDING
from ...emulate.routes.ways import BuildingWalk
from ...emulate.wearers.truth import Truth
from ...emulate.wearers.walker import Walker
from ...events import Event, Placed, PlaceLost, TurnMade

PAUSE = 5.0
"""s."""
NEAR = 3.0
"""A candidate within so much of the wearer, on the right level, is the true one, m."""
SECOND = 2
"""Turns: Liu et al. 2015 score places "started from the second turn" (fig. 13 g)."""

Points = tuple[tuple[float, float], ...]


@frozen
class PlaceScore:
    """Of one walk."""

    off: tuple[float, ...]
    """How far off the place was after each scored step from the second turn on; a wrong level counts with its height
    above or below the right one, m."""
    decided: int | None
    """After so many steps on the plan there was one candidate, and that the true one; None when there never was."""
    dropped: int
    """Scored steps after the first one that was placed of which the true candidate was missing, or there was none."""
    wrong: int
    """Scored steps with one candidate, and that not the true one."""
    steps: int
    """Scored steps that were placed."""
    path: Points = field(default=(), repr=False)
    """Where the wearer was."""
    track: Points = field(default=(), repr=False)
    """The place, once there was one candidate ..."""
    before: Points = field(default=(), repr=False)
    """... and all candidates of the time before."""


def score(way: BuildingWalk, walker: Walker, truth: Truth, events: Sequence[Event]) -> PlaceScore:
    """What `events` told of the walk of `walker` along `way`."""
    placed = [event for event in events if isinstance(event, Placed)]
    lost = [event.t for event in events if isinstance(event, PlaceLost) and placed and event.t > placed[0].t]
    heights = {level.id: level.elevation for level in BUILDING.levels}
    second = _second_turn(events)
    off: list[float] = []
    track: list[tuple[float, float]] = []
    before: list[tuple[float, float]] = []
    decided: int | None = None
    dropped = wrong = steps = 0
    places = way.places(walker, np.array([one.t for one in placed])) if placed else []
    for k, (one, (level, x, y)) in enumerate(zip(placed, places, strict=True)):
        near = [c.level == level and hypot(c.position[0] - x, c.position[1] - y) < NEAR for c in one.candidates]
        if decided is None and near == [True]:
            decided = k + 1
        if decided is None:
            before += [(c.position[0], c.position[1]) for c in one.candidates]
        else:
            track.append((one.position[0], one.position[1]))
        if not on_a_floor(truth, one.t):
            continue
        steps += 1
        dropped += not any(near)
        wrong += near == [False]
        if one.t >= second:
            up = heights[one.level] - heights[level]
            off.append(hypot(one.position[0] - x, one.position[1] - y, up))
    dropped += sum([on_a_floor(truth, t) for t in lost])
    path = tuple((x, y) for _, x, y in places)
    return PlaceScore(tuple(off), decided, dropped, wrong, steps, path, tuple(track), tuple(before))


def on_a_floor(truth: Truth, t: float) -> bool:
    """Whether a step at `t` s is scored."""
    moved = [(one.start, one.end) for one in truth.flights] + [(one.start, one.end) for one in truth.rides]
    return not any([begin <= t <= end + PAUSE for begin, end in moved])


def _second_turn(events: Sequence[Event]) -> float:
    """When the second turn on the plan was over, s."""
    first = next((event.t for event in events if isinstance(event, Placed)), float("inf"))
    turns = [event.t for event in events if isinstance(event, TurnMade) and event.turn is not None and event.t > first]
    return turns[SECOND - 1] if len(turns) >= SECOND else float("inf")
