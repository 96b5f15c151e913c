"""Lists that grow while somebody reads along: bounded, and numbered, so that a reader asks for what is new to it.

The number of a reader is how many items had been added when it read last. A reader that adds the new items by the same
rule has the same list."""

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
RECENT = 1000
"""Number of points that a reader may be behind."""
SPACING = 0.02
"""Distance from the last point below which a new position adds no point to the track, m."""


@define
class ThinnedTrack(Generic[T]):
    """Points of a track from its start to now, thinned evenly.

    When there is one more than MAX_POINTS, the points with odd indices (from 0) are left out. The first and the newest
    point stay."""

    points: list[T] = field(factory=list)
    count: int = 0
    """Number of points that were ever added."""
    _recent: deque[T] = field(factory=lambda: deque(maxlen=RECENT))

    def add(self, point: T) -> None:
        """Add one point."""
        self.points.append(point)
        if len(self.points) > MAX_POINTS:
            self.points = self.points[::2]
        self._recent.append(point)
        self.count += 1

    def since(self, number: int) -> list[T] | None:
        """Return the points after the first `number` ever; None when not all of them are known any more."""
        new = self.count - number
        if new == 0:
            return []
        if new > len(self._recent):
            return None
        return list(self._recent)[-new:]


@define
class WalkedTrack(ThinnedTrack[TrackPoint]):
    """Track of positions, with a point only where the position has changed."""

    _last: Vec3 | None = None
    """Position of the newest point, m."""

    def add_position(self, t: float, position: Vec3) -> None:
        """Add the position at `t` s when it is far enough from the last point."""
        if self._last is None or dist(position, self._last) >= SPACING:
            self._last = position
            self.add((rounded(t), *rounded_all(position)))


@define
class Recent(Generic[T]):
    """The last `most` items."""

    most: int
    items: deque[T] = field(factory=deque)
    count: int = 0
    """Number of items that were ever added."""

    def add(self, item: T) -> None:
        """Add one item."""
        self.items.append(item)
        self.count += 1
        if len(self.items) > self.most:
            self.items.popleft()

    def since(self, number: int) -> list[T]:
        """Return the items after the first `number` ever, as far as they are still kept."""
        new = min(self.count - number, len(self.items))
        return list(self.items)[-new:] if new else []
