"""Parser of OpenStreetMap XML from untrusted bytes: nodes, ways and relations with their tags.

It reads with expat into records, without a tree. It rejects a document type declaration, since entities can be declared
only there."""

from __future__ import annotations

from math import isfinite
from typing import NoReturn
from xml.parsers import expat

from ...types.attrs import define, field
from ..plan import FloorPlanError

MAX_XML_ELEMENTS = 2_000_000


@define
class Element:
    """A node, a way or a relation.

    `latitude` and `longitude` of a node are in degrees. `refs` of a way are the ids of its nodes. `members` of a
    relation are (kind, ref, role)."""

    kind: str
    id: str
    latitude: float = 0.0
    longitude: float = 0.0
    refs: list[str] = field(factory=list)
    members: list[tuple[str, str, str]] = field(factory=list)
    tags: dict[str, str] = field(factory=dict)

    @property
    def name(self) -> str:
        """Name for error messages."""
        return f"{self.kind} {self.id[:40]!r}"


@define
class OsmFile:
    """Elements of a file, by id."""

    nodes: dict[str, Element] = field(factory=dict)
    ways: dict[str, Element] = field(factory=dict)
    relations: dict[str, Element] = field(factory=dict)


def parse_elements(data: bytes) -> OsmFile:
    """Return all elements of an OSM XML file that are not marked as deleted; raise FloorPlanError for other data."""
    parser = expat.ParserCreate()
    reader = _OsmFileReader()
    parser.StartElementHandler = reader.start
    parser.EndElementHandler = reader.end
    parser.StartDoctypeDeclHandler = _reject_doctype
    try:
        parser.Parse(data, True)
    except expat.ExpatError as error:
        raise FloorPlanError(f"is not XML ({expat.ErrorString(error.code)}, line {error.lineno})") from None
    except (ValueError, LookupError) as error:
        if isinstance(error, FloorPlanError):
            raise
        raise FloorPlanError(f"is not XML ({error})") from None
    return reader.found


def _reject_doctype(*_: object) -> NoReturn:
    raise FloorPlanError("has a document type, which no OpenStreetMap file has")


class _OsmFileReader:
    def __init__(self) -> None:
        self.found = OsmFile()
        self._current: Element | None = None
        self._depth = 0
        self._count = 0

    def start(self, tag: str, attributes: dict[str, str]) -> None:
        self._depth += 1
        self._count += 1
        if self._count > MAX_XML_ELEMENTS:
            raise FloorPlanError(f"has more than {MAX_XML_ELEMENTS} elements")
        if self._depth == 1:
            if tag != "osm":
                raise FloorPlanError(f"is XML, but not of OpenStreetMap: its root is {tag[:40]!r}")
        elif self._depth == 2:
            self._current = _element(tag, attributes) if tag in ("node", "way", "relation") else None
        elif self._depth == 3 and self._current is not None:
            _add_child(self._current, tag, attributes)

    def end(self, tag: str) -> None:
        self._depth -= 1
        if self._depth == 1 and self._current is not None:
            elements = {"node": self.found.nodes, "way": self.found.ways, "relation": self.found.relations}[tag]
            if self._current.id in elements:
                raise FloorPlanError(f"two {tag}s have the id {self._current.id[:40]!r}")
            elements[self._current.id] = self._current
            self._current = None


def _element(tag: str, attributes: dict[str, str]) -> Element | None:
    if attributes.get("action") == "delete" or attributes.get("visible") == "false":
        return None
    if "id" not in attributes:
        raise FloorPlanError(f"a {tag} has no id")
    element = Element(tag, attributes["id"])
    if tag == "node":
        element.latitude = _degrees(element, attributes, "lat", 90.0)
        element.longitude = _degrees(element, attributes, "lon", 180.0)
    return element


def _degrees(element: Element, attributes: dict[str, str], key: str, most: float) -> float:
    try:
        value = float(attributes.get(key, "nothing"))
    except ValueError:
        value = float("nan")
    if not (isfinite(value) and abs(value) <= most):
        raise FloorPlanError(f"{element.name}: its {key} is {attributes.get(key, 'missing')[:40]!r}, not degrees")
    return value


def _add_child(element: Element, tag: str, attributes: dict[str, str]) -> None:
    if tag == "tag":
        element.tags[attributes.get("k", "")] = attributes.get("v", "")
    elif tag == "nd" and element.kind == "way":
        element.refs.append(attributes.get("ref", ""))
    elif tag == "member" and element.kind == "relation":
        element.members.append((attributes.get("type", ""), attributes.get("ref", ""), attributes.get("role", "")))


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
        if ref not in file.ways:
            raise FloorPlanError(f"{element.name}: its way {ref[:40]!r} is not in the file")
        (inner if role == "inner" else outer).append(_find_refs(file.ways[ref], file))
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
        if ref not in file.nodes:
            raise FloorPlanError(f"{way.name}: its node {ref[:40]!r} is not in the file")
    return [ref for i, ref in enumerate(way.refs) if i == 0 or ref != way.refs[i - 1]]


def _split_closed(chains: list[Refs]) -> tuple[list[list[Refs]], list[Refs]]:
    shapes = [[refs[:-1]] for refs in chains if len(refs) >= 4 and refs[0] == refs[-1]]
    return shapes, [refs for refs in chains if len(refs) >= 2 and not (len(refs) >= 4 and refs[0] == refs[-1])]


def _join_chains(ways: list[Refs]) -> list[Refs]:
    """Return chains of nodes, made by joining ways that share an end."""
    remaining = [refs for refs in ways if len(refs) >= 2]
    chains: list[Refs] = []
    while remaining:
        chain = remaining.pop(0)
        has_grown = True
        while has_grown and chain[0] != chain[-1]:
            has_grown = False
            for i, refs in enumerate(remaining):
                if chain[-1] in (refs[0], refs[-1]):
                    chain = chain + (refs[1:] if refs[0] == chain[-1] else refs[-2::-1])
                    del remaining[i]
                    has_grown = True
                    break
        chains.append(chain)
    return chains
