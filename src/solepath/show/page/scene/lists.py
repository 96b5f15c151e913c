"""Holds bounded lists that grow while watchers follow them; a watcher gets only the items that are new to it.

For this it passes how many items had been added when it got the last ones. A watcher that adds and thins like the list
has the same items. Numbers without a source were chosen by hand and not swept."""

from __future__ import annotations

from collections import deque
from math import dist
from typing import Generic, TypeVar

from attrs import define, field

from ....types import Vec3
from ..messages import rounded, rounded_all

T = TypeVar("T")

TrackPoint = tuple[float | None, ...]
"""(t, x, y, z) in s and m."""

MAX_POINTS = 2000
"""Largest number of points of a track; with one more, every second one is left out."""
MAX_BEHIND = 1000
"""Largest number of new points that a watcher can get; with more, it needs the whole list."""
MIN_SPACING = 0.02
"""Distance from the last point below which a new position adds no point to the track, m."""


@define
class ThinnedTrack(Generic[T]):
    """The points of a track from its start to now, evenly thinned.

    At one point more than MAX_POINTS, an even number, all points with odd indices are left out: first and last stay."""

    points: list[T] = field(factory=list)
    count: int = 0
    """Number of points that were ever added."""
    _recent: deque[T] = field(factory=lambda: deque(maxlen=MAX_BEHIND))

    def add(self, point: T) -> None:
        """Add one point."""
        self.points.append(point)
        if len(self.points) > MAX_POINTS:
            self.points = self.points[::2]
        self._recent.append(point)
        self.count += 1

    def since(self, number: int) -> list[T] | None:
        """Return the points that were added after the first `number`; None if some of them are not kept any more."""
        new = self.count - number
        if new == 0:
            return []
        if new > len(self._recent):
            return None
        return list(self._recent)[-new:]


@define
class WalkedTrack(ThinnedTrack[TrackPoint]):
    """The track of positions, m, with a point only where the position has changed."""

    _last: Vec3 | None = None
    """Position of the newest point, m."""

    def add_position(self, t: float, position: Vec3) -> None:
        """Add the position at `t`, s, unless it is closer than MIN_SPACING to the last point."""
        if self._last is None or dist(position, self._last) >= MIN_SPACING:
            self._last = position
            self.add((rounded(t), *rounded_all(position)))

    def replace(self, points: list[TrackPoint]) -> None:
        """Replace all points by as many others; every watcher then needs the whole list."""
        self.points = points
        self._recent.clear()
        last = [value for value in points[-1][1:] if value is not None] if points else []
        self._last = (last[0], last[1], last[2]) if len(last) == 3 else None


@define
class RecentItems(Generic[T]):
    """A list of the last `max_count` items."""

    max_count: int
    items: deque[T] = field(factory=deque)
    count: int = 0
    """Number of items that were ever added."""

    def add(self, item: T) -> None:
        """Add one item."""
        self.items.append(item)
        self.count += 1
        if len(self.items) > self.max_count:
            self.items.popleft()

    def since(self, number: int) -> list[T]:
        """Return the items that were added after the first `number` and are still in the list."""
        new = min(self.count - number, len(self.items))
        return list(self.items)[-new:] if new else []
