"""Holds bounded lists that grow while pages follow them; a page gets only the items that are new to it.

For this it passes how many items had been added when it got the last ones. A page that adds and leaves out like the
list has the same items. Numbers without a source were chosen by hand and not swept."""

from __future__ import annotations

from collections.abc import Sequence
from math import dist
from typing import Generic, TypeVar

from attrs import define, field

from ....types import Vec3

T = TypeVar("T")

TrackPoint = tuple[float, ...]
"""(t, x, y, z) in s and m."""

MAX_POINTS = 2000
"""Largest number of points of a track."""
MIN_SPACING = 0.02
"""Distance from the last point below which a new position adds no point to the track, m."""


@define
class GrowingList(Generic[T]):
    """A list of at most `limit` items, an even number.

    With one more, the oldest item is left out or, if the list `thins`, all with odd indices: first and last stay."""

    limit: int = MAX_POINTS
    thins: bool = False
    items: list[T] = field(factory=list)
    count: int = 0
    """Number of changes: of items that were ever added, and of replacements of all items."""
    _known_from: int = 0
    """Count of changes below which a page needs the whole list: items of its own are not in the list any more."""

    def add(self, item: T) -> None:
        """Add one item."""
        self.items.append(item)
        self.count += 1
        if len(self.items) > self.limit:
            if self.thins:
                self._known_from = self.count - 1  # who has all but this item thins as well
            self.items = self.items[::2] if self.thins else self.items[1:]

    def replace(self, items: Sequence[T]) -> None:
        """Replace all items; every page then needs the whole list."""
        self.items = [*items]
        self.count += 1
        self._known_from = self.count

    def since(self, count: int) -> list[T] | None:
        """Return the items that came after so many changes and are still there; None if the whole list is needed."""
        if count < self._known_from:
            return None
        return self.items[-(self.count - count) :] if count < self.count else []


def new_track() -> GrowingList[TrackPoint]:
    """Return a track without any point."""
    return GrowingList(thins=True)


def add_position(track: GrowingList[TrackPoint], t: float, position: Vec3) -> None:
    """Add the position at `t`, s, to a track, m, unless it is closer than MIN_SPACING to the last point."""
    if not track.items or dist(position, track.items[-1][1:]) >= MIN_SPACING:
        track.add(tuple([round(value, 3) for value in (t, *position)]))
