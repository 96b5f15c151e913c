"""Legs: straight ways of a known length, walked to and fro.

Of a leg it is known how long it is, and at best when the wearer turned about at its end; not where the feet stood. A
foot's leg is the horizontal distance between its live positions at both ends. So it is as short or as long as the
wearer made it: a foot may stop before the line or pivot beyond it, which is some tenths of a metre of 10 m, and of
either sign.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import inf

import numpy as np

from .alignment import Floats, at_times
from .matching import Errors

EVERY = 0.05
"""s: a turn about is looked for among instants so far apart; a foot pivots for longer."""


def between(times: Sequence[float] | Floats, t: Floats, positions: Floats) -> Floats:
    """Horizontal distance (n,) in m between the live positions at each of `times` (n+1,) and the next."""
    places = at_times(t, positions[:, :2], np.asarray(times, np.float64))
    return np.asarray(np.linalg.norm(np.diff(places, axis=0), axis=1), dtype=np.float64)


def leg_errors(times: Sequence[float], true: Sequence[float], t: Floats, positions: Floats) -> Errors:
    """Of the legs between `times` (n+1,) s, that are `true` (n,) m long, relative. None of a foot without a track."""
    if not len(t):
        return Errors()
    found = between(times, t, positions)
    return Errors(tuple([float(ours) / length - 1.0 for ours, length in zip(found, true, strict=True)]))


def turned_about(t: Floats, positions: Floats, legs: int) -> list[float]:
    """The times (legs + 1,), s, at which a track of so many legs to and fro begins, turns about and ends.

    The track is laid on the line along which it reaches furthest (its first principal axis). Of all ways to choose that
    many instants it is the one for which the ways between them, alternately forth and back along that line, add up to
    the most: so each turn is where the foot was furthest, and no threshold is needed to tell a turn.
    """
    times = np.arange(t[0], t[-1] + EVERY, EVERY)
    places = at_times(t, positions[:, :2], times)
    places = places - places.mean(axis=0)
    along = places @ np.linalg.eigh(places.T @ places)[1][:, -1]
    return max([_zigzag(along, times, legs, sign) for sign in (1.0, -1.0)])[1]


def _zigzag(along: Floats, times: Floats, legs: int, sign: float) -> tuple[float, list[float]]:
    """The longest zigzag that sets out forth (`sign` 1) or back (-1), m, and its times, s."""
    # best[k]: of those that have come to their k-th turn so far, how long, and the instants; a turn out of a way forth
    # counts twice where it is, and so on: sum of sign (p[k+1] - p[k]) taken apart by places
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
