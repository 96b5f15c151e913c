"""Where the feet went by their live positions, for a small picture of it."""

from __future__ import annotations

from math import hypot

from attrs import define, field

from ..types import Foot

SPACING = 0.15
"""m between the points of a foot, at first: twice as far whenever there are MOST_POINTS."""
MOST_POINTS = 2000


@define
class LiveTrack:
    """Points of both feet, thinned alike from beginning to end."""

    points: list[tuple[Foot, float, float]] = field(factory=list)
    """Foot, x, y in the world frame, m."""
    _spacing: float = SPACING
    _last: dict[Foot, tuple[float, float]] = field(factory=dict)

    def add(self, foot: Foot, x: float, y: float) -> None:
        """The foot is at (x, y) m."""
        last = self._last.get(foot)
        if last is None or hypot(x - last[0], y - last[1]) > self._spacing:
            if len(self.points) >= MOST_POINTS:
                self._thin()
            self._last[foot] = (x, y)
            self.points.append((foot, x, y))

    def _thin(self) -> None:
        """Leave out every second point of each foot."""
        self._spacing *= 2.0
        counts = dict.fromkeys(Foot, 0)
        kept = []
        for point in self.points:
            if counts[point[0]] % 2 == 0:
                kept.append(point)
            counts[point[0]] += 1
        self.points = kept
