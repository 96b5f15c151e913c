"""Matches found events with true ones, one to one within 250 ms: F1, median offset, its spread, and signed errors."""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Iterable, Sequence

import numpy as np
from attrs import frozen


@frozen
class Errors:
    """Signed errors, ours less the true value: relative for legs (0.01 is 1 %), in s for stride times."""

    values: tuple[float, ...] = ()

    def __add__(self, other: Errors) -> Errors:
        return Errors(self.values + other.values)

    @property
    def mean(self) -> float | None:
        """Mean magnitude of the errors."""
        return float(np.mean(np.abs(self.values))) if self.values else None

    @property
    def median(self) -> float | None:
        """Median magnitude of the errors."""
        return float(np.median(np.abs(self.values))) if self.values else None

    @property
    def bias(self) -> float | None:
        """Signed median of the errors: positive when ours are too long."""
        return float(np.median(self.values)) if self.values else None


TOLERANCE = 0.25
"""Largest distance of a match, s; design: "matched within 250 ms"."""


@frozen
class Matching:
    """Numbers of true and found events of one kind; `offsets`: found minus true, s, of each match."""

    n_true: int = 0
    n_found: int = 0
    offsets: tuple[float, ...] = ()

    def __add__(self, other: Matching) -> Matching:
        return Matching(self.n_true + other.n_true, self.n_found + other.n_found, self.offsets + other.offsets)

    @property
    def f1(self) -> float | None:
        """F1, 2 x matched / (true + found); None when there is no true and no found event."""
        total = self.n_true + self.n_found
        return 2.0 * len(self.offsets) / total if total else None

    @property
    def bias(self) -> float | None:
        """Median offset, s: positive when found events are late."""
        return float(np.median(self.offsets)) if self.offsets else None

    @property
    def off(self) -> float | None:
        """Median magnitude of the offsets, s."""
        return float(np.median(np.abs(self.offsets))) if self.offsets else None

    @property
    def mad(self) -> float | None:
        """Median absolute deviation of the offsets from their median, s."""
        return float(np.median(np.abs(np.array(self.offsets) - np.median(self.offsets)))) if self.offsets else None


def match(
    true: Iterable[float], found: Iterable[float], *, windows: Sequence[tuple[float, float]] | None = None
) -> Matching:
    """Match true and found times, the closest first, each used once, none further apart than TOLERANCE.

    `windows` are the labelled spans of time, s. A found event outside all of them, each widened by the tolerance, is
    neither right nor wrong and is left out. None stands for the span from the first to the last true event."""
    truth = sorted(true)
    if windows is None:
        windows = [(truth[0], truth[-1])] if truth else []
    inside = sorted(t for t in found if any(a - TOLERANCE <= t <= b + TOLERANCE for a, b in windows))
    matched = pairs(truth, inside, TOLERANCE)
    return Matching(len(truth), len(inside), tuple(inside[j] - truth[i] for i, j in matched))


def pairs(true: Sequence[float], found: Sequence[float], tolerance: float) -> list[tuple[int, int]]:
    """Return (index in `true`, index in `found`) of the pairs within `tolerance`, in the order of `true`.

    The closest pairs are taken first and each time is used once. Both inputs are in order of time."""
    near: list[tuple[float, int, int]] = []
    for i, t in enumerate(true):
        around = range(bisect_left(found, t - 2.0 * tolerance), bisect_right(found, t + 2.0 * tolerance))
        near += [(abs(found[j] - t), i, j) for j in around if abs(found[j] - t) <= tolerance]
    near.sort()
    free_true, free_found = set(range(len(true))), set(range(len(found)))
    chosen: list[tuple[int, int]] = []
    for _, i, j in near:
        if i in free_true and j in free_found:
            free_true.discard(i)
            free_found.discard(j)
            chosen.append((i, j))
    return sorted(chosen)


def interval_errors(true: Iterable[float], found: Iterable[float], *, longest: float) -> Errors:
    """Return the errors, s, of the intervals between found events that match consecutive true events.

    Only true events that follow each other within `longest` s and are both matched count."""
    truth, ours = sorted(true), sorted(found)
    by_true = dict(pairs(truth, ours, TOLERANCE))
    both = [k for k in range(len(truth) - 1) if k in by_true and k + 1 in by_true]
    lasted = [(ours[by_true[k + 1]] - ours[by_true[k]], truth[k + 1] - truth[k]) for k in both]
    return Errors(tuple([took - should for took, should in lasted if should <= longest]))
