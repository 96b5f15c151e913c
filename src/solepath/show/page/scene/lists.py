"""Lists that grow while somebody reads along: bounded, and numbered, so that a reader asks for what is new to it.

How many items were ever added is a reader's number. A reader that adds what is new by the same rule has the same list.
"""

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

MOST_POINTS = 2000
"""Of a track; one more, and every second is left out."""
RECENT = 1000
"""Points that a reader may be behind."""
SPACING = 0.02
"""m; who stands nearer to where they stood adds no point to their track."""


@define
class ThinnedTrack(Generic[T]):
    """Points of a track from its beginning to now. When there is one more than MOST_POINTS, those at odd places (from
    0) are left out: the older part thins out evenly, and its first and newest point stay."""

    points: list[T] = field(factory=list)
    count: int = 0
    """Points that were ever added."""
    _recent: deque[T] = field(factory=lambda: deque(maxlen=RECENT))

    def add(self, point: T) -> None:
        """One more."""
        self.points.append(point)
        if len(self.points) > MOST_POINTS:
            self.points = self.points[::2]
        self._recent.append(point)
        self.count += 1

    def since(self, number: int) -> list[T] | None:
        """The points after the first `number` ever; None when not all of them are known any more."""
        new = self.count - number
        if new == 0:
            return []
        if new > len(self._recent):
            return None
        return list(self._recent)[-new:]


@define
class WalkedTrack(ThinnedTrack[TrackPoint]):
    """Where somebody stood, from one place to another."""

    _last: Vec3 | None = None
    """The newest point, m."""

    def add_position(self, t: float, position: Vec3) -> None:
        """At `t` s at this place."""
        if self._last is None or dist(position, self._last) >= SPACING:
            self._last = position
            self.add((rounded(t), *rounded_all(position)))


@define
class Recent(Generic[T]):
    """The last `most` items."""

    most: int
    items: deque[T] = field(factory=deque)
    count: int = 0
    """Items that were ever added."""

    def add(self, item: T) -> None:
        """One more."""
        self.items.append(item)
        self.count += 1
        if len(self.items) > self.most:
            self.items.popleft()

    def since(self, number: int) -> list[T]:
        """The items after the first `number` ever, as far as they are here."""
        new = min(self.count - number, len(self.items))
        return list(self.items)[-new:] if new else []
