"""Heading of the track on a plan by the compass in the feet, when the plan knows where north is.

The compass knows magnetic north only after some turns (body/aiding/compass.py), and within some degrees; magnetic north
is not true north, and steel may turn it. So its heading decides between ends of a building that are a quarter-turn or
more apart, and nothing finer. A tenth of the weight stays with all other headings, as for a first heading that was
given: a wrong north is survived."""

from __future__ import annotations

from enum import Enum
from math import atan2, cos, pi, sin

from ...floorplan.plan import FloorPlan
from .arrivals import ANY_HEADING_SHARE, Heading
from .rows import Row

DECLINATION = 0.35
"""Largest angle between magnetic and true north that is allowed for, rad: 20 degrees.

By the World Magnetic Model (WMM2025) it is larger only near the poles and in thinly populated regions of the south."""
SIGMAS = 2.0
"""Largest error of the compass's north, as a multiple of its standard deviation: 95 % of the errors."""
LARGEST_ERROR = 1.0
"""Largest error of the track's heading by the compass with which it is used, rad.

It is that of 19 degrees of standard deviation, after some 20 m, and leaves out a heading that is a quarter-turn off."""


class HeadingSource(Enum):
    """Source of the track's known heading on the plan."""

    NONE = "none"
    GIVEN = "given"
    """The first heading that the app gave."""
    COMPASS = "compass"
    CONTRADICTED = "contradicted"
    """The walls have shown that it was wrong, so no other one is used either: the plan's north may be wrong."""


def heading_by_north(plan: FloorPlan, north: tuple[float, float] | None) -> Heading | None:
    """Return the heading of the track by the direction of magnetic `north` and its standard deviation, rad.

    None if the plan or the compass does not know it, or not well enough."""
    if plan.anchor is None or north is None:
        return None
    direction, sigma = north
    error = DECLINATION + SIGMAS * sigma
    return (0.5 * pi + plan.anchor.bearing - direction, error) if error <= LARGEST_ERROR else None


def weigh_headings(rows: list[Row], heading: Heading) -> list[Row]:
    """Return the rows, with less weight for those whose heading of the track is not the known one.

    The weights are those of a known heading at arrivals: `ANY_HEADING_SHARE` is spread over the whole circle, the rest
    over the known heading and its error."""
    angle, error = heading
    share = ANY_HEADING_SHARE / ((1.0 - ANY_HEADING_SHARE) * pi / error + ANY_HEADING_SHARE)
    weighed: list[Row] = []
    for row in rows:
        off = atan2(row[3], row[2]) - angle
        is_known = abs(atan2(sin(off), cos(off))) <= error
        weighed.append(row if is_known else (*row[:4], share * row[4], *row[5:]))
    return weighed
