"""Finds true heel-strikes and toe-offs in labels and in the signals of contact switches."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

LEAST_RANGE = 150.0
"""Smallest range of a working switch between unloaded and loaded, counts; less is dead or too weak."""
CLOSES, OPENS = 0.20, 0.10
"""Shares of a switch's range at which contact starts and ends: well above its unloaded level, early in its slope."""
FORCE = 20.0
"""Smallest force of a foot on the ground, N."""
SHORTEST = 0.15
"""Shortest contact or flight, s; a shorter one is a bounce of the switch."""


def switch_contacts(t: NDArray[Any], counts: NDArray[Any]) -> list[tuple[float, float]] | None:
    """Return the spans of contact [start, end] in s of one pressure switch; None when it is dead.

    `counts` (n,) are its readings at `t` (n,). The spans in which the recording starts and ends are left out, because
    one of their edges is not seen."""
    unloaded, loaded = np.percentile(counts, [2.0, 97.0])
    if loaded - unloaded < LEAST_RANGE:
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
    """Return the whole spans of contact [start, end] in s of a force (n,), N, at `t` (n,).

    Spans cut off at an end of the recording are left out."""
    closed = force > FORCE
    turns = np.flatnonzero(closed[1:] != closed[:-1]) + 1
    edges = without_bounces([(float(t[k]), bool(closed[k])) for k in turns])
    return [(a, b) for (a, on), (b, _) in zip(edges, edges[1:], strict=False) if on]


def without_bounces(edges: Sequence[tuple[float, bool]]) -> list[tuple[float, bool]]:
    """Return the edges without the pairs that are closer together than a contact or a flight can be."""
    kept: list[tuple[float, bool]] = []
    for edge in edges:
        if kept and edge[0] - kept[-1][0] < SHORTEST:
            kept.pop()
        else:
            kept.append(edge)
    return kept


def merged(spans: Sequence[tuple[float, float]], gap: float = 1e-3) -> list[tuple[float, float]]:
    """Return the spans in order of time, with spans joined that touch within `gap` s."""
    joined: list[tuple[float, float]] = []
    for start, end in sorted(spans):
        if joined and start <= joined[-1][1] + gap:
            joined[-1] = (joined[-1][0], max(end, joined[-1][1]))
        else:
            joined.append((start, end))
    return joined
