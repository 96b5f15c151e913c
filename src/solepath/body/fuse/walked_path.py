"""Path of the wearer so far in a few nodes, and the places on it that a person has named."""

from __future__ import annotations

from itertools import pairwise
from math import fsum, hypot

from ...events import TrackNode
from ...types import Vec2
from ...types.attrs import define, evolve, field, frozen

FIRST_SPACING = 5.0
"""Distance between the first nodes, m; it doubles whenever there are too many."""
MOST_NODES = 40
"""Largest number of nodes."""
LEAST_SPACING = 0.5
"""Distance from the newest node within which a report moves that node instead of adding one, m."""


@frozen
class NotedPlace:
    """A place where the wearer was, whose position is estimated with the common errors."""

    first: int
    """First of its two rows among the errors."""
    node: int
    """Number of its node on the path."""


@define
class WalkedPath:
    """Nodes at the ends of strides since the newest known position, common frame of both feet."""

    nodes: list[TrackNode] = field(factory=list)
    """Nodes, of which the first stays as it is."""
    spacing: float = FIRST_SPACING
    """Least distance from a node to the next one, m."""
    walked: float = 0.0
    """Distance walked since the newest node, m."""
    known: Vec2 = (0.0, 0.0)
    """Newest position that was reported, m; that of the start before any."""
    known_at: float | None = None
    """Time of that report, s; None before any."""
    heading_variance: float = 0.0
    """Variance of the heading there, rad^2."""
    places: dict[str, NotedPlace] = field(factory=dict)
    """Noted places by their names, the newest visited last; the empty name is that of the newest rejected position."""
    rejected: Vec2 | None = None
    """Newest rejected position as it was reported, m; None if none was rejected since the newest one that was used."""

    def add_stride(self, t: float, position: complex, length: float) -> None:
        """Add the wearer's position after a stride that moved the wearer by `length`, m."""
        self.walked += length
        if not self.nodes or self.walked >= self.spacing:
            self.add_node(TrackNode(t, position.real, position.imag))

    def visit(self, name: str) -> int | None:
        """Return the first row of a noted place, which is the newest visited now; None if this name is new."""
        place = self.places.pop(name, None)
        if place is None:
            return None
        self.places[name] = place
        return place.first

    def add_node(self, node: TrackNode) -> None:
        """Add a node; if there are too many, keep every second one and those that are needed."""
        if len(self.nodes) > 1 and self.walked < LEAST_SPACING:
            self.nodes[-1] = node
            return
        self.nodes.append(node)
        self.walked = 0.0
        if len(self.nodes) <= MOST_NODES:
            return
        needed = {len(self.nodes) - 1, *[place.node for place in self.places.values()]}
        kept = [k for k in range(len(self.nodes)) if k % 2 == 0 or k in needed]
        length = fsum([hypot(b.x - a.x, b.y - a.y) for a, b in pairwise(self.nodes)])
        self.nodes = [self.nodes[k] for k in kept]
        self.places = {name: evolve(one, node=kept.index(one.node)) for name, one in self.places.items()}
        self.spacing = max(self.spacing, 2.0 * length / MOST_NODES)  # reports add nodes, which need no more distance
