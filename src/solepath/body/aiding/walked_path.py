"""Path of the wearer so far in a few nodes, where it begins on a floor plan, and the places that a person has named."""

from __future__ import annotations

from math import cos, sin

from ...events import TrackNode
from ...types.attrs import define, evolve, field, frozen

FIRST_SPACING = 5.0
"""Distance between the first nodes, m; it doubles whenever there are too many."""
MOST_NODES = 40
"""Largest number of nodes."""
Pair = tuple[float, float]
"""A position or a displacement in the horizontal plane, m."""


@frozen
class NotedPlace:
    """A place where the wearer was, whose position is estimated with the common errors."""

    first: int
    """First of its two rows among the errors."""
    node: int
    """Number of its node on the path."""


@frozen
class PlanStart:
    """The wearer's first place on the floor plan, plan frame, and the first heading, which is the world's x axis."""

    x: float
    """Place, m."""
    y: float
    """Place, m."""
    heading: float
    """Angle from the plan's x axis to the world's, rad."""
    spread: float
    """Uncertainty of the place, m (rms)."""

    def to_world(self, position: tuple[float, float]) -> tuple[float, float]:
        """Return a position on the plan in the world frame, both in m."""
        x, y, c, s = position[0] - self.x, position[1] - self.y, cos(self.heading), sin(self.heading)
        return (c * x + s * y, c * y - s * x)


@define
class WalkedPath:
    """Nodes at the ends of strides, common frame of both feet."""

    nodes: list[TrackNode] = field(factory=list, init=False)
    spacing: float = field(default=FIRST_SPACING, init=False)
    """Least distance from a node to the next one, m."""
    walked: float = field(default=0.0, init=False)
    """Distance walked since the newest node, m."""
    settled: int = field(default=0, init=False)
    """Number of the node of the newest position that was reported, up to which the path stays; 0 before any."""
    known: Pair = field(default=(0.0, 0.0), init=False)
    """Newest position that was reported, m; that of the start before any."""
    known_at: float | None = field(default=None, init=False)
    """Time of that report, s; None before any."""
    heading_variance: float = field(default=0.0, init=False)
    """Variance of the heading there, rad^2."""
    places: dict[str, NotedPlace] = field(factory=dict, init=False)
    """Noted places by their names, the newest visited last."""
    rejected: Pair = field(default=(0.0, 0.0), init=False)
    """Newest rejected position, m, that was reported at the place without a name."""

    def add_stride(self, t: float, position: Pair, length: float) -> None:
        """Add the wearer's position after a stride that moved the wearer by `length`, m."""
        self.walked += length
        if self.nodes and self.walked < self.spacing:
            return
        self.add_node(TrackNode(t, *position))

    def add_node(self, node: TrackNode) -> None:
        """Add a node; if there are too many, keep every second one and those that are needed."""
        self.nodes.append(node)
        self.walked = 0.0
        if len(self.nodes) <= MOST_NODES:
            return
        needed = {self.settled, len(self.nodes) - 1, *[place.node for place in self.places.values()]}
        kept = [k for k in range(len(self.nodes)) if k % 2 == 0 or k in needed]
        self.nodes, self.settled = [self.nodes[k] for k in kept], kept.index(self.settled)
        self.places = {name: evolve(one, node=kept.index(one.node)) for name, one in self.places.items()}
        self.spacing *= 2.0
