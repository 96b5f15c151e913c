"""Scores strides against surveyed ones, for which each footprint was measured on the floor.

`times[k]` is the end of the stance before stride k + 1, `places[k]` the surveyed point on which the foot stood then.
So stride k + 1 lasts from times[k] to times[k + 1]. A found stride belongs to the surveyed stride in which it ends: it
ends at foot-flat, early in the stance whose end is the survey's time. In fast walking a stance is very short, and a
foot-flat may come a little after the survey's end of stance; it still belongs to that stance (SLACK)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import attrs
import numpy as np
from attrs import frozen
from numpy.typing import NDArray

from .alignment import Floats, aligned_at_start, at_times
from .legs import leg_lengths
from .matching import Errors

SLACK = 0.15
"""Time by which a found stride may end after its surveyed end, s: less than half of any swing.

So it never ends in the next stride."""
ALIGNED_OVER = 2.0
"""Length of path over which a track is aligned, m; design: "after aligning the first two metres"."""
STILL_SPEED = 0.15
"""Speed limit of a marker on a standing foot, m/s; a swinging foot is faster."""
SPEED_HALF_WINDOW = 0.05
"""Time before and after an instant over which a marker's speed is measured, s."""
SHORTEST_STANCE = 0.2
"""Shortest time that a marker stands still in stance, s."""
SHORTEST_STRIDE = 0.1
"""Shortest distance between two stances of a foot, m; positions closer together belong to one stance."""


@frozen
class StrideScore:
    """Strides compared with the survey. Errors are relative to each surveyed length (0.01 is 1 %)."""

    n_true: int = 0
    """Number of surveyed strides."""
    n_found: int = 0
    """Number of surveyed strides that were found."""
    n_invented: int = 0
    """Number of found strides beyond the first in one surveyed stride."""
    errors: Errors = Errors()
    """Relative error of the length of each stride found."""
    track_errors: Errors = Errors()
    """Relative error of the distance between the live positions at the survey's times, of every stride."""

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
    """Score `steps`, pairs of (t_end, stride_length), against the true strides between `times` (n+1,).

    The true `lengths` (n,) are in m. A found stride belongs to the true stride from times[k] to times[k + 1] when it
    ends in that span moved on by `slack` s; one that ends in no such span is left out. A length that is not known (NaN)
    counts as a stride but gives no error. Where several found strides end in one true stride, the longest counts as
    found and the others as invented."""
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
    """Score `steps` and the live `track` (m,3) at `track_t` against surveyed `places` (n+1,2) at `times` (n+1,).

    `steps` are pairs of (t_end, stride_length)."""
    lengths = np.linalg.norm(np.diff(np.asarray(places, np.float64)[:, :2], axis=0), axis=1)
    known = lengths > 0.0
    off = leg_lengths(times, track_t, track)[known] / lengths[known] - 1.0
    return attrs.evolve(stride_score(times, lengths, steps), track_errors=Errors(tuple(off.tolist())))


def marker_stances(t: NDArray[Any], places: NDArray[Any]) -> tuple[Floats, Floats]:
    """Return the ends (n,) of the stances of a marker on a foot, s, and its mean position in each (n,3).

    `places` (m,3) are the marker's positions at `t` (m,)."""
    when, where = np.asarray(t, np.float64), np.asarray(places, np.float64)
    ahead, behind = at_times(when, where, when + SPEED_HALF_WINDOW), at_times(when, where, when - SPEED_HALF_WINDOW)
    still = np.linalg.norm(ahead - behind, axis=1) < STILL_SPEED * 2.0 * SPEED_HALF_WINDOW
    edges = [0, *(np.flatnonzero(still[1:] != still[:-1]) + 1).tolist(), len(still)]
    ends: list[float] = []
    stances: list[Floats] = []
    for a, b in zip(edges, edges[1:], strict=False):
        if not still[a] or when[b - 1] - when[a] < SHORTEST_STANCE:
            continue
        place = where[a:b].mean(axis=0)
        if stances and float(np.linalg.norm(place[:2] - stances[-1][:2])) < SHORTEST_STRIDE:
            ends.pop()
            stances.pop()
        ends.append(float(when[b - 1]))
        stances.append(place)
    return np.array(ends), np.array(stances).reshape(-1, 3)


def position_errors(times: NDArray[Any], places: NDArray[Any], track_t: Floats, track: Floats) -> Floats:
    """Return the horizontal distance (n+1,) in m from each surveyed place to the live track at its time.

    The track is first turned and shifted to fit the surveyed places of the first two metres best (up to the first place
    that is two metres along the path)."""
    truth = np.asarray(places, np.float64)[:, :2]
    moved = aligned_at_start(at_times(track_t, track[:, :2], times), truth, ALIGNED_OVER)
    return np.asarray(np.linalg.norm(moved - truth, axis=1), dtype=np.float64)
