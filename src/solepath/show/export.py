"""Writes the way of a wearer for maps: GeoJSON (RFC 7946), GPX 1.1 or KML 2.2, by the ending of the file's name.

    write_way("walk.gpx", Walk.of(session.feed(packets)), plan)

On a floor plan the way is that of the places, in stretches on one level, and while there are several candidates that of
the heaviest, in stretches of their own. Without a plan it is the track of the wearer, or of one foot, in m from the
start. With an anchor, the plan's points have longitude and latitude. GPX and KML need them; GeoJSON has m without an
anchor, and says so."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from itertools import groupby
from pathlib import Path
from typing import Any
from xml.etree.ElementTree import Element, ElementTree, SubElement, indent

from attrs import frozen

from ..events import Placed
from ..floorplan.plan import FloorPlan, Point
from ..recording.errors import printable
from ..saving.files import os_errors_naming
from ..saving.provenance import installed_version
from ..walk.walk import Walk

DIGITS = 9
"""Digits after the point of a degree: 0.1 mm. Metres have three."""
GPX, KML = "http://www.topografix.com/GPX/1/1", "http://www.opengis.net/kml/2.2"
LOCAL_NOTE = (
    "coordinates are x and y in metres, not longitude and latitude, as there is no plan with an anchor within 20 km"
)
"""What a GeoJSON file without longitude and latitude says."""


@frozen
class Stretch:
    """A part of the way: on one level of a plan, or all of it without a plan, when `level` is ""."""

    level: str
    decided: bool
    """False for places of the heaviest candidate while there are others (`Placed.decided`)."""
    times: list[float]
    """Times on the clock of the recording, s."""
    points: list[Point]
    """Longitude and latitude, degrees, or x and y, m."""
    heights: list[float]
    """Height in the frame of the plan, or above the start, m."""

    @property
    def name(self) -> str:
        """Name for people."""
        name = f"level {printable(self.level)}" if self.level else "track"
        return name if self.decided else f"{name}, not decided"


def has_degrees(plan: FloorPlan | None) -> bool:
    """Return whether the points of a way on this plan have longitude and latitude."""
    return plan is not None and plan.has_degrees


def way_error(ending: str, plan: FloorPlan | None) -> str | None:
    """Return why a way on this plan cannot be written to a file with this ending, None when it can."""
    if ending not in WRITERS:
        return f"its name must end in {', '.join(WRITERS)}"
    if ending != ".geojson" and not has_degrees(plan):
        return (
            f"{ending} needs longitude and latitude, so a floor plan with an anchor within 20 km; .geojson takes metres"
        )
    return None


def write_way(
    path: Path | str,
    walk: Walk,
    plan: FloorPlan | None = None,
    *,
    ending: str = "",
    made_by: Mapping[str, Any] | None = None,
) -> int:
    """Write the way of a walk, and return the number of its points.

    `plan` is the floor plan of the session. `ending` is that of the name without one. `made_by` is as `provenance` says
    it; the file has it, GPX and KML as JSON in their description. The walk keeps all places only with `limit=None`, as
    `Walk.of` does. Raises ValueError for another ending, and for GPX and KML without an anchor, and OSError, naming the
    file, when it cannot be written."""
    path = Path(path)
    ending = ending or path.suffix.lower()
    if (error := way_error(ending, plan)) is not None:
        raise ValueError(f"{path}: {error}")
    degrees = has_degrees(plan)
    stretches = _stretches(walk, plan, degrees)
    with os_errors_naming(path):
        WRITERS[ending](path, stretches, degrees, made_by or {})
    return sum([len(one.points) for one in stretches])


def _stretches(walk: Walk, plan: FloorPlan | None, degrees: bool) -> list[Stretch]:
    if plan is None:
        return [_stretch("", True, [(one.t, *one.position) for one in walk.way], None)] if walk.way else []
    anchored = plan if degrees else None
    parts = groupby(walk.placed, lambda one: (one.level, one.decided) if isinstance(one, Placed) else None)
    return [
        _stretch(*key, [(one.t, *one.position) for one in part if isinstance(one, Placed)], anchored)
        for key, part in parts if key is not None
    ]  # fmt: skip


def _stretch(
    level: str, decided: bool, rows: list[tuple[float, float, float, float]], anchored: FloorPlan | None
) -> Stretch:
    points = [(x, y) if anchored is None else anchored.to_wgs84((x, y)) for _, x, y, _ in rows]
    return Stretch(level, decided, [t for t, *_ in rows], points, [z for *_, z in rows])


def _write_geojson(path: Path, stretches: list[Stretch], degrees: bool, made_by: Mapping[str, Any]) -> None:
    """Write a line for each stretch, a point where it has only one."""
    features = []
    for one in stretches:
        points = [[round(value, DIGITS if degrees else 3) for value in point] for point in one.points]
        is_line = len(points) > 1
        geometry = {"type": "LineString" if is_line else "Point", "coordinates": points if is_line else points[0]}
        properties = {"level": one.level or None, "decided": one.decided, "times_s": one.times}
        properties |= {"z_m": [round(z, 3) for z in one.heights]}
        features.append({"type": "Feature", "geometry": geometry, "properties": properties})
    content: dict[str, Any] = {"type": "FeatureCollection", "solepath": dict(made_by)}
    content |= {} if degrees else {"note": LOCAL_NOTE}
    path.write_text(json.dumps(content | {"features": features}, allow_nan=False) + "\n", encoding="utf-8")


def _write_gpx(path: Path, stretches: list[Stretch], degrees: bool, made_by: Mapping[str, Any]) -> None:
    """Write a track for each stretch; it has neither heights above the sea nor times of day, which are not known."""
    root = Element("gpx", version="1.1", creator=f"solepath {installed_version()}".strip(), xmlns=GPX)
    SubElement(SubElement(root, "metadata"), "desc").text = json.dumps(dict(made_by))
    for one in stretches:
        track = SubElement(root, "trk")
        SubElement(track, "name").text = one.name
        segment = SubElement(track, "trkseg")
        for longitude, latitude in one.points:
            SubElement(segment, "trkpt", lat=f"{latitude:.{DIGITS}f}", lon=f"{longitude:.{DIGITS}f}")
    _write_xml(path, root)


def _write_kml(path: Path, stretches: list[Stretch], degrees: bool, made_by: Mapping[str, Any]) -> None:
    """Write a line for each stretch, a point where it has only one, with heights above the ground."""
    root = Element("kml", xmlns=KML)
    document = SubElement(root, "Document", id="solepath-way")
    SubElement(document, "description").text = json.dumps(dict(made_by))
    for one in stretches:
        placemark = SubElement(document, "Placemark")
        SubElement(placemark, "name").text = one.name
        shape = SubElement(placemark, "LineString" if len(one.points) > 1 else "Point")
        SubElement(shape, "altitudeMode").text = "relativeToGround"
        places = zip(one.points, one.heights, strict=True)
        text = [f"{longitude:.{DIGITS}f},{latitude:.{DIGITS}f},{z:.3f}" for (longitude, latitude), z in places]
        SubElement(shape, "coordinates").text = " ".join(text)
    _write_xml(path, root)


def _write_xml(path: Path, root: Element) -> None:
    tree = ElementTree(root)
    indent(tree, space=" ")
    tree.write(path, encoding="utf-8", xml_declaration=True)


WRITERS: dict[str, Callable[[Path, list[Stretch], bool, Mapping[str, Any]], None]] = {
    ".geojson": _write_geojson,
    ".gpx": _write_gpx,
    ".kml": _write_kml,
}
"""What writes a file, by the ending of its name."""
