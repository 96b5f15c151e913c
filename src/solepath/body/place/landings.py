"""Where a floor plan's stairs and lifts can be entered, and where one who enters there comes out."""

from __future__ import annotations

from math import exp, hypot

from ...floorplan.plan import ConnectorKind, FloorPlan, Point
from ...types.attrs import frozen

REACH = 5.0
"""Somebody who goes onto stairs or into a lift is within this of it as the track has it, m."""
APART = 2.5
"""Standard deviation of the distance, m."""
BESIDE = 4.0
"""So near to stairs or a lift one may be on them, m."""
OFF = 0.35
"""Standard deviation of a told height, m, ..."""
OFF_SHARE = 0.12
"""... and per m."""
LOW, HIGH = 2.4, 5.0
"""Usual heights of a storey, m."""
UNLIKELY = 0.02
"""Of the best one: less likely ways out are none."""


@frozen
class Landing:
    """A stop with its connector and level."""

    index: int
    """One more than its place among all stops of the plan."""
    connector: int
    """Its connector's place in the plan."""
    kind: ConnectorKind
    level: int
    """Its level's place in the plan."""
    ordinal: int
    """Its level's place in the order of storeys."""
    elevation: float
    """m"""
    place: Point
    """m, plan frame."""


def landings(plan: FloorPlan) -> list[Landing]:
    """All of them, connector by connector, from the lowest up."""
    levels = {level.id: k for k, level in enumerate(plan.levels)}
    found: list[Landing] = []
    for c, connector in enumerate(plan.connectors):
        for stop in connector.stops:
            k = levels.get(stop.level)
            if k is not None:
                level = plan.levels[k]
                number = len(found) + 1
                found.append(Landing(number, c, connector.kind, k, level.ordinal, level.elevation, stop.place))
    return found


def nearest(
    all_of_them: list[Landing], kind: ConnectorKind, level: int, x: float, y: float
) -> tuple[Landing, float] | None:
    """The nearest landing of a kind on a level, and how likely it is that somebody at (x, y) goes there; None where
    none is within reach."""
    best, distance = None, REACH
    for landing in all_of_them:
        if landing.kind is kind and landing.level == level:
            away = hypot(landing.place[0] - x, landing.place[1] - y)
            if away <= distance:
                best, distance = landing, away
    return None if best is None else (best, exp(-0.5 * (distance / APART) ** 2))


def ways_out(
    plan: FloorPlan, all_of_them: list[Landing], entered: Landing, up: bool, height: float | None
) -> list[tuple[Landing, float]]:
    """Where one who entered there and rode or climbed `height` m (None: any) comes out, with how likely each is. Where
    the plan knows no heights, any usual height of a storey is as good."""
    ways = []
    for landing in _along(all_of_them, entered):
        rise = landing.elevation - entered.elevation
        if rise > 0.0 if up else rise < 0.0:
            low = high = abs(rise)
            if not plan.heights_known:
                storeys = max(abs(landing.ordinal - entered.ordinal), 1)
                low, high = LOW * storeys, HIGH * storeys
            out = 0.0 if height is None else max(low - height, height - high, 0.0)
            off = out / (OFF + OFF_SHARE * low)
            ways.append((landing, exp(-0.5 * min(off * off, 1000.0))))
    most = max([weight for _, weight in ways], default=0.0)
    if most <= 0.0:
        return [(landing, 1.0 / len(ways)) for landing, _ in ways]
    return [(landing, weight / most) for landing, weight in ways if weight >= UNLIKELY * most]


def _along(all_of_them: list[Landing], entered: Landing) -> list[Landing]:
    """The landings of the same connector: they stand side by side."""
    first = last = entered.index - 1
    while first > 0 and all_of_them[first - 1].connector == entered.connector:
        first -= 1
    while last < len(all_of_them) and all_of_them[last].connector == entered.connector:
        last += 1
    return all_of_them[first:last]


def beside(all_of_them: list[Landing], level: int, x: float, y: float) -> bool:
    """Whether somebody at (x, y), m, may be on stairs or in a lift already."""
    return any([stop.level == level and hypot(stop.place[0] - x, stop.place[1] - y) < BESIDE for stop in all_of_them])
