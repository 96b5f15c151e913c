"""The frame of a floor plan: its points, its anchor on the Earth, and the error of all that reads a plan."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from ..types.attrs import field, frozen, limited, limits

Point = tuple[float, float]
"""(x, y) in m, plan frame."""
MAX_COORDINATE = 1e7
"""Largest absolute coordinate from the plan's origin, m: national grids have up to 1e7."""
MAX_LATITUDE = 89.0
"""Largest absolute latitude of an anchor, degrees: east is not defined at a pole."""

Line = tuple[float, float, float, float]
"""A straight line from (ax, ay) to (bx, by), m, plan frame."""


class FloorPlanError(ValueError):
    """Raised when a floor plan cannot be read or used; its one line names the file, the feature and the fault."""


@contextmanager
def naming(name: str) -> Iterator[None]:
    """Put a name before the line of each FloorPlanError in this context."""
    try:
        yield
    except FloorPlanError as error:
        raise FloorPlanError(f"{name} {error}") from None


@frozen
class Anchor:
    """The position and orientation of the plan on the Earth.

    `latitude` and `longitude` are those of the plan's origin (0, 0), degrees, WGS84. `bearing` is the angle from true
    north clockwise to the plan's +y, rad; with 0, +x is east and +y is north."""

    latitude: float = field(metadata=limits(-MAX_LATITUDE, MAX_LATITUDE, "degrees"))
    longitude: float = field(metadata=limits(-180.0, 180.0, "degrees"))
    bearing: float = limited(0.0, -10.0, 10.0, "rad; were degrees meant?")
