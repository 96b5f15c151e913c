"""The rows of a recording that cannot be used: each costs only itself, is counted, and the first ones are named."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import IO, AnyStr, Generic

from attrs import define, field, frozen

from .errors import RecordingError, Report, printable

MAX_NAMED = 3
"""Largest number of rows of a file that are named; of more, only the number is reported."""
MAX_EXCESS = 100_000
"""Number of bad rows, beyond that of the good ones, at which the reading ends; it takes about a second to read them."""
LONGEST_LINE = 65_536
"""Largest size of a line, bytes or characters (protocol/recording.md); 4,000 pressure cells of two feet take less."""
MAX_SKIPPED = 16_000_000
"""Largest part of a damaged line that is skipped, bytes: a power failure may leave some megabytes of zeros."""


@frozen
class Line(Generic[AnyStr]):
    """A line of a file."""

    number: int
    """Number of the line, counted from 1."""
    data: AnyStr
    """Content, of which at most LONGEST_LINE + 1 bytes or characters are kept."""
    is_whole: bool
    """Flag: the line has an end."""
    end: int
    """Size of the file up to the end of this line, bytes or characters."""

    @property
    def is_too_long(self) -> bool:
        """True for a line that is longer than a recording may have."""
        return len(self.data) > LONGEST_LINE

    @property
    def is_cut(self) -> bool:
        """True for the last line of a file that ends in the middle of it."""
        return not self.is_whole and not self.is_too_long


def read_lines(file: IO[AnyStr], line_feed: AnyStr) -> Iterator[Line[AnyStr]]:
    """Yield each line of a file that is not blank; it ends early after MAX_SKIPPED of a line that is too long."""
    number = size = skipped = 0
    while skipped < MAX_SKIPPED and (data := file.readline(LONGEST_LINE + 1)):
        number, size, skipped, part = number + 1, size + len(data), 0, data
        if len(data) <= LONGEST_LINE and not data.strip():
            continue
        while len(data) > LONGEST_LINE and part and not part.endswith(line_feed) and skipped < MAX_SKIPPED:
            part = file.readline(LONGEST_LINE)
            skipped += len(part)
        size += skipped
        yield Line(number, data, part.endswith(line_feed), size)


@define
class BadRows:
    """Counts the rows of a file that were left out, and reports them.

    `noun` is what a row is called. The first sentences are held back until there are more good rows than bad ones,
    since a file of bad rows gets an error instead."""

    path: Path
    report: Report
    noun: str = "line"
    count: int = 0
    """Number of bad rows."""
    good: int = 0
    """Number of good rows."""
    _first: tuple[str, str] = ("", "")
    """Place and fault of the first bad row."""
    _held_back: list[str] = field(factory=list)

    def add_good(self) -> None:
        """Count a good row."""
        self.good += 1
        if self._held_back and self.good > self.count:
            self._report_named()

    def add(self, where: str, what: str) -> None:
        """Count the bad row at `where`, whose fault is `what`; raise RecordingError after far too many."""
        if not self.count:
            self._first = (where, what)
        if self.count < MAX_NAMED:
            self._held_back.append(f"{where}: {what}; this {self.noun} is left out")
        self.count += 1
        if self.count > self.good + MAX_EXCESS:
            self._raise()

    def finish(self) -> None:
        """Report the number of bad rows if not all were named; raise RecordingError if they are more than half."""
        if self.count > self.good:
            self._raise()
        self._report_named()
        if self.count > MAX_NAMED:
            self.report(f"{printable(str(self.path))}: {self.words}")

    @property
    def words(self) -> str:
        """Number of bad rows in words."""
        return f"{self.count} of {self.count + self.good} {self.noun}s are left out"

    def _report_named(self) -> None:
        for sentence in self._held_back:
            self.report(f"{printable(str(self.path))}: {sentence}")
        self._held_back.clear()

    def _raise(self) -> None:
        where, what = self._first
        rest = f"; {self.count} of {self.count + self.good} {self.noun}s cannot be used" if self.count > 1 else ""
        raise RecordingError(self.path, f"{what}{rest}", where)
