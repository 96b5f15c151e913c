"""Surveyed strides: each footprint was measured on the floor.

`times[k]` is the end of the rest before stride k + 1, `places[k]` the surveyed point on which the foot rested then. So
stride k + 1 lasts from times[k] to times[k + 1], and a step of ours belongs to the stride in which it ends: our step
ends at foot-flat, early in the rest whose end the survey's time is. In fast walking a rest is a moment, and a foot-flat
may come a little after the time that the survey calls its end; it still belongs to it (SLACK).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import attrs
import numpy as np
from attrs import frozen
from numpy.typing import NDArray

from .alignment import Floats, aligned_at_start, at_times
from .legs import between
from .matching import Errors

SLACK = 0.15
"""s by which a step may end after its stride's time: less than half of any swing, so never in the next stride."""
ALIGNED_OVER = 2.0
"""m; design: "after aligning the first two metres"."""
STILL = 0.15
"""m/s: a marker on a foot that stands is slower, and one on a foot that swings is not."""
OVER = 0.05
"""s to both sides, over which a marker's speed is measured."""
REST = 0.2
"""s that a marker rests at the least in stance."""
LEAST = 0.1
"""m from one rest of a foot to the next, at the least; less is the same rest."""


@frozen
class StrideScore:
    """Strides against the survey. Errors are relative to each surveyed length (0.01 is 1 %)."""

    n_true: int = 0
    n_found: int = 0
    n_invented: int = 0
    """Steps of ours beyond the first in one surveyed stride."""
    errors: Errors = Errors()
    """Of our stride's length, of each stride found."""
    track_errors: Errors = Errors()
    """Of the distance between the live positions at the survey's times, of every stride."""

    def __add__(self, other: StrideScore) -> StrideScore:
        return StrideScore(
            self.n_true + other.n_true,
            self.n_found + other.n_found,
            self.n_invented + other.n_invented,
            self.errors + other.errors,
            self.track_errors + other.track_errors,
        )


def stride_score(
    times: NDArray[Any], lengths: NDArray[Any], steps: Sequence[tuple[float, float]], slack: float = SLACK
) -> StrideScore:
    """True strides between `times` (n+1,) of the true `lengths` (n,) in m against `steps`, pairs of (t_end,
    stride_length). A step belongs to the stride from times[k] to times[k + 1] when it ends in that span moved on by
    `slack` s; steps that end in none are left out. A length that is not known (NaN) counts as a stride but gives no
    error.

    Where several steps end in one true stride the longest counts as found and the others as invented.
    """
    true_lengths: list[float] = np.asarray(lengths, np.float64).tolist()
    ends: list[list[float]] = [[] for _ in true_lengths]
    for t_end, stride_length in steps:
        stride = int(np.searchsorted(times, t_end - slack, side="left")) - 1
        if 0 <= stride < len(ends):
            ends[stride].append(stride_length)
    errors = [max(f) / true - 1.0 for f, true in zip(ends, true_lengths, strict=True) if f and true > 0]
    found = [one for one in ends if one]
    return StrideScore(len(ends), len(found), sum(map(len, found)) - len(found), Errors(tuple(errors)))


def surveyed_score(
    times: NDArray[Any], places: NDArray[Any], track_t: Floats, track: Floats, steps: Sequence[tuple[float, float]]
) -> StrideScore:
    """Surveyed `places` (n+1,2) at `times` (n+1,) against `steps` as above and the live `track` (m,3) at `track_t`."""
    lengths = np.linalg.norm(np.diff(np.asarray(places, np.float64)[:, :2], axis=0), axis=1)
    known = lengths > 0.0
    off = between(times, track_t, track)[known] / lengths[known] - 1.0
    return attrs.evolve(stride_score(times, lengths, steps), track_errors=Errors(tuple(off.tolist())))


def marker_rests(t: NDArray[Any], places: NDArray[Any]) -> tuple[Floats, Floats]:
    """When (n,) the rests of a marker at `places` (m,3) on a foot end, s, and where (n,3) it is on the mean."""
    when, where = np.asarray(t, np.float64), np.asarray(places, np.float64)
    ahead, behind = at_times(when, where, when + OVER), at_times(when, where, when - OVER)
    still = np.linalg.norm(ahead - behind, axis=1) < STILL * 2.0 * OVER
    edges = [0, *(np.flatnonzero(still[1:] != still[:-1]) + 1).tolist(), len(still)]
    ends: list[float] = []
    rests: list[Floats] = []
    for a, b in zip(edges, edges[1:], strict=False):
        if not still[a] or when[b - 1] - when[a] < REST:
            continue
        place = where[a:b].mean(axis=0)
        if rests and float(np.linalg.norm(place[:2] - rests[-1][:2])) < LEAST:
            ends.pop()
            rests.pop()
        ends.append(float(when[b - 1]))
        rests.append(place)
    return np.array(ends), np.array(rests).reshape(-1, 3)


def position_errors(times: NDArray[Any], places: NDArray[Any], track_t: Floats, track: Floats) -> Floats:
    """Horizontal distance (n+1,) in m from each surveyed place to the live track at its time, after the turn and shift
    that fit the surveyed places of the first two metres best (up to the first that is two metres along the path)."""
    truth = np.asarray(places, np.float64)[:, :2]
    moved = aligned_at_start(at_times(track_t, track[:, :2], times), truth, ALIGNED_OVER)
    return np.asarray(np.linalg.norm(moved - truth, axis=1), dtype=np.float64)
