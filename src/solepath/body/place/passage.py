"""Being on stairs or in a lift: how long, how high and which way, as far as is known."""

from __future__ import annotations

from math import hypot

from ...floorplan.plan import ConnectorKind
from ...types import Vec3
from ...types.attrs import define

RISE = 0.165
"""Of one step of a stair, m, where neither track nor plan tells a height."""
STEEP, LANDING = 2.5, 4.0
"""Stairs lead no further away than so many times their height, and so many m of landings."""


@define
class Passage:
    """Being on stairs or in a lift, as far as is known."""

    kind: ConnectorKind
    t: float
    begin: Vec3
    """Of the track, m."""
    up: int = 0
    """Strides (of stairs) or tellings (of lifts) that lead up, less those that lead down."""
    left: int = 0
    right: int = 0
    """Strides of each foot."""
    climbed: float = 0.0
    """Sum of the heights of flights, m."""
    t_left: float | None = None
    end: Vec3 | None = None
    since: int = 0
    """Strides since."""

    def height(self, here: Vec3) -> float | None:
        """By the track where that says anything, else by flights or by counting steps, m, not negative."""
        track = self._track(here)
        if self.kind is ConnectorKind.LIFT:
            return track if track > 1.0 else None
        return track if self.measured(here) else max(abs(self.climbed), self._counted)

    def measured(self, here: Vec3) -> bool:
        """Whether the track has a height."""
        track = self._track(here)
        return track > 0.5 * self._counted and track > 0.3

    def _track(self, here: Vec3) -> float:
        return abs((here if self.end is None else self.end)[2] - self.begin[2])

    @property
    def _counted(self) -> float:
        # a stride of a foot is two steps of the stair; of both feet each one is told by its own stride
        # those that were told to lead the other way may have led this way, or may not have been on stairs: half of them
        strides = 0.5 * (self.left + self.right + abs(self.up))
        return RISE * strides * (1.0 if self.left and self.right else 2.0)

    @property
    def told_both_ways(self) -> float:
        """The height, m, when all strides led the same way, whatever they were told to do."""
        return RISE * (self.left + self.right) * (1.0 if self.left and self.right else 2.0)

    @property
    def doubt(self) -> float:
        """Share of the strides that lead the other way than most."""
        strides = self.left + self.right
        return (
            0.5 * (1.0 - abs(self.up) / strides)
            if self.kind is ConnectorKind.STAIRS and strides > abs(self.up)
            else 0.0
        )

    def leads_away(self, here: Vec3) -> bool:
        """Further than stairs of that height do."""
        if self.kind is ConnectorKind.LIFT:
            return False
        end = here if self.end is None else self.end
        away = hypot(end[0] - self.begin[0], end[1] - self.begin[1])
        return away > STEEP * (self.height(end) or 0.0) + LANDING
