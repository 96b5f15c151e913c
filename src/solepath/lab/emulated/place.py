"""Scores the position on the floor plan for a wearer in the emulated building.

A stride is scored while its wearer is on a floor. Stairs and lifts are left out, because the level is neither of the
two floors there, and so is the time `PAUSE` after them, within which no method can know that they are over."""

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
"""Time after stairs or a lift in which no stride is scored, s."""
NEAR = 3.0
"""Largest distance of the true candidate from the wearer, on the right level, m."""
FIRST_SCORED_TURN = 2
"""Number of the turn from which positions are scored.

Liu et al. 2015 score places "started from the second turn" (fig. 13 g)."""

Points = tuple[tuple[float, float], ...]


@frozen
class PlaceScore:
    """Score of the positions on the floor plan in one walk."""

    off: tuple[float, ...]
    """Position error after each scored stride from the second turn on, m. A wrong level counts with its height above or
    below the right one."""
    decided: int | None
    """Number of strides on the plan until the true candidate was the only one; None when that never happened."""
    dropped: int
    """Number of scored strides after the first placed one that had no candidate, or not the true one."""
    wrong: int
    """Number of scored strides whose only candidate was not the true one."""
    steps: int
    """Number of scored strides that were placed."""
    path: Points = field(default=(), repr=False)
    """True positions of the wearer, (x, y), m."""
    track: Points = field(default=(), repr=False)
    """Estimated positions once there was one candidate, (x, y), m."""
    before: Points = field(default=(), repr=False)
    """All candidates of the time before there was one candidate, (x, y), m."""


def score(way: BuildingWalk, walker: Walker, truth: Truth, events: Sequence[Event]) -> PlaceScore:
    """Score the events of a session on the walk of `walker` along `way`."""
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
    """Return whether a stride at `t` s is scored."""
    moved = [(one.start, one.end) for one in truth.flights] + [(one.start, one.end) for one in truth.rides]
    return not any([start <= t <= end + PAUSE for start, end in moved])


def _second_turn(events: Sequence[Event]) -> float:
    """Return the end of the second turn on the plan, s; infinity when there was none."""
    first = next((event.t for event in events if isinstance(event, Placed)), float("inf"))
    turns = [event.t for event in events if isinstance(event, TurnMade) and event.turn is not None and event.t > first]
    return turns[FIRST_SCORED_TURN - 1] if len(turns) >= FIRST_SCORED_TURN else float("inf")
