"""Thins the live positions of the feet for a small picture of the track."""

from __future__ import annotations

from math import hypot

from attrs import define, field

from ..types import Foot

FIRST_SPACING = 0.15
"""Distance between two points of a foot at first, m, chosen by hand; it doubles whenever there are MAX_POINTS."""
MAX_POINTS = 2000
"""Largest number of points of both feet, chosen by hand."""


@define
class LiveTrack:
    """The points of both feet from the start to now, evenly thinned."""

    points: list[tuple[Foot, float, float]] = field(factory=list)
    """Foot, x and y of each point in the world frame, m."""
    _spacing: float = FIRST_SPACING
    _last: dict[Foot, tuple[float, float]] = field(factory=dict)

    def add(self, foot: Foot, x: float, y: float) -> None:
        """Add the position (x, y) of a foot, m, when it is far enough from the last point."""
        last = self._last.get(foot)
        if last is None or hypot(x - last[0], y - last[1]) > self._spacing:
            if len(self.points) >= MAX_POINTS:
                self._thin()
            self._last[foot] = (x, y)
            self.points.append((foot, x, y))

    def _thin(self) -> None:
        """Leave out every second point of each foot."""
        self._spacing *= 2.0
        counts = dict.fromkeys(Foot, 0)
        remaining = []
        for point in self.points:
            if counts[point[0]] % 2 == 0:
                remaining.append(point)
            counts[point[0]] += 1
        self.points = remaining
