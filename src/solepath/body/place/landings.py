"""Landings: the places at which a floor plan's stairs and lifts are entered and left."""

from __future__ import annotations

from math import exp, hypot

from ...floorplan.plan import ConnectorKind, FloorPlan, Point
from ...types.attrs import frozen

REACH = 5.0
"""Largest distance on the track between a wearer and the stairs or lift that he enters, m."""
DISTANCE_DEVIATION = 2.5
"""Standard deviation of that distance, m."""
NEAR_LANDING = 4.0
"""Distance from stairs or a lift within which the wearer may be on them, m."""
HEIGHT_ERROR = 0.35
"""Standard deviation of a reported height, m, as a constant part."""
HEIGHT_ERROR_SHARE = 0.12
"""Standard deviation of a reported height, m per m, which adds to `HEIGHT_ERROR`."""
LOW, HIGH = 2.4, 5.0
"""Usual heights of a storey, m: least and largest."""
LEAST_LIKELY = 0.02
"""Least likelihood of an exit, as a share of the best one's."""


@frozen
class Landing:
    """A stop of a connector on one level."""

    index: int
    """Index of the stop among all stops of the plan, plus one."""
    connector: int
    """Index of its connector in the plan."""
    kind: ConnectorKind
    level: int
    """Index of its level in the plan."""
    ordinal: int
    """Ordinal of its level among the storeys."""
    elevation: float
    """Elevation of its level, m."""
    place: Point
    """Place, m, plan frame."""


def landings(plan: FloorPlan) -> list[Landing]:
    """Return all landings, connector by connector, from the lowest up."""
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


def nearest(stops: list[Landing], kind: ConnectorKind, level: int, x: float, y: float) -> tuple[Landing, float] | None:
    """Return the nearest landing of a kind on a level, and its likelihood for a wearer at (x, y); None out of reach."""
    best, distance = None, REACH
    for landing in stops:
        if landing.kind is kind and landing.level == level:
            away = hypot(landing.place[0] - x, landing.place[1] - y)
            if away <= distance:
                best, distance = landing, away
    return None if best is None else (best, exp(-0.5 * (distance / DISTANCE_DEVIATION) ** 2))


def ways_out(
    plan: FloorPlan, stops: list[Landing], entered: Landing, up: bool, height: float | None
) -> list[tuple[Landing, float]]:
    """Return the exits for a wearer who entered there and gained `height` m (None: any), with their likelihoods.

    Where the plan has no heights, all usual heights of a storey are alike."""
    ways = []
    for landing in _along(stops, entered):
        rise = landing.elevation - entered.elevation
        if rise > 0.0 if up else rise < 0.0:
            low = high = abs(rise)
            if not plan.heights_known:
                storeys = max(abs(landing.ordinal - entered.ordinal), 1)
                low, high = LOW * storeys, HIGH * storeys
            out = 0.0 if height is None else max(low - height, height - high, 0.0)
            off = out / (HEIGHT_ERROR + HEIGHT_ERROR_SHARE * low)
            ways.append((landing, exp(-0.5 * min(off * off, 1000.0))))
    most = max([weight for _, weight in ways], default=0.0)
    if most <= 0.0:
        return [(landing, 1.0 / len(ways)) for landing, _ in ways]
    return [(landing, weight / most) for landing, weight in ways if weight >= LEAST_LIKELY * most]


def _along(stops: list[Landing], entered: Landing) -> list[Landing]:
    """Return the landings of the same connector: they are consecutive."""
    first = last = entered.index - 1
    while first > 0 and stops[first - 1].connector == entered.connector:
        first -= 1
    while last < len(stops) and stops[last].connector == entered.connector:
        last += 1
    return stops[first:last]


def is_near_landing(stops: list[Landing], level: int, x: float, y: float) -> bool:
    """Return whether a wearer at (x, y), m, may be on stairs or in a lift already."""
    return any([stop.level == level and hypot(stop.place[0] - x, stop.place[1] - y) < NEAR_LANDING for stop in stops])
