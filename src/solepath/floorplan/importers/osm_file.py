"""Parser of OpenStreetMap XML from untrusted bytes: nodes, ways and relations with their tags.

It reads with expat, straight into records: no tree is built. It rejects a document type, the only way to declare
entities."""

from __future__ import annotations

from math import isfinite
from typing import NoReturn
from xml.parsers import expat

from ...types.attrs import define, field
from ..plan import FloorPlanError

MOST_ELEMENTS = 500_000


@define
class Element:
    """A node (with its degrees), a way (with its `refs` to nodes) or a relation.

    `members` of a relation are (kind, ref, role)."""

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


def elements(data: bytes) -> OsmFile:
    """Return everything in an OSM XML file that is not marked as deleted; raise FloorPlanError when it is not one."""
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
        self._open: Element | None = None
        self._depth = 0
        self._count = 0

    def start(self, tag: str, attributes: dict[str, str]) -> None:
        self._depth += 1
        self._count += 1
        if self._count > 4 * MOST_ELEMENTS:
            raise FloorPlanError(f"has more than {4 * MOST_ELEMENTS} elements")
        if self._depth == 1:
            if tag != "osm":
                raise FloorPlanError(f"is XML, but not of OpenStreetMap: its root is {tag[:40]!r}")
        elif self._depth == 2:
            self._open = _element(tag, attributes) if tag in ("node", "way", "relation") else None
        elif self._depth == 3 and self._open is not None:
            _add_child(self._open, tag, attributes)

    def end(self, tag: str) -> None:
        self._depth -= 1
        if self._depth == 1 and self._open is not None:
            where = {"node": self.found.nodes, "way": self.found.ways, "relation": self.found.relations}[tag]
            if self._open.id in where:
                raise FloorPlanError(f"two {tag}s have the id {self._open.id[:40]!r}")
            where[self._open.id] = self._open
            self._open = None


def _element(tag: str, attributes: dict[str, str]) -> Element | None:
    if attributes.get("action") == "delete" or attributes.get("visible") == "false":
        return None
    if "id" not in attributes:
        raise FloorPlanError(f"a {tag} has no id")
    one = Element(tag, attributes["id"])
    if tag == "node":
        one.latitude, one.longitude = _degrees(one, attributes, "lat", 90.0), _degrees(one, attributes, "lon", 180.0)
    return one


def _degrees(one: Element, attributes: dict[str, str], key: str, most: float) -> float:
    try:
        value = float(attributes.get(key, "nothing"))
    except ValueError:
        value = float("nan")
    if not (isfinite(value) and abs(value) <= most):
        raise FloorPlanError(f"{one.name}: its {key} is {attributes.get(key, 'missing')[:40]!r}, not degrees")
    return value


def _add_child(one: Element, tag: str, attributes: dict[str, str]) -> None:
    if tag == "tag":
        one.tags[attributes.get("k", "")] = attributes.get("v", "")
    elif tag == "nd" and one.kind == "way":
        one.refs.append(attributes.get("ref", ""))
    elif tag == "member" and one.kind == "relation":
        one.members.append((attributes.get("type", ""), attributes.get("ref", ""), attributes.get("role", "")))


Refs = list[str]

MOST_MEMBERS = 2000


def shapes_of(one: Element, file: OsmFile) -> tuple[list[list[Refs]], list[Refs]]:
    """Return the closed shapes of a way or a relation, and its lines that do not close.

    A shape is an outline and then its holes, rings that do not repeat their first node. Raises FloorPlanError when a
    part of it is not in the file."""
    if one.kind == "way":
        return _split_closed([_find_refs(one, file)])
    outer: list[Refs] = []
    inner: list[Refs] = []
    if len(one.members) > MOST_MEMBERS:
        raise FloorPlanError(f"{one.name}: has more than {MOST_MEMBERS} members")
    for kind, ref, role in one.members:
        if kind != "way":
            continue
        if ref not in file.ways:
            raise FloorPlanError(f"{one.name}: its way {ref[:40]!r} is not in the file")
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
    """Return ways joined end to end, as far as possible."""
    remaining = [refs for refs in ways if len(refs) >= 2]
    done: list[Refs] = []
    while remaining:
        chain = remaining.pop(0)
        grown = True
        while grown and chain[0] != chain[-1]:
            grown = False
            for i, refs in enumerate(remaining):
                if chain[-1] in (refs[0], refs[-1]):
                    chain = chain + (refs[1:] if refs[0] == chain[-1] else refs[-2::-1])
                    del remaining[i]
                    grown = True
                    break
        done.append(chain)
    return done
