"""Heights, flights and risers of the stairs of a floor plan, as far as the plan has them."""

from __future__ import annotations

from math import fsum

from ...floorplan.plan import ConnectorKind, FloorPlan
from ...types.attrs import frozen
from .landings import MAX_STOREY_HEIGHT, MIN_STOREY_HEIGHT
from .passage import RISER_HEIGHT

MAX_RISERS = 18
"""Largest number of risers of a flight, no unit (DIN 18065: after that there is a landing)."""


@frozen
class Storeys:
    """Storeys of a plan by its stairs from the levels on which the wearer may be."""

    heights: tuple[float, float]
    """Least and largest climb, m; both 0 without stairs."""
    rises: tuple[float, ...]
    """Every possible climb, m, the least first; empty when the plan has no heights."""
    flights: int | None
    """Least number of flights of a storey; None if the plan does not know it of every staircase."""


def storeys_of(plan: FloorPlan, levels: frozenset[int], up: bool | None = None) -> Storeys:
    """Return what the plan says about its stairs from these levels, indices in the plan, or from all if there are none.

    With `up`, only stairs in this direction count. A wearer on a level without such stairs is on another one, so all
    levels and directions count."""
    names = {plan.levels[k].id for k in levels} or {level.id for level in plan.levels}
    stairs = [connector for connector in plan.connectors if connector.kind is ConnectorKind.STAIRS]
    rises, spans, flights = set(), [], []
    for connector in stairs:
        stops = [plan.level(stop.level) for stop in connector.stops]
        pairs = [(a, b) for a in stops for b in stops if a.id in names and b is not a]
        pairs = [(a, b) for a, b in pairs if up is None or (b.elevation > a.elevation) is up]
        rises |= {round(abs(b.elevation - a.elevation), 3) for a, b in pairs}
        spans += [abs(b.ordinal - a.ordinal) for a, b in pairs]
        flights += [connector.flights] if pairs else []
    if not rises:
        return storeys_of(plan, frozenset()) if levels or up is not None else Storeys((0.0, 0.0), (), None)
    known = [number for number in flights if number is not None]
    least_flights = min(known) if len(known) == len(flights) else None
    if plan.heights_known:
        ordered = tuple(sorted(rises))
        return Storeys((ordered[0], ordered[-1]), ordered, least_flights)
    return Storeys((MIN_STOREY_HEIGHT, MAX_STOREY_HEIGHT * max(*spans, 1)), (), least_flights)


def riser_height(plan: FloorPlan) -> float:
    """Return the height of a riser, m: the mean of the plan's stairs that have one, or the usual one."""
    known = [connector.rise for connector in plan.connectors if connector.rise is not None]
    return fsum(known) / len(known) if known else RISER_HEIGHT
