"""True heel-strikes and toe-offs, from labels and from contact switches."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

DEAD = 150.0
"""A switch whose counts range less than this between unloaded and loaded is dead or too weak to tell anything."""
CLOSES, OPENS = 0.20, 0.10
"""Shares of a switch's range at which contact begins and ends: well above its rest level, early in its slope."""
FORCE = 20.0
"""N that a foot on the ground shows at the least."""
SHORTEST = 0.15
"""s; contacts and flights shorter than this are bounces of the switch."""


def switch_contacts(t: NDArray[Any], counts: NDArray[Any]) -> list[tuple[float, float]] | None:
    """The spans of contact [begin, end] in s of one pressure switch, `counts` (n,) at `t` (n,); None when it is dead.

    The span that the recording begins in, and the one that it ends in, are left out: one of their edges is not seen.
    """
    unloaded, loaded = np.percentile(counts, [2.0, 97.0])
    if loaded - unloaded < DEAD:
        return None
    closes, opens = (unloaded + share * (loaded - unloaded) for share in (CLOSES, OPENS))
    edges: list[tuple[float, bool]] = []
    closed = bool(counts[0] > closes)
    for at, count in zip(t.tolist(), counts.tolist(), strict=True):
        if closed and count < opens or not closed and count > closes:
            closed = not closed
            edges.append((at, closed))
    edges = without_bounces(edges)
    return [(a, b) for (a, on), (b, _) in zip(edges, edges[1:], strict=False) if on]


def force_contacts(t: NDArray[Any], force: NDArray[Any]) -> list[tuple[float, float]]:
    """The spans of contact [begin, end] in s of a force (n,) at `t` (n,), N; those cut off at an end are left out."""
    closed = force > FORCE
    turns = np.flatnonzero(closed[1:] != closed[:-1]) + 1
    edges = without_bounces([(float(t[k]), bool(closed[k])) for k in turns])
    return [(a, b) for (a, on), (b, _) in zip(edges, edges[1:], strict=False) if on]


def without_bounces(edges: Sequence[tuple[float, bool]]) -> list[tuple[float, bool]]:
    """The edges without the pairs that lie closer together than a contact or a flight can be."""
    kept: list[tuple[float, bool]] = []
    for edge in edges:
        if kept and edge[0] - kept[-1][0] < SHORTEST:
            kept.pop()
        else:
            kept.append(edge)
    return kept


def merged(spans: Sequence[tuple[float, float]], gap: float = 1e-3) -> list[tuple[float, float]]:
    """Spans in order of time, those joined that touch within `gap` s."""
    joined: list[tuple[float, float]] = []
    for begin, end in sorted(spans):
        if joined and begin <= joined[-1][1] + gap:
            joined[-1] = (joined[-1][0], max(end, joined[-1][1]))
        else:
            joined.append((begin, end))
    return joined
