"""Conversion from degrees to the plan's metres, in the tangent plane of WGS84 at the anchor.

Points on the ellipsoid are projected onto the local tangent plane (east, north, up) and turned by the anchor's bearing.
At a distance d from the anchor, lengths in the plane are too short by the share d^2 / 6 R^2 (R: radius of the Earth),
less than 0.001 mm at 500 m and 0.1 mm at 2.5 km. The rounding error is below 1e-8 m."""

from __future__ import annotations

from math import cos, isfinite, radians, sin, sqrt

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
        self._origin = _earth_fixed(latitude, longitude)
        self._sin_cos = [(sin(angle), cos(angle)) for angle in (latitude, longitude, anchor.bearing)]

    def plan(self, latitude: float, longitude: float) -> Point:
        """Return the point of the plan, m, at these degrees; raise FloorPlanError when it is not near the anchor."""
        if not (isfinite(longitude) and abs(latitude) <= 90.0 and abs(longitude) <= 360.0):
            raise FloorPlanError(f"there is no latitude {latitude:g}, longitude {longitude:g}")
        place = _earth_fixed(radians(latitude), radians(longitude))
        dx, dy, dz = [value - zero for value, zero in zip(place, self._origin, strict=True)]
        (sp, cp), (sl, cl), (s, c) = self._sin_cos
        outward = cl * dx + sl * dy
        east, north, down = cl * dy - sl * dx, cp * dz - sp * outward, -cp * outward - sp * dz
        if east * east + north * north + down * down > MAX_ANCHOR_DISTANCE**2:
            raise FloorPlanError(f"latitude {latitude:g}, longitude {longitude:g} is far from the rest of the plan")
        return c * east - s * north, s * east + c * north

    def place(self, position: Point) -> Point:
        """Return the point of the plan, m, rounded to 1 mm, at (longitude, latitude) in degrees."""
        return to_mm(self.plan(position[1], position[0]))


def _earth_fixed(latitude: float, longitude: float) -> tuple[float, float, float]:
    """Return Earth-centred, Earth-fixed coordinates of a point on the ellipsoid, m."""
    prime = _A / sqrt(1.0 - _E2 * sin(latitude) ** 2)
    axis_distance = prime * cos(latitude)
    return axis_distance * cos(longitude), axis_distance * sin(longitude), prime * (1.0 - _E2) * sin(latitude)


def south_west(positions: list[tuple[float, float]]) -> Anchor:
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
