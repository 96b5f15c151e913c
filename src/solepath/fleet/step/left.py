"""What an order remembers: numbers that were never used, runs that were left, and what came late. All of it bounded."""

from __future__ import annotations

from attrs import define, field, frozen

from .sent import MOST

SPANS = 16
"""Spans of numbers that were not used."""
FORGOTTEN = 4
"""Ranges of runs of which no span is remembered any more."""


@frozen
class NumberSpan:
    """Numbers from `first` to before `end` that were never used. `end` beyond MOST: what was still to come of a run
    when it was left."""

    run: int
    first: int
    end: int

    @property
    def is_open(self) -> bool:
        return self.end > MOST


@define
class Left:
    """What was left behind. Of a run that was left, the last span is open: from there on nothing of it was used."""

    spans: list[NumberSpan] = field(factory=list)
    """The last that were given up, oldest first."""
    forgotten: list[tuple[int, int]] = field(factory=list)
    """From which run to which: those that were left and are not remembered. Where there are too many ranges the two
    that lie closest are taken together, and with them what is in between."""

    def add(self, span: NumberSpan) -> None:
        if len(self.spans) >= SPANS:
            oldest = self.spans.pop(0)
            if oldest.is_open:
                self._forget(oldest.run)
        self.spans.append(span)

    def take(self, run: int) -> int:
        """The run is entered, again or for the first time: the number from which on nothing of it was used."""
        for span in self.spans:
            if span.run == run and span.is_open:
                self.spans.remove(span)
                return span.first
        return 0

    def was_left(self, run: int) -> bool:
        return self._is_forgotten(run) or any([span.run == run for span in self.spans])

    def was_used(self, run: int, number: int) -> bool:
        """As far as is known."""
        spans = [span for span in self.spans if span.run == run]
        return bool(spans) and not any([span.first <= number < span.end for span in spans])

    def was_given_up(self, run: int, number: int) -> bool:
        """As far as is known."""
        return any([span.run == run and span.first <= number < span.end for span in self.spans])

    def may_go_on(self, run: int, number: int) -> bool:
        """It is certain that neither this nor anything beyond it was used, of a run that the reader is not in."""
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
    """Rows of one run that came and could not be used: the last run that had any."""

    run: int = 0
    count: int = 0
    """How many; 0: none, of any run."""
    straight: int = 0
    """How many of them came one beyond the other since anything was used, where the run may go on."""
    number: int = 0
    """The last of those."""

    def add(self, run: int) -> bool:
        """One more. Whether it is told: the first, the second, the fourth, the eighth are, and so on."""
        if run != self.run:
            self.run, self.count, self.straight, self.number = run, 0, 0, 0
        self.count += 1
        return self.count & (self.count - 1) == 0

    def with_this(self, run: int, number: int) -> int:
        """How many came one beyond the other, this one among them."""
        if run != self.run or not self.straight:
            return 1
        return self.straight + (number > self.number)
