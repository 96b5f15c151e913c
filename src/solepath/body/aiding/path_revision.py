"""Places of the walked path, and what becomes of the path when a later position is known."""

from __future__ import annotations

from math import cos, fsum, hypot, sin

from ...events import TrackNode
from ..fuse.common_error import SIZE, CommonError, X
from .walked_path import NotedPlace, Pair, WalkedPath

MOST_PLACES = 8
"""Largest number of noted places, each of which has two rows of the common errors."""


def note_place(path: WalkedPath, name: str, t: float, position: Pair, variance: float, error: CommonError) -> None:
    """Note that the wearer is at the place `name` at `t`, s, whose estimate is `position`, m, common frame.

    `variance` is that of the report, m^2. The errors of the place are from now on those that the track has now."""
    old = path.places.pop(name, None)
    if old is None and len(path.places) >= MOST_PLACES:
        old = path.places.pop(next(iter(path.places)))
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
    path.add_node(TrackNode(t, *position))
    path.places[name] = NotedPlace(first, len(path.nodes) - 1)


def visit(path: WalkedPath, name: str) -> int | None:
    """Return the first row of a noted place; None if this name is new."""
    place = path.places.pop(name, None)
    if place is None:
        return None
    path.places[name] = place
    return place.first


def estimate(first: int, error: CommonError) -> Pair:
    """Return the estimated position of the place whose rows begin at `first`, m, common frame."""
    return (error.aids[first - SIZE], error.aids[first - SIZE + 1])


def revise_path(
    path: WalkedPath, t: float, was: Pair, now: Pair, turn: float, error: CommonError, settles: bool
) -> tuple[TrackNode, ...]:
    """Revise the nodes since the newest known position, because the wearer is at `now`, m, instead of at `was`.

    The heading there was corrected by `turn`, rad. An error of the heading grows with the distance walked, so the
    path is bent more and more; what is left of the correction is distributed along it, and the path leads through
    the places whose estimates have moved. Returns the revised nodes, the last of which is the one at `t`, s. If the
    position `settles` the path, it stays as it is up to there."""
    old = [*path.nodes[path.settled :], TrackNode(t, *was)]
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
    for place in path.places.values():
        if 0 < place.node - path.settled < len(old) - 1:
            ends[place.node - path.settled] = estimate(place.first, error)
    revised = _distributed(bent, distances, ends)
    nodes = [TrackNode(node.t, *position) for node, position in zip(old, revised, strict=True)]
    path.nodes[path.settled :] = nodes[:-1]
    path.add_node(nodes[-1])
    if settles:
        path.settled, path.known, path.known_at = len(path.nodes) - 1, now, t
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
