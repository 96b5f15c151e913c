"""Keeps a limited number of evenly spaced items of a walk of any length, or all of them."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Generic, TypeVar

from ..types.attrs import state, stateful

T = TypeVar("T")


@stateful
class ThinnedList(Generic[T]):
    """The first and the last item of a sequence, and evenly spaced items between them."""

    items: list[T] = state(factory=list)
    interval: int = 1
    """Number of added items from one of `items` to the next."""
    count: int = 0
    """Number of items that were ever added."""
    last: T | None = None

    def add(self, item: T, max_count: int | None) -> None:
        """Add one item; `items` then holds at most `max_count`, or all with None. With 0 the item is only counted."""
        if max_count == 0:
            self.count += 1
            return
        if self.count % self.interval == 0:
            if max_count is not None and len(self.items) >= max_count:
                self.items = self.items[::2]
                self.interval *= 2
            if self.count % self.interval == 0:
                self.items.append(item)
        self.count += 1
        self.last = item

    def change(self, change: Callable[[T], T]) -> None:
        """Replace each item by what `change` makes of it."""
        newest = [] if self.last is None or (self.items and self.items[-1] is self.last) else [self.last]
        items = [change(item) for item in (*self.items, *newest)]
        self.items, self.last = items[: len(self.items)], items[-1] if items else None

    def __iter__(self) -> Iterator[T]:
        yield from self.items
        if self.last is not None and self.items and self.items[-1] is not self.last:
            yield self.last

    def __len__(self) -> int:
        return len(self.items)
