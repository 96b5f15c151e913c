"""Length errors of legs. A leg is a straight way of known length between two turns.

Sometimes the time of the turn at its end is known too, but never the positions of the feet. The length that a foot
measures is the horizontal distance between its live positions at both ends of the leg. A foot may turn before or beyond
the end, so a leg of 10 m is measured some tenths of a metre too short or too long."""

from __future__ import annotations

from collections.abc import Sequence
from math import inf

import numpy as np

from solepath.validate.alignment import Floats, at_times
from solepath.validate.foot_run import FootRun
from solepath.validate.matching import Errors

SEARCH_INTERVAL = 0.05
"""Time between the instants among which a U-turn is searched, s; a foot pivots for longer."""


def leg_lengths(times: Sequence[float] | Floats, track: FootRun) -> Floats:
    """Return the horizontal distances (n,), m, between the positions of a track at consecutive `times` (n+1,), s."""
    places = at_times(track.t, track.positions[:, :2], np.asarray(times, np.float64))
    return np.asarray(np.linalg.norm(np.diff(places, axis=0), axis=1), dtype=np.float64)


def leg_errors(times: Sequence[float] | Floats, true: Sequence[float] | Floats, track: FootRun) -> Errors:
    """Return the relative errors of the legs between `times` (n+1,), s, whose lengths are `true` (n,), m.

    A foot without a track has no errors."""
    return Errors(tuple((leg_lengths(times, track) / true - 1.0).tolist()) if len(track.t) else ())


def turn_times(track: FootRun, legs: int) -> list[float]:
    """Return the times (legs + 1,), s, of the start, the U-turns and the end of a track of `legs` legs to and fro.

    The track is projected on its first principal axis. The times are those between which the projection goes furthest,
    alternately forth and back. No threshold is needed."""
    times = np.arange(track.t[0], track.t[-1] + SEARCH_INTERVAL, SEARCH_INTERVAL)
    places = at_times(track.t, track.positions[:, :2], times)
    places = places - places.mean(axis=0)
    along = places @ np.linalg.eigh(places.T @ places)[1][:, -1]
    return max([_zigzag(along, times, legs, sign) for sign in (1.0, -1.0)])[1]


def _zigzag(along: Floats, times: Floats, legs: int, sign: float) -> tuple[float, list[float]]:
    """Return length (m) and times (s) of the longest zigzag whose first leg goes forth (`sign` 1) or back (-1)."""
    # The length is the sum over legs of sign * (-1)^k * (p[k+1] - p[k]), which is the sum of weights[k] * p[k].
    # best[k] has the length and the indices of the longest zigzag that has reached its k-th turn.
    weights = [0.0] * (legs + 1)
    for k in range(legs):
        weights[k] -= sign * (-1.0) ** k
        weights[k + 1] += sign * (-1.0) ** k
    best: list[tuple[float, tuple[int, ...]]] = [(-inf, ())] * (legs + 1)
    for index, place in enumerate(along.tolist()):
        for k in range(legs, -1, -1):
            before, chosen = best[k - 1] if k else (0.0, ())
            if before + weights[k] * place > best[k][0]:
                best[k] = (before + weights[k] * place, (*chosen, index))
    length, chosen = best[legs]
    return length, [float(times[index]) for index in chosen]
