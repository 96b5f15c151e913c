"""Scores the position on the floor plan for a wearer in the emulated building.

Only strides on a floor are scored. Stairs and elevator rides are left out, because the wearer is on neither of the two
levels there. So is the UNSCORED_TIME after them, because no method can know at once that they are over."""

from __future__ import annotations

from collections.abc import Sequence
from math import hypot

import numpy as np
from attrs import field, frozen

from ..emulate.routes.ways import BuildingWalk
from ..emulate.wearers.truth import Truth
from ..emulate.wearers.walker import Walker
from ..events import Candidate, Event, Placed, PlaceLost, TurnMade

UNSCORED_TIME = 5.0
"""Time after stairs or an elevator ride in which no stride is scored, s."""
NEAR_DISTANCE = 3.0
"""Horizontal distance from the wearer, on the right level, below which a candidate counts as the true one, m."""
FIRST_SCORED_TURN = 2
"""Number of the turn, counted from 1, from which positions are scored.

Liu et al. 2015 score places "started from the second turn" (fig. 13 g)."""

Points = tuple[tuple[float, float], ...]
"""Positions (x, y) on the floor plan, m."""


@frozen
class PlaceScore:
    """The score of the positions on the floor plan in one walk."""

    off: tuple[float, ...]
    """3D position error after each scored stride from the second turn on, m; a wrong level adds a height error."""
    decided: int | None
    """Number of placed strides until the place was decided (Placed.decided) and the true one; None if it never was."""
    dropped: int
    """Number of scored strides, after the first placed one, without the true candidate."""
    wrong: int
    """Number of scored strides with a decided place that was not the true one."""
    strides: int
    """Number of scored strides."""
    nearest: tuple[float, ...] = field(default=(), repr=False)
    """The same error of the candidate that is nearest to the truth, which nobody knows during the walk, m.

    Where two ends of a building are alike and no heading is known, which of two candidates is heavier is chance, and
    then this shows how well the walk was followed; the app sees `off`."""
    path: Points = field(default=(), repr=False)
    """True positions of the wearer."""
    track: Points = field(default=(), repr=False)
    """Estimated positions since the place was decided and the true one for the first time."""
    before: Points = field(default=(), repr=False)
    """Positions of all candidates before that."""


def score(way: BuildingWalk, walker: Walker, truth: Truth, events: Sequence[Event]) -> PlaceScore:
    """Score the events of a session on the walk of `walker` along `way`."""
    placed = [event for event in events if isinstance(event, Placed)]
    lost = [event.t for event in events if isinstance(event, PlaceLost) and placed and event.t > placed[0].t]
    heights = {level.id: level.elevation for level in way.building.plan.levels}
    t_second_turn = _second_turn(events)
    off: list[float] = []
    nearest: list[float] = []
    track: list[tuple[float, float]] = []
    before: list[tuple[float, float]] = []
    decided: int | None = None
    dropped = wrong = strides = 0
    places = way.places(walker, np.array([one.t for one in placed])) if placed else []
    for k, (one, (level, x, y)) in enumerate(zip(placed, places, strict=True), start=1):
        is_true = [is_near(candidate, level, x, y) for candidate in one.candidates]
        if decided is None and one.decided and is_true[0]:
            decided = k
        if decided is None:
            before += [candidate.position[:2] for candidate in one.candidates]
        else:
            track.append(one.position[:2])
        if not is_on_floor(truth, one.t):
            continue
        strides += 1
        dropped += not any(is_true)
        wrong += one.decided and not is_true[0]
        if one.t >= t_second_turn:
            candidates = [(candidate.position, candidate.level) for candidate in one.candidates]
            errors = [
                hypot(position[0] - x, position[1] - y, heights[on] - heights[level])
                for position, on in [(one.position, one.level), *candidates]
            ]
            off.append(errors[0])
            nearest.append(min(errors))
    dropped += sum([is_on_floor(truth, t) for t in lost])
    path = tuple((x, y) for _, x, y in places)
    return PlaceScore(tuple(off), decided, dropped, wrong, strides, tuple(nearest), path, tuple(track), tuple(before))


def is_near(candidate: Candidate, level: str, x: float, y: float) -> bool:
    """Return whether a candidate counts as the true one of a wearer at x, y, m, plan frame, on a level."""
    return candidate.level == level and hypot(candidate.position[0] - x, candidate.position[1] - y) < NEAR_DISTANCE


def is_on_floor(truth: Truth, t: float) -> bool:
    """Return whether the wearer at `t` s is on a floor: not on stairs, in an elevator, or in the time after them."""
    climbs = [(one.start, one.end) for one in truth.flights] + [(one.start, one.end) for one in truth.rides]
    return not any([start <= t <= end + UNSCORED_TIME for start, end in climbs])


def _second_turn(events: Sequence[Event]) -> float:
    """Return the end of the second turn after the first placed stride, s; infinity when there was none."""
    first = next((event.t for event in events if isinstance(event, Placed)), float("inf"))
    turns = [event.t for event in events if isinstance(event, TurnMade) and event.turn is not None and event.t > first]
    return turns[FIRST_SCORED_TURN - 1] if len(turns) >= FIRST_SCORED_TURN else float("inf")
