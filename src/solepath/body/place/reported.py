"""Rows after a person has reported where the wearer is on the plan, and after the track was revised."""

from __future__ import annotations

from math import atan2, cos, exp, fsum, hypot, sin

from ...events import PositionRejected, PositionReported
from ...floorplan.index import IndexedPlan
from ...floorplan.plan import Point, Start
from .arrivals import EXIT_ERROR, Scatter, spread_rows, start_error
from .levels import KNOWN_ROWS
from .rows import MAX_DISTANCE, Row

REPORT_GATE = 11.8
"""Largest squared distance of a report from the nearest row, divided by its variance: 99.7 % of right ones."""
ROW_SIGMA = 1.0
"""Standard deviation of the place of a row on each axis, m, because there are few rows."""
OTHER_SHARE = 0.1
"""Share of the weight of all rows that a report gets which no row agrees with; the next report decides."""


def use_report(
    plan: IndexedPlan, rows: list[Row], event: PositionReported, place: Point, scatter: Scatter, count: int
) -> tuple[list[Row], PositionRejected | None]:
    """Return the rows weighed by the likelihood of a reported `place`, m, plan frame, or an event that rejects it.

    If there are no rows, `count` rows there are the first ones, in all headings. If no row agrees with the report, a
    few are added there with little weight. Rows on stairs have no level."""
    fault = start_error(plan, Start(event.level, place))
    if fault is not None:
        return rows, _rejected(event, 0.0, fault.removeprefix("start: "))
    level, sigma = plan.number(event.level), max(event.sigma, EXIT_ERROR)
    if not rows:
        return spread_rows(scatter, plan, level, place, sigma, None, count, 0, 1.0), None
    x0, y0 = plan.plan.origin
    px, py, variance = place[0] - x0, place[1] - y0, sigma * sigma + ROW_SIGMA * ROW_SIGMA
    there = [row for row in rows if row[5] == level or row[7]]
    distance = min([hypot(row[0] - px, row[1] - py) for row in there], default=MAX_DISTANCE)
    if distance * distance < REPORT_GATE * variance:
        least = distance * distance  # the nearest row keeps its weight, so that it does not become 0 by rounding
        weights = [exp(-0.5 * ((row[0] - px) ** 2 + (row[1] - py) ** 2 - least) / variance) for row in there]
        return [(*row[:4], k * row[4], *row[5:]) for row, k in zip(there, weights, strict=True)], None
    weight = fsum([row[4] for row in rows])
    heading = atan2(fsum([row[4] * row[3] for row in rows]), fsum([row[4] * row[2] for row in rows]))
    added = spread_rows(scatter, plan, level, place, sigma, heading, KNOWN_ROWS, 0, OTHER_SHARE * weight)
    where = f"the nearest is {distance:.0f} m away" if there else "none is on this level"
    what = (
        f"the track may have led to several places on the plan, but not to this one: {where}. If it is right, report "
        "another place further on: two that agree are believed"
    )
    return rows + added, _rejected(event, distance, what)


def _rejected(event: PositionReported, distance: float, what: str) -> PositionRejected:
    return PositionRejected(t=event.t, known_at=event.known_at, distance=distance, sigma=event.sigma, what=what)


def turn_rows(rows: list[Row], yaw: float) -> list[Row]:
    """Return the rows for a track that was turned by `yaw`, rad: their moves in the plan stay as they are."""
    c, s = cos(yaw), sin(yaw)
    return [(x, y, c * a + s * b, c * b - s * a, w, level, origin, at) for x, y, a, b, w, level, origin, at in rows]
