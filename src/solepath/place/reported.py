"""Rows after a person has reported where the wearer is on the plan."""

from __future__ import annotations

from math import atan2, exp, fsum, hypot

from ..body.fuse.position_covariance import LEAST_WAY, POSITION_GATE
from ..events import PositionRejected, PositionReported
from ..floorplan.index import IndexedPlan
from ..floorplan.plan import Point, Start
from .arrivals import EXIT_ERROR, START_HEADING_ERROR, Heading, Scatter, spread_rows, start_error
from .levels import KNOWN_ROWS
from .rows.rows import MAX_DISTANCE, Row

ROW_SIGMA = 1.0
"""Standard deviation of the place of a row on each axis, m, because there are few rows."""
OTHER_SHARE = 0.1
"""Share of the weight of all rows that a report gets which no row agrees with; the next report decides."""


def use_report(
    plan: IndexedPlan,
    rows: list[Row],
    event: PositionReported,
    place: Point,
    rejected: Point | None,
    scatter: Scatter,
    count: int,
    heading: Heading | None = None,
) -> tuple[list[Row], PositionRejected | None]:
    """Return the rows weighed by the likelihood of a reported `place`, m, plan frame, or an event that rejects it.

    If there are no rows, `count` rows there are the first ones, with `heading`, or in all headings without one. If a
    row agrees with the report, rows on other levels are dropped; rows on stairs have no level. If none agrees, a few
    are added there with little weight. A place near the one that was `rejected` on the spot just before is rejected
    again, and nothing is added."""
    fault = start_error(plan, Start(event.level, place))
    if fault is not None:
        return rows, _rejected(event, 0.0, fault.removeprefix("start: "))
    level, sigma = plan.number(event.level), max(event.sigma, EXIT_ERROR)
    if not rows:
        return spread_rows(scatter, plan, level, place, sigma, heading, count, 0, 1.0), None
    x0, y0 = plan.plan.origin
    px, py, variance = place[0] - x0, place[1] - y0, sigma * sigma + ROW_SIGMA * ROW_SIGMA
    there = [row for row in rows if row[5] == level or row[7]]
    distance = min([hypot(row[0] - px, row[1] - py) for row in there], default=MAX_DISTANCE)
    again = rejected is not None and hypot(place[0] - rejected[0], place[1] - rejected[1]) < LEAST_WAY
    if distance * distance < POSITION_GATE * variance and not again:
        least = distance * distance  # the nearest row keeps its weight, so that it does not become 0 by rounding
        weights = [exp(-0.5 * ((row[0] - px) ** 2 + (row[1] - py) ** 2 - least) / variance) for row in there]
        return [(*row[:4], k * row[4], *row[5:]) for row, k in zip(there, weights, strict=True)], None
    weight = 0.0 if again else fsum([row[4] for row in rows])
    usual = atan2(fsum([row[4] * row[3] for row in rows]), fsum([row[4] * row[2] for row in rows]))
    added = spread_rows(
        scatter, plan, level, place, sigma, (usual, START_HEADING_ERROR), KNOWN_ROWS, 0, OTHER_SHARE * weight
    )
    where = f"the nearest is {distance:.0f} m away" if there else "none is on this level"
    where = "it was rejected just before" if again else where
    what = (
        f"the track may have led to several places on the plan, but not to this one: {where}. If it is right, report "
        "another place further on: two that agree are believed"
    )
    return rows if again else rows + added, _rejected(event, distance, what)


def _rejected(event: PositionReported, distance: float, what: str) -> PositionRejected:
    return PositionRejected(t=event.t, known_at=event.known_at, distance=distance, sigma=event.sigma, what=what)
