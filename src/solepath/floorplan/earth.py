"""Conversion from degrees to the plan's metres and back, in the tangent plane of WGS84 at the anchor.

Points on the ellipsoid are projected onto the local tangent plane (east, north, up) and turned by the anchor's bearing.
At a distance d from the anchor, lengths in the plane are too short by the share d^2 / 6 R^2 (R: radius of the Earth),
less than 0.001 mm at 500 m and 0.1 mm at 2.5 km. The rounding error is below 1e-8 m."""

from __future__ import annotations

from cmath import rect
from math import atan2, cos, degrees, hypot, isfinite, pi, radians, sin, sqrt

from ..types import Vec2, Vec3
from ..types.vector import add, dot, pair, sub
from .frame import MAX_LATITUDE, Anchor, FloorPlanError, Point

_A = 6378137.0
_F = 1.0 / 298.257223563
_E2 = _F * (2.0 - _F)
"""Constants of WGS84: semi-major axis, m, flattening, and square of the first eccentricity."""

MAX_ANCHOR_DISTANCE = 20_000.0
"""Largest distance from the anchor that can belong to the building, m."""


class Tangent:
    """The plan's plane at an anchor."""

    def __init__(self, anchor: Anchor) -> None:
        latitude, longitude = radians(anchor.latitude), radians(anchor.longitude)
        self._origin = _earth_fixed(latitude, longitude)
        self._east = _outwards(0.0, longitude + 0.5 * pi)
        self._north = _outwards(latitude + 0.5 * pi, longitude)
        self._up = _outwards(latitude, longitude)
        self._turn = rect(1.0, anchor.bearing)

    def plan(self, latitude: float, longitude: float) -> Point:
        """Return the point of the plan, m, at these degrees; raise FloorPlanError when it is not near the anchor."""
        if not (isfinite(longitude) and abs(latitude) <= 90.0 and abs(longitude) <= 360.0):
            raise FloorPlanError(f"there is no latitude {latitude:g}, longitude {longitude:g}")
        offset = sub(_earth_fixed(radians(latitude), radians(longitude)), self._origin)
        if dot(offset, offset) > MAX_ANCHOR_DISTANCE**2:
            raise FloorPlanError(f"latitude {latitude:g}, longitude {longitude:g} is far from the rest of the plan")
        return pair(complex(dot(self._east, offset), dot(self._north, offset)) * self._turn)

    def degrees(self, point: Point) -> tuple[float, float]:
        """Return longitude and latitude, degrees, of a point of the plan, m: of the ellipsoid below or above it.

        Raises FloorPlanError for a point that is not near the anchor."""
        if hypot(*point) > MAX_ANCHOR_DISTANCE:
            raise FloorPlanError(f"({point[0]:g}, {point[1]:g}) is far from the anchor of the plan")
        east, north = pair(complex(*point) / self._turn)
        x, y, z = [o + east * e + north * n for o, e, n in zip(self._origin, self._east, self._north, strict=True)]
        up = self._up
        # how far up the ellipsoid is: x^2 + y^2 + z^2 / (1 - e^2) = a^2
        a = up[0] ** 2 + up[1] ** 2 + up[2] ** 2 / (1.0 - _E2)
        b = up[0] * x + up[1] * y + up[2] * z / (1.0 - _E2)
        height = (sqrt(b * b - a * (x * x + y * y + z * z / (1.0 - _E2) - _A * _A)) - b) / a
        x, y, z = add((x, y, z), up, height)
        return degrees(atan2(y, x)), degrees(atan2(z, (1.0 - _E2) * hypot(x, y)))

    def place(self, position: Point) -> Point:
        """Return the point of the plan, m, rounded to 1 mm, at (longitude, latitude) in degrees."""
        return to_mm(self.plan(position[1], position[0]))


def _outwards(latitude: float, longitude: float) -> Vec3:
    """Return the unit vector that points away from the ellipsoid at these angles, rad, Earth-fixed."""
    return cos(latitude) * cos(longitude), cos(latitude) * sin(longitude), sin(latitude)


def _earth_fixed(latitude: float, longitude: float) -> Vec3:
    """Return Earth-centred, Earth-fixed coordinates of a point on the ellipsoid, m."""
    x, y, z = _outwards(latitude, longitude)
    prime = _A / sqrt(1.0 - _E2 * z * z)
    return prime * x, prime * y, prime * (1.0 - _E2) * z


def south_west(positions: list[Vec2]) -> Anchor:
    """Return the south-west corner of points (longitude, latitude), degrees, as an anchor with +y to the north.

    It is rounded to 1e-7 degrees (1 cm). Raises FloorPlanError without points, and when they cannot be degrees."""
    if not positions:
        raise FloorPlanError("nothing is drawn in it")
    longitudes, latitudes = zip(*positions, strict=True)
    latitude, longitude = min(latitudes), min(longitudes)
    if not (latitude >= -MAX_LATITUDE and max(latitudes) <= MAX_LATITUDE and abs(longitude) <= 180.0):
        raise FloorPlanError(f"latitude {latitude:g}, longitude {longitude:g} cannot be degrees: is it in metres?")
    return Anchor(round(latitude, 7), round(longitude, 7), 0.0)


def to_mm(point: Point) -> Point:
    """Return the point, m, rounded to 1 mm, so that the same place has the same numbers in every format."""
    return round(point[0], 3) + 0.0, round(point[1], 3) + 0.0
