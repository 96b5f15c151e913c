"""Bounded memory of RowOrder: unused numbers, runs that are no longer current, and rows late or after the End.

Unused numbers are those of rows that did not pass: they were given up, or another run became current first."""

from __future__ import annotations

from attrs import define, field, frozen

from .sent import MAX_COUNT

MAX_SPANS = 16
"""Largest number of spans of unused numbers."""
MAX_FORGOTTEN_RANGES = 4
"""Largest number of ranges of forgotten runs (`UnusedNumbers.forgotten`)."""


@frozen
class NumberSpan:
    """The unused numbers of a run from `first` to `end` - 1.

    An `end` above MAX_COUNT means the whole rest of a run that is no longer current."""

    run: int
    first: int
    end: int

    @property
    def is_open(self) -> bool:
        """True when the span has no last number."""
        return self.end > MAX_COUNT


@define
class UnusedNumbers:
    """The remembered spans of unused numbers; a run that is no longer current has an open span at its end."""

    spans: list[NumberSpan] = field(factory=list)
    """The newest spans, oldest first."""
    forgotten: list[tuple[int, int]] = field(factory=list)
    """Ranges (first run, last run) of forgotten runs: no longer current, and without a remembered span.

    When there are too many ranges, the two with the smallest gap become one, together with the runs between them."""

    def add(self, span: NumberSpan) -> None:
        """Add a span; when there are too many, the oldest is discarded."""
        if len(self.spans) >= MAX_SPANS:
            oldest = self.spans.pop(0)
            if oldest.is_open:
                self._forget(oldest.run)
        self.spans.append(span)

    def reenter(self, run: int) -> int:
        """Remove the open span of a run that becomes current, and return its first number; 0 for a new run."""
        for span in self.spans:
            if span.run == run and span.is_open:
                self.spans.remove(span)
                return span.first
        return 0

    def was_current(self, run: int) -> bool:
        """Return whether this run was the wearer's current run before."""
        return self._is_forgotten(run) or any([span.run == run for span in self.spans])

    def was_used(self, run: int, number: int) -> bool:
        """Return whether the number counts as used: spans of the run are remembered, and none contains it."""
        spans = [span for span in self.spans if span.run == run]
        return bool(spans) and not any([span.first <= number < span.end for span in spans])

    def was_given_up(self, run: int, number: int) -> bool:
        """Return whether the number is in a remembered span; in the current run it was then given up."""
        return any([span.run == run and span.first <= number < span.end for span in self.spans])

    def may_continue(self, run: int, number: int) -> bool:
        """Return whether certainly no row from `number` on passed in this run, which is not the current one."""
        spans = [span for span in self.spans if span.run == run]
        if spans:
            return any([span.is_open and span.first <= number for span in spans])
        return not self._is_forgotten(run)

    def _is_forgotten(self, run: int) -> bool:
        return any([first <= run <= last for first, last in self.forgotten])

    def _forget(self, run: int) -> None:
        ranges = sorted([*self.forgotten, (run, run)])
        if len(ranges) > MAX_FORGOTTEN_RANGES:
            index = min(range(MAX_FORGOTTEN_RANGES), key=lambda i: ranges[i + 1][0] - ranges[i][1])
            (first, end), (_, other_end) = ranges[index : index + 2]
            ranges[index : index + 2] = [(first, max(end, other_end))]
        self.forgotten = ranges


@define
class StrayRows:
    """The count of rows that came late or after the End, for the last run that had such rows."""

    run: int = 0
    count: int = 0
    """Number of these rows; 0 when there were none in any run."""
    rising_rows: int = 0
    """Number of rows of this run, which may continue, each with a higher number than the last; 0 after a held row."""
    number: int = 0
    """Number of the last row in `rising_rows`."""

    def add(self, run: int) -> bool:
        """Count one more row; return whether it is reported, as the first, second, fourth, eighth and so on are."""
        if run != self.run:
            self.run, self.count, self.rising_rows, self.number = run, 0, 0, 0
        self.count += 1
        return self.count & (self.count - 1) == 0

    def count_rising(self, run: int, number: int) -> int:
        """Return `rising_rows` with this row, which counts if it is the first or its number is higher than the last."""
        if run != self.run or not self.rising_rows:
            return 1
        return self.rising_rows + (number > self.number)
