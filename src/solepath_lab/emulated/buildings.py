"""A corridor, and a building whose halves differ in nothing but where they lie: it is its image after half a turn.

Rooms and doors are included, so walls alone never tell one half from the other, and only the heading does. It is as
large as the usual building of the emulator."""

from __future__ import annotations

from math import pi
from pathlib import Path

from solepath.emulate.routes.building import FOUR_LOOPS, GROUND, Building, Cabin, Well
from solepath.emulate.routes.course import Course
from solepath.emulate.routes.ways import BuildingWalk
from solepath.floorplan.importers.reading import read_floorplan

HALF_TURN = Building(
    plan=read_floorplan(Path(__file__).with_name("half_turn.geojson")),
    columns=(9.0, 28.0, 47.0),
    rows=(9.0, 31.5, 54.0),
    cabins=(
        Cabin("A", (6.9, 4.9), 0.0),
        Cabin("C", (25.9, 45.9), 0.0),
        Cabin("B", (49.1, 58.1), pi),
        Cabin("D", (30.1, 17.1), pi),
    ),
    wells=(Well("west stairs", (7.8, 20.9), pi), Well("east stairs", (48.2, 42.1), 0.0)),
)
"""The building."""


def corridor() -> BuildingWalk:
    """Return a walk of 63 m straight on from door to door, like the long corridor of Liu et al. 2015, section V-D."""
    course = Course(GROUND, (FOUR_LOOPS.columns[0], 0.0), 0.5 * pi)
    course.stand()
    course.walk(63.0)
    course.stand()
    return BuildingWalk(course.route, course.start, GROUND)
