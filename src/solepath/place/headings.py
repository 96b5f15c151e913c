"""What is known of the track's heading on the plan: as the app gave it, or by the compass in the feet.

The compass knows magnetic north only after some turns (body/fuse/compass.py), and within some degrees; magnetic north
is not true north, and steel may turn it. So its heading decides between ends of a building that are a quarter-turn or
more apart, and nothing finer. A part of the weight stays with all other headings, so that walls can contradict a north
that is wrong; where the building is its own image after half a turn, they cannot."""

from __future__ import annotations

from enum import Enum
from math import atan2, cos, degrees, hypot, isfinite, pi, radians, sin

from ..events import PlanContradicted, WearerMoved
from ..floorplan.plan import FloorPlan
from ..types.attrs import stateful
from .particles import Cloud, scaled, stored, total_weight

START_HEADING_ERROR = 0.24
"""Largest error of a known start heading, rad, with the error of the first stride's direction (the track's x axis)."""
ANY_HEADING_SHARE = 0.1
"""Share of the weight of headings that a known first heading does not allow, because it may be wrong (assumed)."""
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

The least share keeps some particles alive in case that north is wrong (assumed)."""
HEADING_MARGIN = START_HEADING_ERROR
"""Deviation of every candidate's heading from the first one, above its largest error, at which that was wrong, rad.

In 12 emulated walks with SensorTags no right heading came to the largest error, and all that were 45 degrees off came
to twice of it."""
HEADING_DRIFT = radians(6.0) / 60.0
"""Drift of a track's heading whose error is not known, rad/s: that of a SensorTag at 20 Hz."""
AGREEMENT = 0.9
"""Least length of the mean of all candidates' headings, as unit vectors, with which it is reported."""
Heading = tuple[float, float]
"""Angle of the track's x axis from the plan's, and its largest error, rad."""


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
    error = DECLINATION + SIGMAS * north[1]
    return (0.5 * pi + plan.anchor.bearing - north[0], error) if error <= LARGEST_ERROR else None


@stateful
class KnownHeading:
    """The heading of the track on the plan, as far as it is known."""

    heading: Heading | None = None
    """None without a first heading and a compass, or if it was wrong."""
    source: HeadingSource = HeadingSource.NONE
    since: float = 0.0
    """Time of the first position, s, at which the first heading was known."""

    def give(self, angle: float) -> None:
        """Take the first heading of the app, rad."""
        self.heading, self.source = (angle, START_HEADING_ERROR), HeadingSource.GIVEN

    def turn(self, yaw: float) -> None:
        """Turn with the track, rad."""
        if self.heading is not None:
            self.heading = (self.heading[0] - yaw, self.heading[1])

    def update(self, plan: FloorPlan, here: WearerMoved, particles: Cloud) -> Cloud:
        """Allow the first heading the error of the track now; without one, take that by the compass, if there is one.

        Two standard deviations of the track are 95 % of its errors; with pi, any heading is possible. Returns the
        particles, weighed by the compass."""
        sigma = here.heading_sigma
        if self.source is HeadingSource.GIVEN and self.heading is not None and sigma is not None and isfinite(sigma):
            self.heading = (self.heading[0], min(START_HEADING_ERROR + 2.0 * sigma, pi))
        if self.source in (HeadingSource.GIVEN, HeadingSource.CONTRADICTED):
            return particles
        self.heading = heading_by_north(plan, here.north)
        if self.heading is None:
            return particles
        is_new, self.source = self.source is HeadingSource.NONE, HeadingSource.COMPASS
        return stored(_weigh(particles, self.heading, is_new))

    def find_contradiction(self, particles: Cloud, t: float, known_at: float) -> list[PlanContradicted]:
        """Use the heading no longer if at `t`, s, all particles have other ones, and return the events that say so."""
        if self.heading is None:
            return []
        angle, error = self.heading
        drift = HEADING_DRIFT * max(0.0, t - self.since) if error <= START_HEADING_ERROR else 0.0
        limit = min(error + HEADING_MARGIN + drift, pi)
        x = y = 0.0
        for particle in particles:
            off = atan2(particle.b, particle.a) - angle
            c, s = cos(off), sin(off)
            if abs(atan2(s, c)) <= limit:
                return []
            x += particle.weight * c
            y += particle.weight * s
        if hypot(x, y) < AGREEMENT * total_weight(particles):
            return []
        by_compass, off = self.source is HeadingSource.COMPASS, atan2(y, x)
        self.heading, self.source = None, HeadingSource.CONTRADICTED
        source = "the heading by the compass in the feet" if by_compass else "the first heading that was given"
        what = (
            f"{source} does not fit the plan by {abs(degrees(off)):.0f} degrees: the compass was "
            "disturbed, or the plan's north is wrong. The walls decide without it"
        )
        return [PlanContradicted(t=t, known_at=known_at, what=what, heading_off=round(off, 4))]


def _weigh(particles: Cloud, heading: Heading, is_new: bool) -> Cloud:
    """Return the particles weighed by the compass, which shows the heading for the first time or goes on.

    A new heading weighs as a known one does at arrivals: `ANY_HEADING_SHARE` is spread over the whole circle, the rest
    over the known heading and its error. Later the weight of other headings is kept between `OTHER_SHARES`: walls say
    nothing about alike ends, but which of few particles survive there is chance, which would outweigh the compass in
    the course of a walk. Strong evidence of walls is faster than `HOLD_FACTOR`."""
    (angle, error), (least, most) = heading, OTHER_SHARES
    c, s, cosine = cos(angle), sin(angle), cos(error)
    have = [c * one.a + s * one.b >= cosine * hypot(one.a, one.b) for one in particles]
    total = total_weight(particles)
    others = total_weight([one for one, has in zip(particles, have, strict=True) if not has])
    factor = 1.0
    if is_new:
        factor = ANY_HEADING_SHARE / ((1.0 - ANY_HEADING_SHARE) * pi / error + ANY_HEADING_SHARE)
    elif most * total < others < total:
        factor = HOLD_FACTOR
    elif 0.0 < others < least * total:
        factor = 1.0 / HOLD_FACTOR
    return scaled(particles, [1.0 if has else factor for has in have])
