"""Conversion from degrees to the plan's metres and back, in the tangent plane of WGS84 at the anchor.

Points on the ellipsoid are projected onto the local tangent plane (east, north, up) and turned by the anchor's bearing.
At a distance d from the anchor, lengths in the plane are too short by the share d^2 / 6 R^2 (R: radius of the Earth),
less than 0.001 mm at 500 m and 0.1 mm at 2.5 km. The rounding error is below 1e-8 m."""

from __future__ import annotations

from math import cos, degrees, isfinite, radians, sin, sqrt

from ..plan import MAX_LATITUDE, Anchor, FloorPlanError, Point

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
        self._latitude, self._longitude = latitude, longitude
        self._sin_cos_latitude = sin(latitude), cos(latitude)
        self._sin_cos_longitude = sin(longitude), cos(longitude)
        self._sin_cos_bearing = (sin(anchor.bearing), cos(anchor.bearing))
        self._origin = _earth_fixed(latitude, longitude)
        w = sqrt(1.0 - _E2 * self._sin_cos_latitude[0] ** 2)
        self._prime_radius, self._meridian_radius = _A / w, _A * (1.0 - _E2) / w**3

    def plan(self, latitude: float, longitude: float) -> Point:
        """Return the point of the plan, m, at these degrees; raise FloorPlanError when it is not near the anchor."""
        if not (isfinite(longitude) and abs(latitude) <= 90.0 and abs(longitude) <= 360.0):
            raise FloorPlanError(f"there is no latitude {latitude:g}, longitude {longitude:g}")
        east, north, down = self._east_north_down(radians(latitude), radians(longitude))
        if east * east + north * north + down * down > MAX_ANCHOR_DISTANCE**2:
            raise FloorPlanError(f"latitude {latitude:g}, longitude {longitude:g} is far from the rest of the plan")
        s, c = self._sin_cos_bearing
        return c * east - s * north, s * east + c * north

    def place(self, position: Point) -> Point:
        """Return the point of the plan, m, rounded to 1 mm, at (longitude, latitude) in degrees."""
        return to_mm(self.plan(position[1], position[0]))

    def degrees(self, point: Point) -> tuple[float, float]:
        """Return (latitude, longitude), degrees, of a point of the plan, m."""
        s, c = self._sin_cos_bearing
        east, north = c * point[0] + s * point[1], c * point[1] - s * point[0]
        latitude, longitude = self._latitude, self._longitude
        for _ in range(6):  # at 500 m each iteration leaves about 1e-4 of the previous error
            east_now, north_now, _ = self._east_north_down(latitude, longitude)
            latitude += (north - north_now) / self._meridian_radius
            longitude += (east - east_now) / (self._prime_radius * self._sin_cos_latitude[1])
        return degrees(latitude), degrees(longitude)

    def _east_north_down(self, latitude: float, longitude: float) -> tuple[float, float, float]:
        x, y, z = _earth_fixed(latitude, longitude)
        dx, dy, dz = x - self._origin[0], y - self._origin[1], z - self._origin[2]
        (sp, cp), (sl, cl) = self._sin_cos_latitude, self._sin_cos_longitude
        outward = cl * dx + sl * dy
        return cl * dy - sl * dx, cp * dz - sp * outward, -cp * outward - sp * dz


def _earth_fixed(latitude: float, longitude: float) -> tuple[float, float, float]:
    """Return Earth-centred, Earth-fixed coordinates of a point on the ellipsoid, m."""
    prime = _A / sqrt(1.0 - _E2 * sin(latitude) ** 2)
    axis_distance = prime * cos(latitude)
    return axis_distance * cos(longitude), axis_distance * sin(longitude), prime * (1.0 - _E2) * sin(latitude)


def south_west(places: list[tuple[float, float]]) -> Anchor:
    """Return the south-west corner of points (latitude, longitude), degrees, as an anchor with +y to the north.

    It is rounded to 1e-7 degrees (1 cm). Raises FloorPlanError without points, and when they cannot be degrees."""
    if not places:
        raise FloorPlanError("nothing is drawn in it")
    latitude, longitude = min(p[0] for p in places), min(p[1] for p in places)
    if not (latitude >= -MAX_LATITUDE and max(p[0] for p in places) <= MAX_LATITUDE and abs(longitude) <= 180.0):
        raise FloorPlanError(f"latitude {latitude:g}, longitude {longitude:g} cannot be degrees: is it in metres?")
    return Anchor(round(latitude, 7), round(longitude, 7), 0.0)


def to_mm(point: Point) -> Point:
    """Return the point, m, rounded to 1 mm, so that the same place has the same numbers in every format."""
    return round(point[0], 3) + 0.0, round(point[1], 3) + 0.0
