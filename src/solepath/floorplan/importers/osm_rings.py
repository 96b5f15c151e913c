"""Outlines out of OpenStreetMap's ways and multipolygon relations, as the ids of their nodes."""

from __future__ import annotations

from ..plan import FloorPlanError
from .osm_file import Element, OsmFile

Refs = list[str]

MOST_MEMBERS = 2000


def shapes_of(one: Element, file: OsmFile) -> tuple[list[list[Refs]], list[Refs]]:
    """The closed shapes of a way or a relation, each its outline and then its holes, rings whose last node is not the
    first again; and the lines that do not close. FloorPlanError when something of it is not in the file."""
    if one.kind == "way":
        return _closed([_refs(one, file)])
    outer: list[Refs] = []
    inner: list[Refs] = []
    if len(one.members) > MOST_MEMBERS:
        raise FloorPlanError(f"{one.name}: has more than {MOST_MEMBERS} members")
    for kind, ref, role in one.members:
        if kind != "way":
            continue
        if ref not in file.ways:
            raise FloorPlanError(f"{one.name}: its way {ref[:40]!r} is not in the file")
        (inner if role == "inner" else outer).append(_refs(file.ways[ref], file))
    shapes, lines = _closed(_chained(outer))
    holes, open_holes = _closed(_chained(inner))
    if len(shapes) == 1:
        shapes[0] += [rings[0] for rings in holes]
        return shapes, lines + open_holes
    return shapes, lines + open_holes + [[*rings[0], rings[0][0]] for rings in holes]  # nobody says whose they are


def _refs(way: Element, file: OsmFile) -> Refs:
    for ref in way.refs:
        if ref not in file.nodes:
            raise FloorPlanError(f"{way.name}: its node {ref[:40]!r} is not in the file")
    return [ref for i, ref in enumerate(way.refs) if i == 0 or ref != way.refs[i - 1]]


def _closed(chains: list[Refs]) -> tuple[list[list[Refs]], list[Refs]]:
    shapes = [[refs[:-1]] for refs in chains if len(refs) >= 4 and refs[0] == refs[-1]]
    return shapes, [refs for refs in chains if len(refs) >= 2 and not (len(refs) >= 4 and refs[0] == refs[-1])]


def _chained(ways: list[Refs]) -> list[Refs]:
    """Ways joined end to end, as far as they go."""
    waiting = [refs for refs in ways if len(refs) >= 2]
    done: list[Refs] = []
    while waiting:
        chain = waiting.pop(0)
        grown = True
        while grown and chain[0] != chain[-1]:
            grown = False
            for i, refs in enumerate(waiting):
                if chain[-1] in (refs[0], refs[-1]):
                    chain = chain + (refs[1:] if refs[0] == chain[-1] else refs[-2::-1])
                    del waiting[i]
                    grown = True
                    break
        done.append(chain)
    return done
