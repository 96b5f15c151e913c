"""Path of the wearer so far in a few nodes, the places on it, and what becomes of it when a later position is known."""

from __future__ import annotations

from math import cos, fsum, hypot, sin

from ...events import TrackNode
from ...types.attrs import define, evolve, field, frozen
from ..fuse.common_error import SIZE, CommonError, X

FIRST_SPACING = 5.0
"""Distance between the first nodes, m; it doubles whenever there are too many."""
MOST_NODES = 40
"""Largest number of nodes."""
MOST_PLACES = 8
"""Largest number of noted places, each of which has two rows of the common errors."""
Pair = tuple[float, float]
"""A position or a displacement in the horizontal plane, m."""


@frozen
class NotedPlace:
    """A place where the wearer was, whose position is estimated with the common errors."""

    first: int
    """First of its two rows among the errors."""
    node: int
    """Number of its node on the path."""


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
    places: dict[str, NotedPlace] = field(factory=dict, init=False)
    """Noted places by their names, the newest visited last."""
    rejected: Pair = field(default=(0.0, 0.0), init=False)
    """Newest rejected position, m, that was reported at the place without a name."""

    def add_stride(self, t: float, position: Pair, length: float) -> None:
        """Add the wearer's position after a stride that moved the wearer by `length`, m."""
        self.walked += length
        if self.nodes and self.walked < self.spacing:
            return
        self._add_node(TrackNode(t, *position))

    def _add_node(self, node: TrackNode) -> None:
        self.nodes.append(node)
        self.walked = 0.0
        if len(self.nodes) <= MOST_NODES:
            return
        needed = {self.settled, len(self.nodes) - 1, *[place.node for place in self.places.values()]}
        kept = [k for k in range(len(self.nodes)) if k % 2 == 0 or k in needed]
        self.nodes, self.settled = [self.nodes[k] for k in kept], kept.index(self.settled)
        self.places = {name: evolve(one, node=kept.index(one.node)) for name, one in self.places.items()}
        self.spacing *= 2.0

    def note(self, name: str, t: float, position: Pair, variance: float, error: CommonError) -> None:
        """Note that the wearer is at the place `name` at `t`, s, whose estimate is `position`, m, common frame.

        `variance` is that of the report, m^2. The errors of the place are from now on those that the track has now."""
        old = self.places.pop(name, None)
        if old is None and len(self.places) >= MOST_PLACES:
            old = self.places.pop(next(iter(self.places)))
        first = error.add_aids((0.0, 0.0), (0.0, 0.0)) if old is None else old.first
        p = error.covariance
        now = [list(p[X]), list(p[X + 1])]
        for axis, row in enumerate((first, first + 1)):
            error.aids[row - SIZE] = position[axis]
            for j, value in enumerate(now[axis]):
                p[row][j] = p[j][row] = value
        for axis, row in enumerate((first, first + 1)):
            p[row][first], p[row][first + 1] = now[axis][X], now[axis][X + 1]
            p[row][row] += variance
        self._add_node(TrackNode(t, *position))
        self.places[name] = NotedPlace(first, len(self.nodes) - 1)

    def visit(self, name: str) -> int | None:
        """Return the first row of a noted place; None if this name is new."""
        place = self.places.pop(name, None)
        if place is None:
            return None
        self.places[name] = place
        return place.first

    def estimate(self, first: int, error: CommonError) -> Pair:
        """Return the estimated position of the place whose rows begin at `first`, m, common frame."""
        return (error.aids[first - SIZE], error.aids[first - SIZE + 1])

    def revise(
        self, t: float, was: Pair, now: Pair, turn: float, error: CommonError, settles: bool
    ) -> tuple[TrackNode, ...]:
        """Revise the nodes since the newest known position, because the wearer is at `now`, m, instead of at `was`.

        The heading there was corrected by `turn`, rad. An error of the heading grows with the distance walked, so the
        path is bent more and more; what is left of the correction is distributed along it, and the path leads through
        the places whose estimates have moved. Returns the revised nodes, the last of which is the one at `t`, s. If the
        position `settles` the path, it stays as it is up to there."""
        old = [*self.nodes[self.settled :], TrackNode(t, *was)]
        pieces = [(b.x - a.x, b.y - a.y) for a, b in zip(old, old[1:], strict=False)]
        lengths = [hypot(*piece) for piece in pieces]
        whole, so_far = max(fsum(lengths), 1e-9), 0.0
        x, y = old[0].x, old[0].y
        bent, distances = [(x, y)], [0.0]
        for (dx, dy), length in zip(pieces, lengths, strict=True):
            angle = turn * (so_far + 0.5 * length) / whole
            c, s = cos(angle), sin(angle)
            x, y, so_far = x + c * dx - s * dy, y + s * dx + c * dy, so_far + length
            bent.append((x, y))
            distances.append(so_far)
        ends = {0: bent[0], len(old) - 1: now}
        for place in self.places.values():
            if 0 < place.node - self.settled < len(old) - 1:
                ends[place.node - self.settled] = self.estimate(place.first, error)
        revised = _distributed(bent, distances, ends)
        nodes = [TrackNode(node.t, *position) for node, position in zip(old, revised, strict=True)]
        self.nodes[self.settled :] = nodes[:-1]
        self._add_node(nodes[-1])
        if settles:
            self.settled, self.known, self.known_at = len(self.nodes) - 1, now, t
        return tuple(nodes)


def _distributed(path: list[Pair], distances: list[float], ends: dict[int, Pair]) -> list[Pair]:
    """Return the path through the positions in `ends` by the numbers of their nodes, moved linearly in between.

    `distances` are those from the first node along the path, m."""
    numbers, moved = sorted(ends), [path[0]]
    for a, b in zip(numbers, numbers[1:], strict=False):
        (ax, ay), (bx, by) = [(ends[k][0] - path[k][0], ends[k][1] - path[k][1]) for k in (a, b)]
        length = max(distances[b] - distances[a], 1e-9)
        for k in range(a + 1, b):
            share = (distances[k] - distances[a]) / length
            moved.append((path[k][0] + ax + share * (bx - ax), path[k][1] + ay + share * (by - ay)))
        moved.append(ends[b])
    return moved
