"""Floor plans for tests: random usable plans, and the files of protocol/floorplans."""

from __future__ import annotations

import json
import zipfile
from io import BytesIO
from typing import Any

from here import PROTOCOL
from hypothesis import strategies as st

from solepath.floorplan.doors import cut_doors
from solepath.floorplan.plan import (
    Anchor,
    Connector,
    ConnectorKind,
    ConnectorStop,
    Door,
    FloorPlan,
    Level,
    Wall,
    with_rooms,
)

FILES = PROTOCOL / "floorplans"


def archive(files: dict[str, Any], folder: str = "", compression: int = zipfile.ZIP_DEFLATED) -> bytes:
    """Return a zip archive of JSON values or bytes."""
    buffer = BytesIO()
    with zipfile.ZipFile(buffer, "w", compression) as file:
        for name, content in files.items():
            file.writestr(folder + name, content if isinstance(content, bytes) else json.dumps(content))
    return buffer.getvalue()


def degrees(place: tuple[float, float]) -> tuple[float, float]:
    """Return latitude and longitude, degrees, of a place within 30 m of 48.15 N, 11.57 E; right to 0.1 mm.

    A degree there is 111,193.24 m long along the meridian of WGS84, 74,408.77 m along the parallel."""
    return 48.15 + place[1] / 111193.24, 11.57 + place[0] / 74408.77


names = st.text(max_size=8)
coordinates = st.floats(-9.0, 9.0) | st.integers(-9, 9).map(float)
places = st.tuples(coordinates, coordinates)
outlines = st.lists(places, min_size=3, max_size=6, unique=True).map(tuple).filter(
    lambda ring: max(abs(ring[0][0] - ring[-1][0]), abs(ring[0][1] - ring[-1][1])) > 0.1
)  # fmt: skip
walls = st.builds(Wall, places, places).filter(lambda wall: wall.start != wall.end)
doors = st.builds(Door, places, places, names).filter(lambda door: door.start != door.end)


@st.composite
def plans(draw: st.DrawFn) -> FloorPlan:
    """Return a random plan whose doors are cut out of its walls, as a reader does."""
    ids = draw(st.lists(st.text(min_size=1, max_size=5), min_size=1, max_size=3, unique=True))
    corner = Wall((-9.0, -9.0), (9.0, 9.0))  # so that no plan is smaller than a room
    levels = []
    for i, level_id in enumerate(ids):
        elevation = 3.0 * i + draw(st.floats(0.0, 2.0))
        level_walls = (corner, *draw(st.lists(walls, max_size=4)))
        level = Level(level_id, draw(names), i, elevation, level_walls, tuple(draw(st.lists(doors, max_size=3))))
        levels.append(cut_doors(with_rooms(level, draw(st.lists(st.tuples(outlines, names), max_size=2)))))
    connectors = []
    for _ in range(draw(st.integers(0, 3))):
        stops_at = [level_id for level_id in ids if draw(st.booleans())] or ids[:1]
        stops = tuple(ConnectorStop(level_id, draw(places), draw(st.just(()) | outlines)) for level_id in stops_at)
        flights, rise = draw(st.none() | st.integers(1, 4)), draw(st.none() | st.floats(0.1, 0.3))
        connectors.append(Connector(draw(st.sampled_from(ConnectorKind)), draw(names), stops, flights, rise))
    anchor = draw(st.none() | st.builds(Anchor, st.floats(-80.0, 80.0), st.floats(-180.0, 180.0), st.floats(-3.2, 3.2)))
    return FloorPlan(draw(names), tuple(levels), tuple(connectors), anchor, draw(st.booleans()))
