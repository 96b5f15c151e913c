"""Landings: the places at which stairs and elevators of a floor plan are entered and left."""

from __future__ import annotations

from math import exp, hypot

from ...floorplan.index import IndexedPlan
from ...floorplan.plan import ConnectorKind, FloorPlan, Point
from ...types.attrs import frozen

LANDING_REACH = 5.0
"""Largest distance between the track and the stairs or elevator that the wearer enters, m."""
DISTANCE_DEVIATION = 2.5
"""Standard deviation of the distance between the track and the landing that is entered, m."""
NEAR_LANDING = 4.0
"""Largest distance from stairs or an elevator at which the wearer may be on them already, m."""
HEIGHT_ERROR = 0.35
"""Standard deviation of a reported height: constant part, m."""
HEIGHT_ERROR_SHARE = 0.12
"""Standard deviation of a reported height: part that grows with the height, m per m."""
MIN_STOREY_HEIGHT, MAX_STOREY_HEIGHT = 2.4, 5.0
"""Least and largest usual height of a storey, m."""
WRONG_FLIGHT, MIN_FLIGHTS_LIKELIHOOD = 0.2, 0.04
"""Likelihood of one flight too many or too few, as a landing of one stride hides it, and the least of any number
(assumed; of 50 emulated walks the number was right in 48 or more, docs/activities.md)."""
MIN_EXIT_LIKELIHOOD = 0.02
"""Least likelihood of an exit, as a share of that of the likeliest exit."""


@frozen
class Landing:
    """A landing: the stop of a connector (stairs or elevator) on one level."""

    index: int
    """Index among all landings of the plan, plus one."""
    connector: int
    """Index of the connector in the plan."""
    kind: ConnectorKind
    level: int
    """Index of the level in the plan."""
    ordinal: int
    """Ordinal of the level among the storeys."""
    elevation: float
    """Elevation of the level, m."""
    place: Point
    """Place, m, plan frame."""


def list_landings(plan: FloorPlan) -> list[Landing]:
    """Return all landings, connector by connector, from the lowest up."""
    levels = {level.id: k for k, level in enumerate(plan.levels)}
    landings: list[Landing] = []
    for c, connector in enumerate(plan.connectors):
        for stop in connector.stops:
            k = levels.get(stop.level)
            if k is not None:
                level = plan.levels[k]
                number = len(landings) + 1
                landings.append(Landing(number, c, connector.kind, k, level.ordinal, level.elevation, stop.place))
    return landings


def find_nearest_landing(
    landings: list[Landing], kind: ConnectorKind, level: int, x: float, y: float
) -> tuple[Landing, float] | None:
    """Return the landing nearest to (x, y), m, plan frame, and its likelihood; None beyond `LANDING_REACH`."""
    best, distance = None, LANDING_REACH
    for landing in landings:
        if landing.kind is kind and landing.level == level:
            new_distance = hypot(landing.place[0] - x, landing.place[1] - y)
            if new_distance <= distance:
                best, distance = landing, new_distance
    return None if best is None else (best, exp(-0.5 * (distance / DISTANCE_DEVIATION) ** 2))


def find_exits(
    plan: FloorPlan,
    landings: list[Landing],
    entered: Landing,
    up: bool,
    height: float | None,
    flights: int | None = None,
) -> list[tuple[Landing, float]]:
    """Return the exits after a climb of `height`, m (None: any), from the landing `entered`, with their likelihoods.

    When the plan has no heights, all usual heights of a storey are equally likely. If it has the number of flights of
    the stairs, the number that was climbed counts too, None if it is not known."""
    exits = []
    for landing in _list_connector_landings(landings, entered):
        rise = landing.elevation - entered.elevation
        if rise > 0.0 if up else rise < 0.0:
            low, high = usual_rise(plan, entered, landing)
            misfit = 0.0 if height is None else max(low - height, height - high, 0.0)
            deviation = misfit / (HEIGHT_ERROR + HEIGHT_ERROR_SHARE * low)
            by_flights = _flights_likelihood(plan, entered, landing, flights)
            exits.append((landing, by_flights * exp(-0.5 * min(deviation * deviation, 1000.0))))
    most = max([weight for _, weight in exits], default=0.0)
    if most <= 0.0:
        return [(landing, 1.0 / len(exits)) for landing, _ in exits]
    return [(landing, weight / most) for landing, weight in exits if weight >= MIN_EXIT_LIKELIHOOD * most]


def _flights_likelihood(plan: FloorPlan, entered: Landing, left: Landing, flights: int | None) -> float:
    """Return the likelihood of `flights` between two landings, relative to that of the number that the plan has."""
    usual = plan.connectors[entered.connector].flights
    if usual is None or flights is None:
        return 1.0
    difference = abs(flights - usual * max(abs(left.ordinal - entered.ordinal), 1))
    return max(WRONG_FLIGHT**difference, MIN_FLIGHTS_LIKELIHOOD)


def usual_rise(plan: FloorPlan, entered: Landing, left: Landing) -> tuple[float, float]:
    """Return the least and the largest height between two landings, m; equal when the plan has heights."""
    if plan.heights_known:
        rise = abs(left.elevation - entered.elevation)
        return rise, rise
    storeys = max(abs(left.ordinal - entered.ordinal), 1)
    return MIN_STOREY_HEIGHT * storeys, MAX_STOREY_HEIGHT * storeys


def _list_connector_landings(landings: list[Landing], entered: Landing) -> list[Landing]:
    first = last = entered.index - 1  # the landings of a connector are consecutive
    while first > 0 and landings[first - 1].connector == entered.connector:
        first -= 1
    while last < len(landings) and landings[last].connector == entered.connector:
        last += 1
    return landings[first:last]


def is_near_landing(plan: IndexedPlan, level: int, x: float, y: float) -> bool:
    """Return whether a wearer at (x, y), m, plan frame, may already be on stairs or in an elevator."""
    return any([hypot(px - x, py - y) < NEAR_LANDING for px, py in plan.stop_places[level]])
