"""Where on a floor plan one may be who starts there, goes onto stairs or into a lift, or has come out of them."""

from __future__ import annotations

from collections.abc import Callable
from math import cos, pi, sin, sqrt

from ...floorplan.index import IndexedPlan
from ...floorplan.plan import ConnectorKind, FloorPlan, FloorPlanError, Point, Start
from .crowd import Row
from .landings import Landing, landings, nearest, ways_out
from .noise import NOISE, ROWS
from .reference import Arrived

HEADING = 0.12
"""A known heading may be off by this, rad (the first stride's direction is the track's x axis)."""
AROUND = 0.5
"""Where one steps off stairs or a lift, m around the landing."""
TURNED = 0.07
"""Stairs and rides turn the track by this, rad."""
ON_STAIRS = 2.0
"""Who does what one does on stairs, beside stairs, is so many times as likely to be on them as to go on along them."""
OTHER_WAY = {ConnectorKind.STAIRS: 0.1, ConnectorKind.LIFT: 0.01}
"""How often somebody goes up who is told to go down, or the other way round, at the least. To a foot, stairs up and
down look much alike."""

Scattered = Callable[[int, int], tuple[float, float, float, float]]


def fan(
    scattered: Scattered,
    plan: IndexedPlan,
    level: int,
    place: Point,
    spread: float,
    heading: float | None,
    count: int,
    origin: int,
    weight: float,
) -> list[Row]:
    """`count` rows around a place, of all headings where none is known, and of `weight` in all. `scattered`: where the
    k-th of so many lies, each from -1 to 1: x, y, heading, stretch."""
    x0, y0 = plan.plan.origin
    near = min(max(spread, 0.0), 20.0) * 1.2
    rows: list[Row] = []
    for k in range(count):
        ex, ey, eh, es = scattered(k, count)
        turn = 2.0 * pi * (k + 0.5 * eh) / count if heading is None else heading + 2.0 * HEADING * eh
        x, y = place[0] + near * ex, place[1] + near * ey
        if plan.crosses(level, place[0], place[1], x, y):
            x, y = place
        stretch = 1.0 + 0.05 * es
        row = (x - x0, y - y0, stretch * cos(turn), stretch * sin(turn), weight / count, level, origin, 0)
        rows.append(row)
    return rows


def changing(plan: FloorPlan, rows: list[Row], kind: ConnectorKind, since: Point) -> list[Row]:
    """Of those who are near stairs or a lift, another each that changes level; `since`: their way since then, m."""
    stops = landings(plan)
    x0, y0 = plan.origin
    dx, dy = since
    marked: list[Row] = []
    for x, y, a, b, w, level, origin, _ in rows:
        found = nearest(stops, kind, level, x0 + x - (a * dx - b * dy), y0 + y - (b * dx + a * dy))
        if found is not None:
            marked.append((x, y, a, b, ON_STAIRS * w * found[1], level, origin, found[0].index))
    return marked


def out(plan: IndexedPlan, held: list[Row], arrived: Arrived, random: int) -> list[Row]:
    """Those who changed level, where they come out: most where they are told to, some the other way."""
    x0, y0 = plan.plan.origin
    stops = landings(plan.plan)
    there: list[Row] = []
    for k, (_, _, a, b, w, _, origin, stop) in enumerate(held):
        for way, share in _ways(plan.plan, stops, stops[stop - 1], arrived):
            ex, ey, eh, es = NOISE[(random + k) % ROWS]
            turn, stretch = TURNED * eh, 1.0 + 0.02 * es
            x, y = way.place[0] + AROUND * ex, way.place[1] + AROUND * ey
            if plan.crosses(way.level, way.place[0], way.place[1], x, y):
                x, y = way.place
            a1, b1 = stretch * (a - b * turn), stretch * (b + a * turn)
            there.append((x - x0, y - y0, a1, b1, w * share, way.level, origin or way.connector + 1, 0))
    return there


def anew(scattered: Scattered, plan: IndexedPlan, arrived: Arrived, most: int) -> list[Row]:
    """Every place at which one may have come out: all stairs or lifts, all levels, all headings."""
    stops = landings(plan.plan)
    weights: dict[int, float] = {}
    for entered in stops:
        if entered.kind is arrived.kind:
            for way, share in _ways(plan.plan, stops, entered, arrived):
                weights[way.index] = weights.get(way.index, 0.0) + share
    total, roots = sum(weights.values()), sum([sqrt(weight) for weight in weights.values()])
    rows: list[Row] = []
    for index in sorted(weights):
        way = stops[index - 1]
        share = weights[index] / total
        count = max(int(most * sqrt(weights[index]) / roots), 8)
        rows += fan(scattered, plan, way.level, way.place, AROUND, None, count, way.connector + 1, share)
    return rows


def _ways(plan: FloorPlan, stops: list[Landing], entered: Landing, arrived: Arrived) -> list[tuple[Landing, float]]:
    """The ways out of who entered there, with how likely each is."""
    doubt = max(arrived.doubt, OTHER_WAY[arrived.kind])
    told = [(way, share * (1.0 - doubt)) for way, share in ways_out(plan, stops, entered, arrived.up, arrived.height)]
    other = ways_out(plan, stops, entered, not arrived.up, arrived.height)
    return told + [(way, share * doubt) for way, share in other]


def nowhere(plan: IndexedPlan, start: Start) -> str | None:
    """Why nobody can set out there, in a sentence; None when one can."""
    try:
        level = plan.number(start.level)
    except FloorPlanError as error:
        return f"start: {error}"
    if not plan.inside(level, *start.place):
        x, y = start.place
        return f"start: ({x:g}, {y:g}) is nowhere on level {start.level}: no room or corridor of the plan is there"
    return None
