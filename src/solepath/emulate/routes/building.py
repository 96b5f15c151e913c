"""Emulated buildings of two floors that are alike: a floor plan, and the corridors, elevators and stairs for walks.

Plan frame: origin at the south-west corner, x to the east, y to the north, m. Elevators open to corridors. Staircases
have two flights and a landing per storey.

FOUR_LOOPS has 56 m by 63 m, as large as the building of Liu et al. 2015 (section V-B). Six corridors make four loops of
different sizes. Four elevators, as many as the candidates of the paper's fig. 15, open to four corridors; elevator `A`
is at the bottom left. It has neither an axis nor a centre of symmetry, but its elevators and stairs are spread over the
whole floor."""

from __future__ import annotations

from math import cos, pi, sin
from pathlib import Path

from attrs import frozen

from ...floorplan.importers.reading import read_floorplan
from ...floorplan.plan import FloorPlan, Point

GROUND, UPPER = "0", "1"
"""Ids of the two levels."""
RISERS, RISE, GOING = 10, 0.16, 0.30
"""Number of risers of a flight, height of a riser, m, and depth of a tread, m."""
STOREY = 2 * RISERS * RISE
"""Height from floor to floor, m."""
LANE_OFFSET, EDGE_OFFSET = 0.7, 2.4
"""Distance from a stairwell's middle line to that of a lane, and from its door to the first edge, m."""


@frozen
class Cabin:
    """The cabin of an elevator."""

    name: str
    """Name of the elevator."""
    middle: Point
    """Centre of the cabin in the plan frame, m."""
    door_heading: float
    """Heading from the cabin to its door in the plan frame, rad: 0, pi/2, pi or -pi/2."""


@frozen
class Well:
    """A stairwell beside a corridor; upwards the wearer enters by the right lane and leaves by the left one."""

    name: str
    """Name of the staircase."""
    door: Point
    """Middle of the open side, on the corridor's wall, in the plan frame, m."""
    inward: float
    """Heading from the door into the stairwell in the plan frame, rad: 0, pi/2, pi or -pi/2."""

    @property
    def door_heading(self) -> float:
        """Heading from the stairwell to its door in the plan frame, rad."""
        return self.inward - pi if self.inward > 0.0 else self.inward + pi

    def inside(self, inward: float, left: float) -> Point:
        """Return the point `inward` m inside the door and `left` m to the left of the middle line."""
        (x, y), (ux, uy) = self.door, unit(self.inward)
        return (x + inward * ux - left * uy, y + inward * uy + left * ux)


@frozen(eq=False)
class Building:
    """A building of two floors that are alike."""

    plan: FloorPlan
    """Floor plan of the building."""
    columns: tuple[float, ...]
    """Coordinates x of the middle lines of the corridors that run north, m."""
    rows: tuple[float, ...]
    """Coordinates y of the middle lines of the corridors that run east, from the first column to the last one, m."""
    cabins: tuple[Cabin, ...]
    """Cabins of the elevators."""
    wells: tuple[Well, ...]
    """Stairwells of the building."""


def unit(heading: float) -> tuple[int, int]:
    """Return the exact direction of a heading of 0, pi/2, pi or -pi/2 rad in the plan frame."""
    return round(cos(heading)), round(sin(heading))


BUILDING = read_floorplan(Path(__file__).with_name("four_loops.geojson"))
"""Floor plan of the usual building."""
FOUR_LOOPS = Building(
    plan=BUILDING,
    columns=(9.0, 25.0, 47.0),
    rows=(9.0, 27.0, 54.0),
    cabins=(
        Cabin("A", (6.9, 4.9), 0.0),
        Cabin("B", (49.1, 57.9), pi),
        Cabin("C", (32.9, 29.1), -0.5 * pi),
        Cabin("D", (22.9, 45.9), 0.0),
    ),
    wells=(Well("west stairs", (7.8, 20.9), pi), Well("north stairs", (31.4, 55.2), 0.5 * pi)),
)
"""The usual building."""
