"""Parser of OpenStreetMap's elements, nodes, ways and relations with their tags, from untrusted XML or GeoJSON.

It rejects a document type declaration, since entities can be declared only there. GeoJSON is that of osmtogeojson,
which Overpass turbo exports: tags are properties, and points with the same coordinates are one node."""

from __future__ import annotations

from itertools import groupby
from math import inf
from typing import Any, NoReturn
from xml.etree.ElementTree import XML, ParseError, TreeBuilder, XMLParser
from xml.etree.ElementTree import Element as XmlElement
from xml.parsers.expat import ErrorString

from ...types import Vec2
from ...types.attrs import evolve, frozen
from ..plan import FloorPlanError
from .features import MAX_NUMBER, read_features

MAX_XML_TAGS = 4_000_000
"""Largest number of tags that begin and end elements."""


@frozen
class Element:
    """A node, a way or a relation.

    `position` of a node is its longitude and latitude, degrees. `refs` of a way are the ids of its nodes. `members` of
    a relation are (kind, ref, role)."""

    kind: str
    id: str
    position: Vec2
    refs: list[str]
    members: list[tuple[str, str, str]]
    tags: dict[str, str]

    @property
    def name(self) -> str:
        """Name for error messages."""
        return f"{self.kind} {self.id[:40]!r}"


OsmFile = dict[str, dict[str, Element]]
"""Elements of a file, by kind and id."""


class _Builder(TreeBuilder):
    def doctype(self, *_: object) -> NoReturn:
        """Reject the declaration."""
        raise FloorPlanError("has a document type, which no OpenStreetMap file has")


def parse_elements(data: bytes) -> OsmFile:
    """Return all elements of an OSM XML file that are not marked as deleted; raise FloorPlanError for other data."""
    if data.count(b"<") > MAX_XML_TAGS:
        raise FloorPlanError(f"has more than {MAX_XML_TAGS} tags")
    try:
        root = XML(data, XMLParser(target=_Builder()))
    except FloorPlanError:
        raise
    except ParseError as error:
        raise FloorPlanError(f"is not XML ({ErrorString(error.code)}, line {error.position[0]})") from None
    except (ValueError, LookupError) as error:
        raise FloorPlanError(f"is not XML ({error})") from None
    if root.tag != "osm":
        raise FloorPlanError(f"is XML, but not of OpenStreetMap: its root is {root.tag[:40]!r}")
    found: OsmFile = {"node": {}, "way": {}, "relation": {}}
    for one in root:
        if one.tag in found and one.get("action") != "delete" and one.get("visible") != "false":
            element = _parse_element(one)
            if found[one.tag].setdefault(element.id, element) is not element:
                raise FloorPlanError(f"two {one.tag}s have the id {element.id[:40]!r}")
    return found


def is_collection(collection: dict[str, Any]) -> bool:
    """Return whether a FeatureCollection has elements with indoor tags."""
    features = [one for one in collection["features"] if isinstance(one, dict)]
    return any(isinstance(tags := one.get("properties"), dict) and "indoor" in tags for one in features)


def convert_collection(collection: dict[str, Any]) -> OsmFile:
    """Return all elements of a FeatureCollection; raise FloorPlanError when it is none."""
    file: OsmFile = {"node": {}, "way": {}, "relation": {}}

    def add_node(position: Vec2) -> str:
        own = f"{position[0]!r} {position[1]!r}"
        file["node"].setdefault(own, Element("node", own, position, [], [], {}))
        return own

    for number, feature in enumerate(read_features(collection, "", in_properties=True), 1):
        tags = {
            key: value if isinstance(value, str) else f"{value:g}"
            for key, value in feature.properties.items()
            if isinstance(value, str) or isinstance(value, int | float) and abs(value) < MAX_NUMBER
        }
        own, parts = feature.id or str(number), feature.lines
        if feature.geometry == "Point":
            ref = add_node(parts[0][0][0])
            file["node"][ref] = evolve(file["node"][ref], tags=tags)
            continue
        ways = [Element("way", f"{own} {i}.{k}", (0.0, 0.0), [add_node(one) for one in line], [], {})
                for i, part in enumerate(parts) for k, line in enumerate(part)]  # fmt: skip
        if len(ways) == 1:
            file["way"][own] = evolve(ways[0], id=own, tags=tags)
            continue
        file["way"] |= {way.id: way for way in ways}
        members = [("way", way.id, "outer" if way.id.endswith(".0") else "inner") for way in ways]
        file["relation"][own] = Element("relation", own, (0.0, 0.0), [], members, tags)
    return file


def _parse_element(one: XmlElement) -> Element:
    own = one.get("id")
    if own is None:
        raise FloorPlanError(f"a {one.tag} has no id")
    position = (0.0, 0.0)
    if one.tag == "node":
        position = _parse_degrees(one, "lon", 180.0), _parse_degrees(one, "lat", 90.0)
    refs = [child.get("ref", "") for child in one.iterfind("nd")]
    members = [(child.get("type", ""), child.get("ref", ""), child.get("role", "")) for child in one.iterfind("member")]
    tags = {child.get("k", ""): child.get("v", "") for child in one.iterfind("tag")}
    return Element(one.tag, own, position, refs, members, tags)


def _parse_degrees(node: XmlElement, key: str, most: float) -> float:
    text = node.get(key, "missing")
    try:
        value = float(text)
    except ValueError:
        value = inf
    if not abs(value) <= most:
        raise FloorPlanError(f"node {node.get('id', '')[:40]!r}: its {key} is {text[:40]!r}, not degrees")
    return value


Refs = list[str]

MAX_MEMBERS = 2000


def find_shapes(element: Element, file: OsmFile) -> tuple[list[list[Refs]], list[Refs]]:
    """Return the closed shapes of a way or a relation, and its lines that do not close.

    A shape is an outline followed by its holes, rings that repeat their first node. Raises FloorPlanError when a way or
    node of the element is not in the file."""
    if element.kind == "way":
        rings, lines = _split_closed([_find_refs(element, file)])
        return [[ring] for ring in rings], lines
    if len(element.members) > MAX_MEMBERS:
        raise FloorPlanError(f"{element.name}: has more than {MAX_MEMBERS} members")
    sides: tuple[list[Refs], list[Refs]] = [], []
    for kind, ref, role in element.members:
        if kind == "way":
            sides[role == "inner"].append(_find_refs(_find(element, kind, ref, file), file))
    (rings, lines), (holes, open_holes) = [_split_closed(_join_chains(ways)) for ways in sides]
    if len(rings) == 1:
        return [rings + holes], lines + open_holes
    return [[ring] for ring in rings], lines + open_holes + holes  # the file does not say in which outline they are


def _find_refs(way: Element, file: OsmFile) -> Refs:
    return [ref for ref, _ in groupby([_find(way, "node", ref, file).id for ref in way.refs])]


def _find(element: Element, kind: str, ref: str, file: OsmFile) -> Element:
    """Return a way or node of an element; raise FloorPlanError when it is not in the file."""
    if ref not in file[kind]:
        raise FloorPlanError(f"{element.name}: its {kind} {ref[:40]!r} is not in the file")
    return file[kind][ref]


def _split_closed(chains: list[Refs]) -> tuple[list[Refs], list[Refs]]:
    """Return the rings among chains of nodes, and the other ones of two nodes or more."""
    rings = [refs for refs in chains if len(refs) >= 4 and refs[0] == refs[-1]]
    return rings, [refs for refs in chains if len(refs) >= 2 and refs not in rings]


def _join_chains(ways: list[Refs]) -> list[Refs]:
    """Return chains of nodes, made by joining ways that share an end."""
    left = [refs for refs in ways if len(refs) >= 2]
    chains: list[Refs] = []
    while left:
        chain = left.pop(0)
        while chain[0] != chain[-1] and (near := [refs for refs in left if chain[-1] in (refs[0], refs[-1])]):
            refs = near[0]
            left.remove(refs)
            chain = chain + (refs[1:] if refs[0] == chain[-1] else refs[-2::-1])
        chains.append(chain)
    return chains
