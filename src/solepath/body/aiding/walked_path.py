"""Path of the wearer so far in a few nodes, and what becomes of it when a later position is known."""

from __future__ import annotations

from math import cos, fsum, hypot, sin

from ...events import TrackNode
from ...types.attrs import define, field

FIRST_SPACING = 5.0
"""Distance between the first nodes, m; it doubles whenever there are too many."""
MOST_NODES = 40
"""Largest number of nodes."""


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

    def add_stride(self, t: float, position: tuple[float, float], length: float) -> None:
        """Add the wearer's position after a stride that moved the wearer by `length`, m."""
        self.walked += length
        if self.nodes and self.walked < self.spacing:
            return
        self.nodes.append(TrackNode(t, *position))
        self.walked = 0.0
        if len(self.nodes) > MOST_NODES:
            kept = [k for k in range(len(self.nodes)) if k % 2 == 0 or k == self.settled]
            self.nodes, self.settled = [self.nodes[k] for k in kept], kept.index(self.settled)
            self.spacing *= 2.0

    def revise(
        self, t: float, was: tuple[float, float], now: tuple[float, float], turn: float
    ) -> tuple[TrackNode, ...]:
        """Revise the nodes since the newest known position, because the wearer is at `now`, m, instead of at `was`.

        The heading there was corrected by `turn`, rad. An error of the heading grows with the distance walked, so the
        path is bent more and more; what is left of the correction is distributed along it. Returns the revised nodes,
        the last of which is the one at `t`, s."""
        old = [*self.nodes[self.settled :], TrackNode(t, *was)]
        pieces = [(b.x - a.x, b.y - a.y) for a, b in zip(old, old[1:], strict=False)]
        lengths = [hypot(*piece) for piece in pieces]
        whole, so_far = max(fsum(lengths), 1e-9), 0.0
        x, y = old[0].x, old[0].y
        bent, shares = [(x, y)], [0.0]
        for (dx, dy), length in zip(pieces, lengths, strict=True):
            angle = turn * (so_far + 0.5 * length) / whole
            c, s = cos(angle), sin(angle)
            x, y, so_far = x + c * dx - s * dy, y + s * dx + c * dy, so_far + length
            bent.append((x, y))
            shares.append(so_far / whole)
        shares[-1] = 1.0
        left_x, left_y = now[0] - x, now[1] - y
        revised = [
            TrackNode(node.t, px + share * left_x, py + share * left_y)
            for node, (px, py), share in zip(old, bent, shares, strict=True)
        ]
        self.nodes[self.settled :] = revised
        self.settled, self.walked = len(self.nodes) - 1, 0.0
        return tuple(revised)
