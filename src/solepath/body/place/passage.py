"""Passage over stairs or by lift: its duration, height and direction, as far as they are known."""

from __future__ import annotations

from math import hypot

from ...floorplan.plan import ConnectorKind
from ...types import Vec3
from ...types.attrs import define

RISER = 0.165
"""Height of one step of a stair, m, where neither track nor plan gives a height."""
LARGEST_RUN, LANDINGS_LENGTH = 2.5, 4.0
"""Longest way over stairs as a multiple of their height, and length of landings that adds to it, m."""


@define
class Passage:
    """A passage over stairs or by lift."""

    kind: ConnectorKind
    t: float
    """Start of the passage, s."""
    start: Vec3
    """Place on the track at the start, m."""
    up: int = 0
    """Number of strides (stairs) or reports (lifts) upwards minus those downwards."""
    left: int = 0
    """Number of strides of the left foot."""
    right: int = 0
    """Number of strides of the right foot."""
    flight_height: float = 0.0
    """Sum of the heights of flights, m."""
    t_left: float | None = None
    """Time at which the wearer left the stairs or the lift, s; None before."""
    end: Vec3 | None = None
    """Place on the track at that time, m."""
    strides_since: int = 0
    """Number of strides since then."""

    def height(self, here: Vec3) -> float | None:
        """Return the height, m, not negative: by the track if it has one, else by flights or by counted steps."""
        track = self._track(here)
        if self.kind is ConnectorKind.LIFT:
            return track if track > 1.0 else None
        return track if self.measured(here) else max(abs(self.flight_height), self._counted)

    def measured(self, here: Vec3) -> bool:
        """Return whether the track has a height."""
        track = self._track(here)
        return track > 0.5 * self._counted and track > 0.3

    def _track(self, here: Vec3) -> float:
        return abs((here if self.end is None else self.end)[2] - self.start[2])

    @property
    def _counted(self) -> float:
        # a stride of a foot is two steps of the stair; with both feet each step has its own stride
        # strides reported in the other direction may have led this way, or may not have been on stairs: half of them
        strides = 0.5 * (self.left + self.right + abs(self.up))
        return RISER * strides * (1.0 if self.left and self.right else 2.0)

    @property
    def height_one_way(self) -> float:
        """Height, m, when all strides led the same way, whatever direction was reported."""
        return RISER * (self.left + self.right) * (1.0 if self.left and self.right else 2.0)

    @property
    def opposite_share(self) -> float:
        """Share of the strides that were reported in the other direction than most."""
        strides = self.left + self.right
        return (
            0.5 * (1.0 - abs(self.up) / strides)
            if self.kind is ConnectorKind.STAIRS and strides > abs(self.up)
            else 0.0
        )

    def leads_away(self, here: Vec3) -> bool:
        """Return whether the passage led further away than stairs of its height do."""
        if self.kind is ConnectorKind.LIFT:
            return False
        end = here if self.end is None else self.end
        away = hypot(end[0] - self.start[0], end[1] - self.start[1])
        return away > LARGEST_RUN * (self.height(end) or 0.0) + LANDINGS_LENGTH
