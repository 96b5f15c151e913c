"""Heading of the track on a plan by the compass in the feet, when the plan knows where north is.

The compass knows magnetic north only after some turns (body/aiding/compass.py), and within some degrees; magnetic north
is not true north, and steel may turn it. So its heading decides between ends of a building that are a quarter-turn or
more apart, and nothing finer. A part of the weight stays with all other headings, so that walls can contradict a north
that is wrong; where the building is its own image after half a turn, they cannot."""

from __future__ import annotations

from enum import Enum
from math import cos, fsum, hypot, pi, sin

from ..floorplan.plan import FloorPlan
from .arrivals import ANY_HEADING_SHARE, Heading
from .rows.rows import Row

DECLINATION = 0.35
"""Largest angle between magnetic and true north that is allowed for, rad: 20 degrees.

By the World Magnetic Model (WMM2025) it is larger only near the poles and in thinly populated regions of the south."""
SIGMAS = 2.0
"""Largest error of the compass's north, as a multiple of its standard deviation: 95 % of the errors."""
LARGEST_ERROR = 1.0
"""Largest error of the track's heading by the compass with which it is used, rad.

It is that of 19 degrees of standard deviation, after some 20 m, and leaves out a heading that is a quarter-turn off."""
OTHER_SHARES, HOLD_FACTOR = (0.05, ANY_HEADING_SHARE), 0.9
"""Shares of the weight between which other headings than the compass's are kept, and the factor for each stride.

The least share keeps some rows alive in case that north is wrong (assumed)."""


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
    """Return the rows, with less weight for those whose heading of the track is not the one that is known now.

    The weights are those of a known heading at arrivals: `ANY_HEADING_SHARE` is spread over the whole circle, the rest
    over the known heading and its error."""
    share = ANY_HEADING_SHARE / ((1.0 - ANY_HEADING_SHARE) * pi / heading[1] + ANY_HEADING_SHARE)
    return _scaled(rows, _have_heading(rows, heading), share)


def hold_headings(rows: list[Row], heading: Heading) -> list[Row]:
    """Return the rows after a stride, with the weight of other headings kept between `OTHER_SHARES`.

    Walls say nothing about alike ends, but which of few rows survive there is chance, which would outweigh the compass
    in the course of a walk. Strong evidence of walls is faster than `HOLD_FACTOR`."""
    have = _have_heading(rows, heading)
    total = fsum([row[4] for row in rows])
    others = fsum([row[4] for row, has in zip(rows, have, strict=True) if not has])
    least, most = OTHER_SHARES
    if most * total < others < total:
        return _scaled(rows, have, HOLD_FACTOR)
    return _scaled(rows, have, 1.0 / HOLD_FACTOR) if 0.0 < others < least * total else rows


def _have_heading(rows: list[Row], heading: Heading) -> list[bool]:
    """Return for each row whether its heading of the track is the known one, within its error."""
    c, s, least = cos(heading[0]), sin(heading[0]), cos(heading[1])
    return [c * row[2] + s * row[3] >= least * hypot(row[2], row[3]) for row in rows]


def _scaled(rows: list[Row], have: list[bool], factor: float) -> list[Row]:
    """Return the rows, the weights of those that do not have the heading times `factor`."""
    return [row if has else (*row[:4], factor * row[4], *row[5:]) for row, has in zip(rows, have, strict=True)]
