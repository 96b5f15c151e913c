"""Matches found events one to one with true ones at most 250 ms away, and measures the errors of the matches."""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Iterable, Sequence

import numpy as np
from attrs import field, frozen


@frozen
class Errors:
    """The signed errors, measured minus true value: relative for lengths (0.01 is 1 %), in s for stride times."""

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
        """Signed median of the errors: positive when the measured values are too large."""
        return float(np.median(self.values)) if self.values else None


TOLERANCE = 0.25
"""Largest time between the events of a match, s; design: "matched within 250 ms"."""


@frozen
class Matching:
    """The numbers of true and found events of one kind, and the offsets of their matches."""

    n_true: int = 0
    n_found: int = 0
    offsets: tuple[float, ...] = ()
    """Time of the found event minus that of the true one, s, for each match."""
    deviations: tuple[float, ...] = field(default=(), eq=False)
    """Offset minus the median offset of the same foot and recording, s, for each match."""

    def __add__(self, other: Matching) -> Matching:
        return Matching(
            self.n_true + other.n_true,
            self.n_found + other.n_found,
            self.offsets + other.offsets,
            self.deviations + other.deviations,
        )

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
    def median_magnitude(self) -> float | None:
        """Median magnitude of the offsets, s."""
        return float(np.median(np.abs(self.offsets))) if self.offsets else None

    @property
    def mad(self) -> float | None:
        """Median absolute deviation of the offsets from their median, s."""
        return float(np.median(np.abs(np.array(self.offsets) - np.median(self.offsets)))) if self.offsets else None

    @property
    def scatter(self) -> float | None:
        """Median magnitude of `deviations`, s: the MAD without what the clocks of feet and recordings add to it."""
        return float(np.median(np.abs(self.deviations))) if self.deviations else None


def match(
    true: Iterable[float], found: Iterable[float], *, windows: Sequence[tuple[float, float]] | None = None
) -> Matching:
    """Match true and found times, s, at most TOLERANCE apart. The closest pairs are taken first.

    `windows` are the labelled spans of time, s; None stands for the span from the first to the last true event. Found
    events more than TOLERANCE outside all windows are left out, because nobody knows whether they are right."""
    truth = sorted(true)
    if windows is None:
        windows = [(truth[0], truth[-1])] if truth else []
    inside = sorted(t for t in found if is_covered(t, windows))
    matched = pairs(truth, inside, TOLERANCE)
    offsets = tuple(inside[j] - truth[i] for i, j in matched)
    middle = float(np.median(offsets)) if offsets else 0.0
    return Matching(len(truth), len(inside), offsets, tuple(offset - middle for offset in offsets))


def is_covered(t: float, windows: Iterable[tuple[float, float]], tolerance: float = TOLERANCE) -> bool:
    """Return whether a time, s, is in a labelled span, or at most `tolerance` outside of it."""
    return any(start - tolerance <= t <= end + tolerance for start, end in windows)


def pairs(true: Sequence[float], found: Sequence[float], tolerance: float) -> list[tuple[int, int]]:
    """Return (index in `true`, index in `found`) of the pairs within `tolerance`, in the order of `true`.

    The closest pairs are taken first, and no time is in two pairs. Both inputs must be in order of time."""
    candidates: list[tuple[float, int, int]] = []
    for i, t in enumerate(true):
        # wider than `tolerance`, so that rounding leaves no pair out
        around = range(bisect_left(found, t - 2.0 * tolerance), bisect_right(found, t + 2.0 * tolerance))
        candidates += [(abs(found[j] - t), i, j) for j in around if abs(found[j] - t) <= tolerance]
    candidates.sort()
    free_true, free_found = set(range(len(true))), set(range(len(found)))
    chosen: list[tuple[int, int]] = []
    for _, i, j in candidates:
        if i in free_true and j in free_found:
            free_true.discard(i)
            free_found.discard(j)
            chosen.append((i, j))
    return sorted(chosen)


def interval_errors(true: Iterable[float], found: Iterable[float], *, longest: float) -> Errors:
    """Return the errors, s, of the times between consecutive events: found minus true.

    Only pairs of consecutive true events count that are at most `longest` s apart and both matched."""
    truth, ours = sorted(true), sorted(found)
    by_true = dict(pairs(truth, ours, TOLERANCE))
    matched = [k for k in range(len(truth) - 1) if k in by_true and k + 1 in by_true]
    durations = [(ours[by_true[k + 1]] - ours[by_true[k]], truth[k + 1] - truth[k]) for k in matched]
    return Errors(tuple([measured - expected for measured, expected in durations if expected <= longest]))
