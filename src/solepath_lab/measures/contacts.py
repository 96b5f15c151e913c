"""Finds true contacts of a foot with the ground in the signals of switches and force sensors, and joins spans.

The thresholds were chosen by hand; no sweep of them is recorded."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

MIN_SWITCH_RANGE = 150.0
"""Smallest difference between a working switch's loaded and unloaded reading, counts of its converter."""
UNLOADED_PERCENTILE, LOADED_PERCENTILE = 2.0, 97.0
"""Percentiles of a switch's readings that stand for its unloaded and its loaded reading."""
CLOSING_SHARE, OPENING_SHARE = 0.20, 0.10
"""Shares of a switch's range above which contact starts and below which it ends."""
CONTACT_FORCE = 20.0
"""Smallest force of a foot on the ground, N."""
SHORTEST_SPAN = 0.15
"""Shortest time on the ground or in the air, s; a shorter one is a bounce of the switch."""


def switch_contacts(t: NDArray[Any], counts: NDArray[Any]) -> list[tuple[float, float]] | None:
    """Return the spans of contact (start, end), s, of one pressure switch; None when the switch does not work.

    `counts` (n,) are the readings at `t` (n,), s. Spans that are cut off at an end of the recording are left out."""
    unloaded, loaded = np.percentile(counts, [UNLOADED_PERCENTILE, LOADED_PERCENTILE])
    if loaded - unloaded < MIN_SWITCH_RANGE:
        return None
    closing_level, opening_level = (unloaded + share * (loaded - unloaded) for share in (CLOSING_SHARE, OPENING_SHARE))
    edges: list[tuple[float, bool]] = []
    closed = bool(counts[0] > closing_level)
    for at, count in zip(t.tolist(), counts.tolist(), strict=True):
        if closed and count < opening_level or not closed and count > closing_level:
            closed = not closed
            edges.append((at, closed))
    return _contacts(edges)


def is_loaded(t: NDArray[Any], counts: NDArray[Any], at: float) -> bool:
    """Return True when a working switch reads more at the time `at`, s, than the level at which it closes."""
    unloaded, loaded = np.percentile(counts, [UNLOADED_PERCENTILE, LOADED_PERCENTILE])
    reading = counts[min(int(np.searchsorted(t, at)), len(counts) - 1)]
    return bool(loaded - unloaded >= MIN_SWITCH_RANGE and reading > unloaded + CLOSING_SHARE * (loaded - unloaded))


def force_contacts(t: NDArray[Any], force: NDArray[Any]) -> list[tuple[float, float]]:
    """Return the spans of contact (start, end), s, of a foot with the `force` (n,), N, at `t` (n,), s.

    Spans that are cut off at an end of the recording are left out."""
    closed = force > CONTACT_FORCE
    changes = np.flatnonzero(closed[1:] != closed[:-1]) + 1
    return _contacts([(float(t[k]), bool(closed[k])) for k in changes])


def _contacts(edges: Sequence[tuple[float, bool]]) -> list[tuple[float, float]]:
    return [(a, b) for (a, on), (b, _) in pairwise(remove_bounces(edges)) if on]


def remove_bounces(edges: Sequence[tuple[float, bool]]) -> list[tuple[float, bool]]:
    """Return the edges (time, s; closed) without pairs of edges that are less than SHORTEST_SPAN apart."""
    true_edges: list[tuple[float, bool]] = []
    for edge in edges:
        if true_edges and edge[0] - true_edges[-1][0] < SHORTEST_SPAN:
            true_edges.pop()
        else:
            true_edges.append(edge)
    return true_edges


def merged(spans: Sequence[tuple[float, float]], gap: float = 1e-3) -> list[tuple[float, float]]:
    """Return the spans in order of time, with spans joined that overlap or are at most `gap` s apart."""
    joined: list[tuple[float, float]] = []
    for start, end in sorted(spans):
        if joined and start <= joined[-1][1] + gap:
            joined[-1] = (joined[-1][0], max(end, joined[-1][1]))
        else:
            joined.append((start, end))
    return joined
