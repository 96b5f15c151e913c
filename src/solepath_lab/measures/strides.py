"""Scores found strides against a survey, in which every footprint was measured on the floor.

`times[k]` is the end of a stance, s, and `places[k]` the surveyed point on which the foot stood then. A surveyed
stride lasts from times[k] to times[k + 1]. A found stride ends at foot-flat, early in the stance that ends at
times[k + 1]; it is assigned to the surveyed stride in which it ends. In fast walking a stance is very short, and a
foot-flat may be found a little after the survey's end of stance. END_TOLERANCE allows for that."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Any

import attrs
import numpy as np
from attrs import frozen
from numpy.typing import NDArray

from solepath.validate.alignment import Floats, at_times
from solepath.validate.foot_run import FootRun
from solepath.validate.matching import Errors

from .legs import leg_lengths

END_TOLERANCE = 0.15
"""Time by which a found stride may end after its surveyed stride, s: less than half of any swing."""
STILL_SPEED = 0.15
"""Largest speed of a marker on a standing foot, m/s; in swing it is faster."""
SPEED_HALF_WINDOW = 0.05
"""Time before and after an instant over which a marker's speed is measured, s."""
SHORTEST_STANCE = 0.2
"""Shortest time that a marker stands still in stance, s."""
SHORTEST_STRIDE = 0.1
"""Shortest horizontal distance between two stances of a foot, m; positions closer together are one stance."""


@frozen
class StrideScore:
    """The comparison of strides with a survey. Errors are relative to each surveyed length (0.01 is 1 %)."""

    n_true: int = 0
    """Number of surveyed strides."""
    n_found: int = 0
    """Number of surveyed strides that were found."""
    n_invented: int = 0
    """Number of found strides beyond the first in each surveyed stride."""
    errors: Errors = Errors()
    """Relative error of the length of each stride found."""
    track_errors: Errors = Errors()
    """Relative error of the distance between the live positions at the survey's times, for every surveyed stride."""
    longest: float | None = None
    """Length of the longest found stride, m; None where each stride has a true one of its own."""

    @property
    def figures(self) -> dict[str, float | None]:
        """Figures by name, as in tables and JSON."""
        return {
            "strides_true": self.n_true,
            "strides_found": self.n_found,
            "strides_invented": self.n_invented,
            "stride_error": self.errors.mean,
            "stride_error_median": self.errors.median,
            "stride_error_track": self.track_errors.mean,
            "stride_longest": self.longest,
        }

    def __add__(self, other: StrideScore) -> StrideScore:
        return StrideScore(
            self.n_true + other.n_true,
            self.n_found + other.n_found,
            self.n_invented + other.n_invented,
            self.errors + other.errors,
            self.track_errors + other.track_errors,
            max((one.longest for one in (self, other) if one.longest is not None), default=None),
        )


def stride_score(
    times: NDArray[Any],
    lengths: NDArray[Any],
    strides: Sequence[tuple[float, float]],
    end_tolerance: float = END_TOLERANCE,
) -> StrideScore:
    """Score found `strides`, pairs of end (s) and length (m), against true ones between `times` (n+1,), s.

    `lengths` (n,) are the true ones, m. A found stride is assigned to the true stride from times[k] to times[k + 1]
    when it ends in that span, delayed by `end_tolerance` s. One that ends in no such span is left out. A true stride of
    unknown length (NaN) is counted but gives no error. Of several found strides that are assigned to one true stride,
    the longest counts as found and the others as invented."""
    true_lengths: list[float] = np.asarray(lengths, np.float64).tolist()
    assigned: list[list[float]] = [[] for _ in true_lengths]
    for t_end, length in strides:
        index = int(np.searchsorted(times, t_end - end_tolerance, side="left")) - 1
        if 0 <= index < len(assigned):
            assigned[index].append(length)
    errors = [max(ours) / true - 1.0 for ours, true in zip(assigned, true_lengths, strict=True) if ours and true > 0]
    found = [ours for ours in assigned if ours]
    return StrideScore(len(assigned), len(found), sum(map(len, found)) - len(found), Errors(tuple(errors)))


def counted_score(n_true: int, lengths: Sequence[float]) -> StrideScore:
    """Score found strides of these `lengths`, m, where only the number of true ones is known.

    A merged pair of strides and an invented one cancel out in the numbers; the longest stride shows the pair."""
    found = len(lengths)
    return StrideScore(n_true, min(n_true, found), max(0, found - n_true), longest=max(lengths, default=None))


def surveyed_score(times: NDArray[Any], places: NDArray[Any], foot: FootRun) -> StrideScore:
    """Score the strides and the live track of a foot against surveyed `places` (n+1,2) at `times` (n+1,)."""
    if not len(foot.t):
        return StrideScore(n_true=len(times) - 1)
    lengths = np.linalg.norm(np.diff(np.asarray(places, np.float64)[:, :2], axis=0), axis=1)
    known = lengths > 0.0
    errors = leg_lengths(times, foot)[known] / lengths[known] - 1.0
    return attrs.evolve(stride_score(times, lengths, foot.stride_lengths), track_errors=Errors(tuple(errors.tolist())))


def marker_stances(t: NDArray[Any], places: NDArray[Any]) -> tuple[Floats, Floats]:
    """Return the ends (n,), s, of the stances of a marker on a foot, and the marker's mean position (n,3), m, in each.

    `places` (m,3) are the marker's positions, m, at `t` (m,), s."""
    times, positions = np.asarray(t, np.float64), np.asarray(places, np.float64)
    ahead, behind = (
        at_times(times, positions, times + SPEED_HALF_WINDOW), at_times(times, positions, times - SPEED_HALF_WINDOW)
    )  # fmt: skip
    still = np.linalg.norm(ahead - behind, axis=1) < STILL_SPEED * 2.0 * SPEED_HALF_WINDOW
    edges = [0, *(np.flatnonzero(still[1:] != still[:-1]) + 1).tolist(), len(still)]
    ends: list[float] = []
    stances: list[Floats] = []
    for a, b in pairwise(edges):
        if not still[a] or times[b - 1] - times[a] < SHORTEST_STANCE:
            continue
        place = positions[a:b].mean(axis=0)
        if stances and float(np.linalg.norm(place[:2] - stances[-1][:2])) < SHORTEST_STRIDE:
            ends.pop()
            stances.pop()
        ends.append(float(times[b - 1]))
        stances.append(place)
    return np.array(ends), np.array(stances).reshape(-1, 3)
