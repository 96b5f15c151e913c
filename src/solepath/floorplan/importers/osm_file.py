"""OpenStreetMap XML: nodes, ways and relations with their tags, from bytes that anybody may have written.

Read with expat, straight into records: no tree is built, and a document type, the only way to declare entities, is
refused.
"""

from __future__ import annotations

from math import isfinite
from typing import NoReturn
from xml.parsers import expat

from attrs import define, field

from ..plan import FloorPlanError

MOST_ELEMENTS = 500_000


@define
class Element:
    """A node (with its degrees), a way (with its `refs` to nodes) or a relation (with its `members`: kind, ref,
    role)."""

    kind: str
    id: str
    latitude: float = 0.0
    longitude: float = 0.0
    refs: list[str] = field(factory=list)
    members: list[tuple[str, str, str]] = field(factory=list)
    tags: dict[str, str] = field(factory=dict)

    @property
    def name(self) -> str:
        """What complaints call it."""
        return f"{self.kind} {self.id[:40]!r}"


@define
class OsmFile:
    """What was in a file, by id."""

    nodes: dict[str, Element] = field(factory=dict)
    ways: dict[str, Element] = field(factory=dict)
    relations: dict[str, Element] = field(factory=dict)


def elements(data: bytes) -> OsmFile:
    """Everything in an OSM XML file that is not marked as deleted. FloorPlanError when it is not one."""
    parser = expat.ParserCreate()
    reader = _OsmFileReader()
    parser.StartElementHandler = reader.start
    parser.EndElementHandler = reader.end
    parser.StartDoctypeDeclHandler = _refuse
    try:
        parser.Parse(data, True)
    except expat.ExpatError as error:
        raise FloorPlanError(f"is not XML ({expat.ErrorString(error.code)}, line {error.lineno})") from None
    except (ValueError, LookupError) as error:
        if isinstance(error, FloorPlanError):
            raise
        raise FloorPlanError(f"is not XML ({error})") from None
    return reader.found


def _refuse(*_: object) -> NoReturn:
    raise FloorPlanError("has a document type, which no OpenStreetMap file has")


class _OsmFileReader:
    def __init__(self) -> None:
        self.found = OsmFile()
        self._open: Element | None = None
        self._depth = 0
        self._count = 0

    def start(self, tag: str, told: dict[str, str]) -> None:
        self._depth += 1
        self._count += 1
        if self._count > 4 * MOST_ELEMENTS:
            raise FloorPlanError(f"has more than {4 * MOST_ELEMENTS} elements")
        if self._depth == 1:
            if tag != "osm":
                raise FloorPlanError(f"is XML, but not of OpenStreetMap: its root is {tag[:40]!r}")
        elif self._depth == 2:
            self._open = _element(tag, told) if tag in ("node", "way", "relation") else None
        elif self._depth == 3 and self._open is not None:
            _inside(self._open, tag, told)

    def end(self, tag: str) -> None:
        self._depth -= 1
        if self._depth == 1 and self._open is not None:
            where = {"node": self.found.nodes, "way": self.found.ways, "relation": self.found.relations}[tag]
            if self._open.id in where:
                raise FloorPlanError(f"two {tag}s have the id {self._open.id[:40]!r}")
            where[self._open.id] = self._open
            self._open = None


def _element(tag: str, told: dict[str, str]) -> Element | None:
    if told.get("action") == "delete" or told.get("visible") == "false":
        return None
    if "id" not in told:
        raise FloorPlanError(f"a {tag} has no id")
    one = Element(tag, told["id"])
    if tag == "node":
        one.latitude, one.longitude = _degrees(one, told, "lat", 90.0), _degrees(one, told, "lon", 180.0)
    return one


def _degrees(one: Element, told: dict[str, str], key: str, most: float) -> float:
    try:
        value = float(told.get(key, "nothing"))
    except ValueError:
        value = float("nan")
    if not (isfinite(value) and abs(value) <= most):
        raise FloorPlanError(f"{one.name}: its {key} is {told.get(key, 'missing')[:40]!r}, not degrees")
    return value


def _inside(one: Element, tag: str, told: dict[str, str]) -> None:
    if tag == "tag":
        one.tags[told.get("k", "")] = told.get("v", "")
    elif tag == "nd" and one.kind == "way":
        one.refs.append(told.get("ref", ""))
    elif tag == "member" and one.kind == "relation":
        one.members.append((told.get("type", ""), told.get("ref", ""), told.get("role", "")))
