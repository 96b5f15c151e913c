"""Bounded memory of an order: numbers that were never used, runs that were left, and rows that came late."""

from __future__ import annotations

from attrs import define, field, frozen

from .sent import MOST

SPANS = 16
"""Largest number of spans of unused numbers."""
FORGOTTEN = 4
"""Largest number of ranges of runs of which no span is remembered any more."""


@frozen
class NumberSpan:
    """Numbers from `first` to before `end` that were never used.

    An `end` beyond MOST means everything that was still to come of a run when it was left."""

    run: int
    first: int
    end: int

    @property
    def is_open(self) -> bool:
        return self.end > MOST


@define
class UnusedNumbers:
    """Spans of numbers and runs that were not used.

    The last span of a run that was left is open: from its first number on nothing of the run was used."""

    spans: list[NumberSpan] = field(factory=list)
    """The spans that were given up last, oldest first."""
    forgotten: list[tuple[int, int]] = field(factory=list)
    """Ranges (first run, last run) of runs that were left and are not remembered. Of too many ranges the two that are
    closest are joined, together with the runs between them."""

    def add(self, span: NumberSpan) -> None:
        if len(self.spans) >= SPANS:
            oldest = self.spans.pop(0)
            if oldest.is_open:
                self._forget(oldest.run)
        self.spans.append(span)

    def reenter(self, run: int) -> int:
        """Enter a run, for the first time or again; return the number from which on nothing of it was used."""
        for span in self.spans:
            if span.run == run and span.is_open:
                self.spans.remove(span)
                return span.first
        return 0

    def was_left(self, run: int) -> bool:
        return self._is_forgotten(run) or any([span.run == run for span in self.spans])

    def was_used(self, run: int, number: int) -> bool:
        """Return whether the number was used, as far as is known."""
        spans = [span for span in self.spans if span.run == run]
        return bool(spans) and not any([span.first <= number < span.end for span in spans])

    def was_given_up(self, run: int, number: int) -> bool:
        """Return whether the number was given up, as far as is known."""
        return any([span.run == run and span.first <= number < span.end for span in self.spans])

    def may_go_on(self, run: int, number: int) -> bool:
        """Return whether certainly nothing from this number on was used of a run, not the current one."""
        spans = [span for span in self.spans if span.run == run]
        if spans:
            return any([span.is_open and span.first <= number for span in spans])
        return not self._is_forgotten(run)

    def _is_forgotten(self, run: int) -> bool:
        return any([first <= run <= last for first, last in self.forgotten])

    def _forget(self, run: int) -> None:
        ranges = sorted([*self.forgotten, (run, run)])
        if len(ranges) > FORGOTTEN:
            at = min(range(FORGOTTEN), key=lambda place: ranges[place + 1][0] - ranges[place][1])
            (first, end), (_, other) = ranges[at : at + 2]
            ranges[at : at + 2] = [(first, max(end, other))]
        self.forgotten = ranges


@define
class Strays:
    """Rows that came and could not be used, of the last run that had any."""

    run: int = 0
    count: int = 0
    """Number of these rows; 0 means none, of any run."""
    consecutive: int = 0
    """Number of these rows that came in rising order since a row was last used, in a run that may go on."""
    number: int = 0
    """Number of the last consecutive row."""

    def add(self, run: int) -> bool:
        """Count one more; return whether it is reported: the first, second, fourth, eighth and so on are."""
        if run != self.run:
            self.run, self.count, self.consecutive, self.number = run, 0, 0, 0
        self.count += 1
        return self.count & (self.count - 1) == 0

    def count_consecutive(self, run: int, number: int) -> int:
        """Return the number of rows that came in rising order, this one included."""
        if run != self.run or not self.consecutive:
            return 1
        return self.consecutive + (number > self.number)
