"""Contradictions to the floor plan: a heading that was given or is the compass's, and the height of a lift's ride."""

from __future__ import annotations

from collections.abc import Sequence
from math import atan2, cos, degrees, fsum, hypot, inf, pi, radians, sin

from ..events import PlanContradicted
from ..floorplan.plan import ConnectorKind, FloorPlan
from .arrivals import START_HEADING_ERROR, Heading
from .connectors.landings import HEIGHT_ERROR, HEIGHT_ERROR_SHARE, list_landings, usual_rise
from .connectors.level_changes import LevelReached
from .rows.rows import Row

HEADING_MARGIN = START_HEADING_ERROR
"""Deviation of every candidate's heading from the first one, above its largest error, at which that was wrong, rad.

In 12 emulated walks with SensorTags no right heading came to the largest error, and all that were 45 degrees off came
to twice of it."""
HEADING_DRIFT = radians(6.0) / 60.0
"""Drift of a track's heading whose error is not known, rad/s: that of a SensorTag at 20 Hz."""
AGREEMENT = 0.9
"""Least length of the mean of all candidates' headings, as unit vectors, with which it is reported."""
HEIGHT_RATIO = 2.0
"""Deviation of a ride's height from every one of the plan, as a ratio to its error, at which the plan contradicts it.

With 2, half a storey of 2.7 m or more contradicts, and an error of 1.5 m does not."""
CONTRADICTED_CERTAINTY = 0.5
"""Certainty of an arrival by a ride that contradicts the plan: the wearer may be where they were."""


def contradicted_heading(
    rows: list[Row], heading: Heading, since: float, t: float, known_at: float, by_compass: bool = False
) -> PlanContradicted | None:
    """Return the event if at `t`, s, all rows have other headings than the first one, at `since`, s.

    It was given, or is that `by_compass`."""
    drift = HEADING_DRIFT * max(0.0, t - since) if heading[1] <= START_HEADING_ERROR else 0.0
    limit = min(heading[1] + HEADING_MARGIN + drift, pi)
    x = y = 0.0
    for _, _, a, b, w, _, _, _ in rows:
        off = atan2(b, a) - heading[0]
        c, s = cos(off), sin(off)
        if abs(atan2(s, c)) <= limit:
            return None
        x += w * c
        y += w * s
    if hypot(x, y) < AGREEMENT * fsum([row[4] for row in rows]):
        return None
    off = atan2(y, x)
    source = "the heading by the compass in the feet" if by_compass else "the first heading that was given"
    what = (
        f"{source} does not fit the plan by {abs(degrees(off)):.0f} degrees: the compass was "
        "disturbed, or the plan's north is wrong. The walls decide without it"
    )
    return PlanContradicted(t=t, known_at=known_at, what=what, heading_off=round(off, 4))


def contradicted_height(
    plan: FloorPlan, ride: LevelReached, levels: Sequence[int], known_at: float
) -> PlanContradicted | None:
    """Return the event if no lift of the plan makes a ride of this height and direction from any of `levels`.

    `levels` are those of all candidates, as indices in the plan; none if the place is not known."""
    if ride.kind is not ConnectorKind.LIFT:
        return None
    landings = [landing for landing in list_landings(plan) if landing.kind is ride.kind]
    nearest, deviation = None, inf
    for entered in landings:
        for left in landings:
            rise = left.elevation - entered.elevation
            is_possible = left.connector == entered.connector and (rise > 0.0 if ride.up else rise < 0.0)
            if not is_possible or (levels and entered.level not in levels):
                continue
            low, high = usual_rise(plan, entered, left)
            height = 0.5 * (low + high) if ride.height is None else ride.height
            allowed = min(max(height, low), high)
            ratio = abs(height - allowed) / (HEIGHT_ERROR + HEIGHT_ERROR_SHARE * low)
            if ratio < deviation:
                nearest, deviation = allowed, ratio
    if deviation <= HEIGHT_RATIO or not landings:
        return None
    way = f"{'up' if ride.up else 'down'}{'' if ride.height is None else f' by {ride.height:.1f} m'}"
    fault = f"the plan has none that goes {way.split()[0]}{' from there' if levels else ''}"
    if nearest is not None:
        fault = f"the nearest landing of the plan is at {nearest:.1f} m"
    what = (
        f"a lift went {way}, and {fault}: it has stopped between two landings, or the plan lacks one. The wearer may "
        "be at the next landing or where they were"
    )
    off = None if nearest is None or ride.height is None else round(ride.height - nearest, 3)
    return PlanContradicted(t=ride.t, known_at=max(ride.t, known_at), what=what, height_off=off)
