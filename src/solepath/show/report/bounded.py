"""Keeps few values of a long walk, evenly spread, however long it is."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Generic, TypeVar

from attrs import define, field

T = TypeVar("T")


@define
class Thinned(Generic[T]):
    """The first and the last item, and evenly spaced ones between them.

    `add` is given how many are kept."""

    kept: list[T] = field(factory=list, init=False)
    every: int = field(default=1, init=False)
    """Interval of the items that are kept."""
    count: int = field(default=0, init=False)
    last: T | None = field(default=None, init=False)

    def add(self, item: T, most: int) -> None:
        """Add one item; fewer than `most` are kept."""
        if self.count % self.every == 0:
            if len(self.kept) >= most:
                self.kept = self.kept[::2]
                self.every *= 2
            if self.count % self.every == 0:
                self.kept.append(item)
        self.count += 1
        self.last = item

    def __iter__(self) -> Iterator[T]:
        yield from self.kept
        if self.last is not None and self.kept and self.kept[-1] is not self.last:
            yield self.last

    def __len__(self) -> int:
        return len(self.kept)
