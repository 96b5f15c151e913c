"""Places on a floor plan at which the wearer may start, go onto stairs or into a lift, or come out of them."""

from __future__ import annotations

from collections.abc import Callable
from math import cos, pi, sin, sqrt

from ...floorplan.index import IndexedPlan
from ...floorplan.plan import ConnectorKind, FloorPlan, FloorPlanError, Point, Start
from .landings import Landing, landings, nearest, ways_out
from .noise import NOISE, ROWS
from .reference import Arrived
from .rows import Row

HEADING_ERROR = 0.12
"""Error of a known heading, rad (the first stride's direction is the track's x axis)."""
EXIT_ERROR = 0.5
"""Distance from the landing at which the wearer comes off stairs or a lift, m."""
TURN_ERROR = 0.07
"""Turn of the track by stairs and rides, rad."""
ON_STAIRS_WEIGHT = 2.0
"""Ratio of the likelihoods of being on stairs and of walking along them, for a wearer who climbs beside stairs."""
LEAST_OPPOSITE_SHARE = {ConnectorKind.STAIRS: 0.1, ConnectorKind.LIFT: 0.01}
"""Least probability that the wearer goes in the other direction than reported.

To a foot, stairs up and down look much alike."""

Scatter = Callable[[int, int], tuple[float, float, float, float]]


def fan(
    scatter: Scatter,
    plan: IndexedPlan,
    level: int,
    place: Point,
    spread: float,
    heading: float | None,
    count: int,
    origin: int,
    weight: float,
) -> list[Row]:
    """Return `count` rows around a place, of all headings where none is known, with `weight` in all.

    `scatter` gives offsets for the k-th row, each from -1 to 1: x, y, heading, stretch."""
    x0, y0 = plan.plan.origin
    near = min(max(spread, 0.0), 20.0) * 1.2
    rows: list[Row] = []
    for k in range(count):
        ex, ey, eh, es = scatter(k, count)
        turn = 2.0 * pi * (k + 0.5 * eh) / count if heading is None else heading + 2.0 * HEADING_ERROR * eh
        x, y = place[0] + near * ex, place[1] + near * ey
        if plan.crosses(level, place[0], place[1], x, y):
            x, y = place
        stretch = 1.0 + 0.05 * es
        row = (x - x0, y - y0, stretch * cos(turn), stretch * sin(turn), weight / count, level, origin, 0)
        rows.append(row)
    return rows


def changing_level(plan: FloorPlan, rows: list[Row], kind: ConnectorKind, since: Point) -> list[Row]:
    """Return another row that changes level for each one near stairs or a lift; `since`: displacement since then, m."""
    stops = landings(plan)
    x0, y0 = plan.origin
    dx, dy = since
    marked: list[Row] = []
    for x, y, a, b, w, level, origin, _ in rows:
        found = nearest(stops, kind, level, x0 + x - (a * dx - b * dy), y0 + y - (b * dx + a * dy))
        if found is not None:
            marked.append((x, y, a, b, ON_STAIRS_WEIGHT * w * found[1], level, origin, found[0].index))
    return marked


def exits(plan: IndexedPlan, held: list[Row], arrived: Arrived, random: int) -> list[Row]:
    """Return rows at the exits of the rows that changed level: most in the reported direction, some in the other."""
    x0, y0 = plan.plan.origin
    stops = landings(plan.plan)
    there: list[Row] = []
    for k, (_, _, a, b, w, _, origin, stop) in enumerate(held):
        for exit_landing, share in _ways_out(plan.plan, stops, stops[stop - 1], arrived):
            ex, ey, eh, es = NOISE[(random + k) % ROWS]
            turn, stretch = TURN_ERROR * eh, 1.0 + 0.02 * es
            x, y = exit_landing.place[0] + EXIT_ERROR * ex, exit_landing.place[1] + EXIT_ERROR * ey
            if plan.crosses(exit_landing.level, exit_landing.place[0], exit_landing.place[1], x, y):
                x, y = exit_landing.place
            a1, b1 = stretch * (a - b * turn), stretch * (b + a * turn)
            there.append(
                (x - x0, y - y0, a1, b1, w * share, exit_landing.level, origin or exit_landing.connector + 1, 0)
            )
    return there


def all_exits(scatter: Scatter, plan: IndexedPlan, arrived: Arrived, most: int) -> list[Row]:
    """Return rows at every possible exit: all stairs or lifts, all levels, all headings."""
    stops = landings(plan.plan)
    weights: dict[int, float] = {}
    for entered in stops:
        if entered.kind is arrived.kind:
            for exit_landing, share in _ways_out(plan.plan, stops, entered, arrived):
                weights[exit_landing.index] = weights.get(exit_landing.index, 0.0) + share
    total, roots = sum(weights.values()), sum([sqrt(weight) for weight in weights.values()])
    rows: list[Row] = []
    for index in sorted(weights):
        exit_landing = stops[index - 1]
        share = weights[index] / total
        count = max(int(most * sqrt(weights[index]) / roots), 8)
        rows += fan(
            scatter,
            plan,
            exit_landing.level,
            exit_landing.place,
            EXIT_ERROR,
            None,
            count,
            exit_landing.connector + 1,
            share,
        )
    return rows


def _ways_out(plan: FloorPlan, stops: list[Landing], entered: Landing, arrived: Arrived) -> list[tuple[Landing, float]]:
    """Return the exits of a wearer who entered there, each with its probability."""
    opposite = max(arrived.opposite_share, LEAST_OPPOSITE_SHARE[arrived.kind])
    expected = [
        (exit_landing, share * (1.0 - opposite))
        for exit_landing, share in ways_out(plan, stops, entered, arrived.up, arrived.height)
    ]
    other = ways_out(plan, stops, entered, not arrived.up, arrived.height)
    return expected + [(exit_landing, share * opposite) for exit_landing, share in other]


def start_error(plan: IndexedPlan, start: Start) -> str | None:
    """Return the reason why nobody can start there, one sentence; None when it is possible."""
    try:
        level = plan.number(start.level)
    except FloorPlanError as error:
        return f"start: {error}"
    if not plan.inside(level, *start.place):
        x, y = start.place
        return f"start: ({x:g}, {y:g}) is nowhere on level {start.level}: no room or corridor of the plan is there"
    return None
