"""Parser of OpenStreetMap XML from untrusted bytes: nodes, ways and relations with their tags.

It rejects a document type declaration, since entities can be declared only there."""

from __future__ import annotations

from itertools import groupby
from math import inf
from typing import NoReturn
from xml.etree.ElementTree import Element as XmlElement
from xml.etree.ElementTree import TreeBuilder
from xml.parsers import expat

from ...types.attrs import define, field
from ..plan import FloorPlanError

MAX_XML_TAGS = 4_000_000
"""Largest number of tags that begin and end elements."""


@define
class Element:
    """A node, a way or a relation.

    `latitude` and `longitude` of a node are in degrees. `refs` of a way are the ids of its nodes. `members` of a
    relation are (kind, ref, role)."""

    kind: str
    id: str
    latitude: float
    longitude: float
    refs: list[str]
    members: list[tuple[str, str, str]]
    tags: dict[str, str]

    @property
    def name(self) -> str:
        """Name for error messages."""
        return f"{self.kind} {self.id[:40]!r}"


@define
class OsmFile:
    """Elements of a file, by id."""

    node: dict[str, Element] = field(factory=dict)
    way: dict[str, Element] = field(factory=dict)
    relation: dict[str, Element] = field(factory=dict)


def parse_elements(data: bytes) -> OsmFile:
    """Return all elements of an OSM XML file that are not marked as deleted; raise FloorPlanError for other data."""
    if data.count(b"<") > MAX_XML_TAGS:
        raise FloorPlanError(f"has more than {MAX_XML_TAGS} tags")
    parser, builder = expat.ParserCreate(), TreeBuilder()

    def start_root(tag: str, attributes: dict[str, str]) -> None:
        if tag != "osm":
            raise FloorPlanError(f"is XML, but not of OpenStreetMap: its root is {tag[:40]!r}")
        parser.StartElementHandler = builder.start
        builder.start(tag, attributes)

    parser.StartElementHandler, parser.EndElementHandler = start_root, builder.end
    parser.StartDoctypeDeclHandler = _reject_doctype
    try:
        parser.Parse(data, True)
    except expat.ExpatError as error:
        raise FloorPlanError(f"is not XML ({expat.ErrorString(error.code)}, line {error.lineno})") from None
    except FloorPlanError:
        raise
    except (ValueError, LookupError) as error:
        raise FloorPlanError(f"is not XML ({error})") from None
    found = OsmFile()
    for one in builder.close():
        if one.tag in ("node", "way", "relation") and not (
            one.get("action") == "delete" or one.get("visible") == "false"
        ):
            element, elements = _parse_element(one), getattr(found, one.tag)
            if element.id in elements:
                raise FloorPlanError(f"two {one.tag}s have the id {element.id[:40]!r}")
            elements[element.id] = element
    return found


def _reject_doctype(*_: object) -> NoReturn:
    raise FloorPlanError("has a document type, which no OpenStreetMap file has")


def _parse_element(one: XmlElement) -> Element:
    own = one.get("id")
    if own is None:
        raise FloorPlanError(f"a {one.tag} has no id")
    latitude, longitude = [
        _parse_degrees(one, key, most) if one.tag == "node" else 0.0 for key, most in (("lat", 90.0), ("lon", 180.0))
    ]
    refs = [child.get("ref", "") for child in one.iterfind("nd")]
    members = [(child.get("type", ""), child.get("ref", ""), child.get("role", "")) for child in one.iterfind("member")]
    tags = {child.get("k", ""): child.get("v", "") for child in one.iterfind("tag")}
    return Element(one.tag, own, latitude, longitude, refs, members, tags)


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

    A shape is an outline followed by its holes, rings that do not repeat their first node. Raises FloorPlanError when a
    way or node of the element is not in the file."""
    if element.kind == "way":
        return _split_closed([_find_refs(element, file)])
    outer: list[Refs] = []
    inner: list[Refs] = []
    if len(element.members) > MAX_MEMBERS:
        raise FloorPlanError(f"{element.name}: has more than {MAX_MEMBERS} members")
    for kind, ref, role in element.members:
        if kind != "way":
            continue
        if ref not in file.way:
            raise FloorPlanError(f"{element.name}: its way {ref[:40]!r} is not in the file")
        (inner if role == "inner" else outer).append(_find_refs(file.way[ref], file))
    shapes, lines = _split_closed(_join_chains(outer))
    holes, open_holes = _split_closed(_join_chains(inner))
    if len(shapes) == 1:
        shapes[0] += [rings[0] for rings in holes]
        return shapes, lines + open_holes
    return shapes, lines + open_holes + [
        [*rings[0], rings[0][0]] for rings in holes
    ]  # the file does not say which shape they belong to


def _find_refs(way: Element, file: OsmFile) -> Refs:
    for ref in way.refs:
        if ref not in file.node:
            raise FloorPlanError(f"{way.name}: its node {ref[:40]!r} is not in the file")
    return [ref for ref, _ in groupby(way.refs)]


def _split_closed(chains: list[Refs]) -> tuple[list[list[Refs]], list[Refs]]:
    shapes, lines = [], []
    for refs in chains:
        if len(refs) >= 4 and refs[0] == refs[-1]:
            shapes.append([refs[:-1]])
        elif len(refs) >= 2:
            lines.append(refs)
    return shapes, lines


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
