"""Errors of legs: straight ways of a known length, walked to and fro.

The length of a leg is known, and at best the time at which the wearer turned about at its end, but not where the feet
stood. A foot's leg is the horizontal distance between its live positions at both ends. A foot may stop before the line
or pivot beyond it, so a leg of 10 m is some tenths of a metre too short or too long."""

from __future__ import annotations

from collections.abc import Sequence
from math import inf

import numpy as np

from .alignment import Floats, at_times
from .matching import Errors

EVERY = 0.05
"""Interval between the instants among which a turn about is searched, s; a foot pivots for longer."""


def leg_lengths(times: Sequence[float] | Floats, t: Floats, positions: Floats) -> Floats:
    """Return the horizontal distances (n,) in m between the live positions at consecutive `times` (n+1,)."""
    places = at_times(t, positions[:, :2], np.asarray(times, np.float64))
    return np.asarray(np.linalg.norm(np.diff(places, axis=0), axis=1), dtype=np.float64)


def leg_errors(times: Sequence[float], true: Sequence[float], t: Floats, positions: Floats) -> Errors:
    """Return the relative errors of the legs between `times` (n+1,) s whose lengths are `true` (n,) m.

    A foot without a track has no errors."""
    if not len(t):
        return Errors()
    found = leg_lengths(times, t, positions)
    return Errors(tuple([float(ours) / length - 1.0 for ours, length in zip(found, true, strict=True)]))


def turned_about(t: Floats, positions: Floats, legs: int) -> list[float]:
    """Return the times (legs + 1,), s, at which a track of `legs` legs to and fro starts, turns about and ends.

    The track is projected on the line along which it reaches furthest (its first principal axis). Among all choices of
    that many instants the function takes the one with the largest sum of ways between them, alternately forth and back
    along that line. So each turn is where the foot was furthest, and no threshold is needed to find a turn."""
    times = np.arange(t[0], t[-1] + EVERY, EVERY)
    places = at_times(t, positions[:, :2], times)
    places = places - places.mean(axis=0)
    along = places @ np.linalg.eigh(places.T @ places)[1][:, -1]
    return max([_zigzag(along, times, legs, sign) for sign in (1.0, -1.0)])[1]


def _zigzag(along: Floats, times: Floats, legs: int, sign: float) -> tuple[float, list[float]]:
    """Return the longest zigzag that starts forth (`sign` 1) or back (-1), m, and its times, s."""
    # best[k]: length and instants of the longest zigzag that has reached its k-th turn. The length is the sum of
    # sign (p[k+1] - p[k]); sorted by places, each turn's place counts twice, with the sign of its weight.
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
