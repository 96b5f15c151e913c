"""Places of the walked path, and what becomes of the path when a later position is known."""

from __future__ import annotations

from itertools import accumulate
from math import cos, fsum, hypot, sin

from ...events import TrackNode
from ...types.attrs import evolve
from ..fuse.common_error import HEADING, SIZE, CommonError, X
from ..fuse.position_covariance import LENGTH_ERROR
from .walked_path import FIRST_SPACING, NotedPlace, Pair, WalkedPath

MOST_PLACES = 8
"""Largest number of places with a name, each of which has two rows of the common errors."""
WALKING_NOISE = 0.02
"""Random walk of the position by the strides themselves, m/sqrt(m): 2 cm for a stride of 1 m (assumed)."""
ROUNDS = 4
"""Number of times that the headings of a path are estimated, each from those before."""


def note_place(path: WalkedPath, name: str, t: float, position: Pair, variance: float, error: CommonError) -> None:
    """Note that the wearer is at the place `name` at `t`, s, whose estimate is `position`, m, common frame.

    `variance` is that of the report, m^2. The errors of the place are from now on those that the track has now."""
    old = path.places.pop(name, None)
    names = [one for one in path.places if one]
    if old is None and name and len(names) >= MOST_PLACES:
        old = path.places.pop(names[0])
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
    path: WalkedPath, t: float, was: Pair, now: Pair, variances: tuple[float, float], error: CommonError, settles: bool
) -> tuple[TrackNode, ...]:
    """Revise the nodes since the newest known position, because the wearer is at `now`, m, instead of at `was`.

    The path is turned piece by piece, so that it leads there (`_turned`); what is left of the correction is distributed
    along it, and it leads through the places whose estimates have moved. `variances` are that of the heading at the
    wearer before the correction, rad^2, and that of the report, m^2. Returns the revised nodes, the last of which is
    the one at `t`, s. If the position `settles` the path, it stays as it is up to there."""
    old = [*path.nodes, TrackNode(t, *was)]
    pieces = [(b.x - a.x, b.y - a.y) for a, b in zip(old, old[1:], strict=False)]
    distances = [0.0, *accumulate([hypot(*piece) for piece in pieces])]
    first = path.heading_variance
    turned = _turned(pieces, distances, (now[0] - old[0].x, now[1] - old[0].y), (first, variances[0]), variances[1])
    bent = [(old[0].x + x, old[0].y + y) for x, y in accumulate(turned, _plus, initial=(0.0, 0.0))]
    ends = {0: bent[0], len(old) - 1: now}
    for place in path.places.values():
        if 0 < place.node < len(old) - 1:
            ends[place.node] = estimate(place.first, error)
    revised = _distributed(bent, distances, ends)
    nodes = [TrackNode(node.t, *position) for node, position in zip(old, revised, strict=True)]
    if settles:
        path.nodes, path.walked, path.spacing, path.rejected = [nodes[-1]], 0.0, FIRST_SPACING, None
        path.places = {name: evolve(one, node=0) for name, one in path.places.items()}
        path.known, path.known_at = now, t
        path.heading_variance = max(0.0, error.covariance[HEADING][HEADING])
    else:
        path.nodes = nodes[:-1]
        path.add_node(nodes[-1])
    return tuple(nodes)


def _turned(
    pieces: list[Pair], distances: list[float], way: Pair, headings: tuple[float, float], variance: float
) -> list[Pair]:
    """Return the pieces of a path, each turned by its most probable error of the heading, if the path leads to `way`.

    All are in m. The error at the distance u, as a share of the whole, is a normal process: it has the first of the
    variances `headings`, rad^2, at the beginning, and grows to the second, half of it by a drift and half by a random
    walk. Its covariance is k(u, v) = first + (second - first) (u v + min(u, v)) / 2. `variance` is that of the end,
    m^2. With G, how the end moves with each heading (`across`), the headings are K G' (G K G' + R)^-1 z for what the
    end is off by, z. G is that of the newest headings, so this is repeated (Gauss-Newton). For very large errors it may
    not converge; what is left is distributed along the path afterwards."""
    whole = max(distances[-1], 1e-9)
    shares = [0.5 * (a + b) / whole for a, b in zip(distances, distances[1:], strict=False)]
    first, growth = headings[0], 0.5 * max(0.0, headings[1] - headings[0])
    noise = variance + WALKING_NOISE * WALKING_NOISE * whole
    angles, turned = [0.0] * len(pieces), pieces
    for _ in range(ROUNDS):
        # spread is K G': the sums over min(u, v) are those up to u, and u times those beyond
        across = [(-y, x) for x, y in turned]
        total, moment = _weighted(across, [1.0] * len(across)), _weighted(across, shares)
        spread: list[Pair] = []
        before, before_moment = (0.0, 0.0), (0.0, 0.0)
        for (x, y), u in zip(across, shares, strict=True):
            before = (before[0] + x, before[1] + y)
            before_moment = (before_moment[0] + u * x, before_moment[1] + u * y)
            cx, cy = [
                first * all_of + growth * (u * of_moment + b_moment + u * (all_of - b))
                for all_of, of_moment, b_moment, b in zip(total, moment, before_moment, before, strict=True)
            ]
            spread.append((cx, cy))
        xx = noise + LENGTH_ERROR**2 * way[0] ** 2 + fsum([g[0] * c[0] for g, c in zip(across, spread, strict=True)])
        xy = LENGTH_ERROR**2 * way[0] * way[1] + fsum([g[0] * c[1] for g, c in zip(across, spread, strict=True)])
        yy = noise + LENGTH_ERROR**2 * way[1] ** 2 + fsum([g[1] * c[1] for g, c in zip(across, spread, strict=True)])
        (ex, ey), (ax, ay) = _weighted(turned, [1.0] * len(turned)), _weighted(across, angles)
        zx, zy, determinant = way[0] - ex + ax, way[1] - ey + ay, xx * yy - xy * xy
        lx, ly = (yy * zx - xy * zy) / determinant, (xx * zy - xy * zx) / determinant
        angles = [cx * lx + cy * ly for cx, cy in spread]
        turned = [(cos(a) * x - sin(a) * y, sin(a) * x + cos(a) * y) for a, (x, y) in zip(angles, pieces, strict=True)]
    return turned


def _weighted(vectors: list[Pair], weights: list[float]) -> Pair:
    """Return the weighted sum of vectors."""
    pairs = list(zip(vectors, weights, strict=True))
    return (fsum([w * x for (x, _), w in pairs]), fsum([w * y for (_, y), w in pairs]))


def _plus(a: Pair, b: Pair) -> Pair:
    return (a[0] + b[0], a[1] + b[1])


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
