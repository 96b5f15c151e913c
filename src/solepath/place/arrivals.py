"""Rows (hypotheses of the place) at a start, and at the entries and exits of stairs and elevators."""

from __future__ import annotations

from collections.abc import Callable
from math import cos, fsum, pi, sin, sqrt

from ..floorplan.index import IndexedPlan
from ..floorplan.plan import ConnectorKind, FloorPlan, FloorPlanError, Point, Start
from ..types.attrs import frozen
from .connectors.landings import Landing, find_exits, find_nearest_landing, list_landings
from .connectors.level_changes import LevelReached
from .rows.noise import NOISE_ENTRIES, NOISE_TABLE
from .rows.rows import Row

MAX_START_SPREAD, SPREAD_FACTOR = 20.0, 1.2
"""Largest rms error of a start place that is used, m, and ratio of the largest error on each axis to the rms error."""
START_HEADING_ERROR = 0.24
"""Largest error of a known start heading, rad, with the error of the first stride's direction (the track's x axis)."""
START_STRETCH_ERROR = 0.05
"""Largest deviation of the stretch of a new row from 1."""
EXIT_ERROR = 0.5
"""Largest distance between a landing and the place at which the wearer leaves it, on each axis, m."""
EXIT_TIMES = {ConnectorKind.STAIRS: (0.0, 0.4, 0.8), ConnectorKind.LIFT: (0.0,)}
"""Times before an arrival at which the wearer may have left the landing, s.

Stairs end with the end of the stride that leads from them, so that the wearer is up to a stride beyond the landing:
0.3 to 1.7 m in emulated walks. A lift ends with its stop, when the wearer stands in it."""
TURN_ERROR, STRETCH_ERROR = 0.07, 0.02
"""Largest errors of the track's heading, rad, and of its stretch that stairs or a ride add."""
ON_STAIRS_WEIGHT = 2.0
"""Likelihood of being on stairs divided by that of walking past them, when climbing is reported near stairs."""
LEAST_OPPOSITE_SHARE = {ConnectorKind.STAIRS: 0.1, ConnectorKind.LIFT: 0.01}
"""Least probability that the wearer's direction, up or down, is not the reported one: feet move alike in both."""
ANY_HEADING_SHARE = 0.1
"""Share of the weight of headings that a known first heading does not allow, because it may be wrong (assumed)."""
Heading = tuple[float, float]
"""Angle of the track's x axis from the plan's, and its largest error, rad."""
Scatter = Callable[[int, int], tuple[float, float, float, float]]
"""Function that returns offsets for the k-th of n rows, each from -1 to 1: x, y, heading, stretch."""


def spread_rows(
    scatter: Scatter,
    plan: IndexedPlan,
    level: int,
    place: Point,
    spread: float,
    heading: Heading | None,
    count: int,
    origin: int,
    weight: float,
) -> list[Row]:
    """Return `count` rows around `place` with total `weight`, in all headings when `heading` is None.

    `place` and `spread` are in m, plan frame; `origin` is the origin in each `Row`."""
    x0, y0 = plan.plan.origin
    radius = min(max(spread, 0.0), MAX_START_SPREAD) * SPREAD_FACTOR
    rows: list[Row] = []
    for k in range(count):
        ex, ey, eh, es = scatter(k, count)
        turn = 2.0 * pi * (k + 0.5 * eh) / count if heading is None else heading[0] + heading[1] * eh
        x, y = place[0] + radius * ex, place[1] + radius * ey
        if plan.crosses(level, place[0], place[1], x, y):
            x, y = place
        stretch = 1.0 + START_STRETCH_ERROR * es
        row = (x - x0, y - y0, stretch * cos(turn), stretch * sin(turn), weight / count, level, origin, 0)
        rows.append(row)
    return rows


def find_level_changes(plan: FloorPlan, rows: list[Row], kind: ConnectorKind, displacement: Point) -> list[Row]:
    """Return a row that changes level for each row near stairs or an elevator, as `kind` says.

    `displacement` is that of the track since the change may have started, m."""
    landings = list_landings(plan)
    x0, y0 = plan.origin
    dx, dy = displacement
    changing: list[Row] = []
    for x, y, a, b, w, level, origin, _ in rows:
        entry = find_nearest_landing(landings, kind, level, x0 + x - (a * dx - b * dy), y0 + y - (b * dx + a * dy))
        if entry is not None:
            changing.append((x, y, a, b, ON_STAIRS_WEIGHT * w * entry[1], level, origin, entry[0].index))
    return changing


def rows_at_exits(plan: IndexedPlan, changing: list[Row], arrived: LevelReached, random: int) -> list[Row]:
    """Return a row at each possible exit of each row that changes level; exits in the other direction weigh less."""
    x0, y0 = plan.plan.origin
    landings = list_landings(plan.plan)
    exit_rows: list[Row] = []
    for k, (_, _, a, b, w, _, origin, landing) in enumerate(changing):
        for exit_landing, share in _weigh_exits(plan.plan, landings, landings[landing - 1], arrived):
            ex, ey, eh, es = NOISE_TABLE[(random + k) % NOISE_ENTRIES]
            turn, stretch = TURN_ERROR * eh, 1.0 + STRETCH_ERROR * es
            x, y = exit_landing.place[0] + EXIT_ERROR * ex, exit_landing.place[1] + EXIT_ERROR * ey
            if plan.crosses(exit_landing.level, exit_landing.place[0], exit_landing.place[1], x, y):
                x, y = exit_landing.place
            a1, b1 = stretch * (a - b * turn), stretch * (b + a * turn)
            exit_rows.append(
                (x - x0, y - y0, a1, b1, w * share, exit_landing.level, origin or exit_landing.connector + 1, 0)
            )
    return exit_rows


def rows_at_all_exits(
    scatter: Scatter, plan: IndexedPlan, arrived: LevelReached, max_rows: int, heading: Heading | None
) -> list[Row]:
    """Return about `max_rows` rows, spread over all exits that `arrived` allows and over all headings.

    With a known `heading` of the track, half of them have it, and nearly all of the weight."""
    landings = list_landings(plan.plan)
    weights: dict[int, float] = {}
    for entered in landings:
        if entered.kind is arrived.kind:
            for exit_landing, share in _weigh_exits(plan.plan, landings, entered, arrived):
                weights[exit_landing.index] = weights.get(exit_landing.index, 0.0) + share
    total, roots = fsum(weights.values()), fsum([sqrt(weight) for weight in weights.values()])
    rows: list[Row] = []
    for index in sorted(weights):
        exit_landing = landings[index - 1]
        share = weights[index] / total
        count = max(int(max_rows * sqrt(weights[index]) / roots), 8)
        level, origin = exit_landing.level, exit_landing.connector + 1
        if heading is not None:
            count //= 2
            known = share * (1.0 - ANY_HEADING_SHARE)
            rows += spread_rows(scatter, plan, level, exit_landing.place, EXIT_ERROR, heading, count, origin, known)
            share *= ANY_HEADING_SHARE
        rows += spread_rows(scatter, plan, level, exit_landing.place, EXIT_ERROR, None, count, origin, share)
    return rows


def _weigh_exits(
    plan: FloorPlan, landings: list[Landing], entered: Landing, arrived: LevelReached
) -> list[tuple[Landing, float]]:
    """Return the possible exits after entering at the landing `entered`, each with its probability."""
    opposite = max(arrived.opposite_share, LEAST_OPPOSITE_SHARE[arrived.kind])
    expected = [
        (exit_landing, share * (1.0 - opposite))
        for exit_landing, share in find_exits(plan, landings, entered, arrived.up, arrived.height, arrived.flights)
    ]
    other = find_exits(plan, landings, entered, not arrived.up, arrived.height, arrived.flights)
    return expected + [(exit_landing, share * opposite) for exit_landing, share in other]


def has_exit(plan: FloorPlan, changing: list[Row], up: bool) -> bool:
    """Return whether a landing at which a row of `changing` started has an exit in this direction."""
    landings: list[Landing] = list_landings(plan)
    return any([find_exits(plan, landings, landings[index - 1], up, None) for index in {row[7] for row in changing}])


@frozen
class Arrival:
    """The levels to which the newest stairs may have led."""

    expected: tuple[int, ...]
    """Levels in the direction that was reported, as indices in the plan."""
    opposite: tuple[int, ...]
    """Levels in the other direction."""
    share: float
    """Probability of the other direction at the arrival."""


def arrival_by(plan: FloorPlan, changing: list[Row], arrived: LevelReached) -> Arrival | None:
    """Return the levels to which stairs lead from the landings at which rows changed level; None for a lift."""
    if arrived.kind is not ConnectorKind.STAIRS:
        return None
    landings, levels = list_landings(plan), [set[int](), set[int]()]
    for entered in {row[7] for row in changing}:
        for found, up in zip(levels, (arrived.up, not arrived.up), strict=True):
            found |= {one.level for one, _ in find_exits(plan, landings, landings[entered - 1], up, arrived.height)}
    expected, opposite = [tuple(sorted(found - other)) for found, other in (levels, levels[::-1])]
    return Arrival(expected, opposite, max(arrived.opposite_share, LEAST_OPPOSITE_SHARE[arrived.kind]))


def reversed_rows(rows: list[Row], arrival: Arrival) -> list[Row]:
    """Return the rows with the weights that they would have if the stairs had been reported in the other direction."""
    odds = arrival.share / (1.0 - arrival.share)
    factors = {**dict.fromkeys(arrival.expected, odds), **dict.fromkeys(arrival.opposite, 1.0 / odds)}
    return [(*row[:4], factors.get(row[5], 1.0) * row[4], *row[5:]) for row in rows]


def start_error(plan: IndexedPlan, start: Start) -> str | None:
    """Return the reason why `start` is impossible, one sentence; None when it is possible or has no place."""
    if start.place is None:
        return None
    try:
        level = plan.number(start.level)
    except FloorPlanError as error:
        return f"start: {error}"
    if not plan.inside(level, *start.place):
        x, y = start.place
        return f"start: ({x:g}, {y:g}) is nowhere on level {start.level}: no room or corridor of the plan is there"
    return None
