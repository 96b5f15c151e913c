"""What a session asks of whoever follows the wearer on a floor plan."""

from __future__ import annotations

from typing import Protocol

from ...events import Event, Placed
from ...floorplan.index import IndexedPlan
from ...floorplan.plan import Start
from ..position import Position


class PlacePart(Protocol):
    """The track and what the wearer does in, the place on the plan out. A plain record, as every machine is."""

    def set_out(self, start: Start) -> None:
        """The wearer sets out there. To be told before the first `follow`. ValueError for what is no number."""

    def follow(self, plan: IndexedPlan, events: list[Event], here: Position) -> list[Event]:
        """`events`: what has just become known, of steps and of what the wearer does; `here`: where the track leads
        now, world frame. Always with the same plan. Returns Placed or PlaceLost, or nothing."""

    @property
    def place(self) -> Placed | None:
        """Where the wearer is on the plan; None while it is of no use."""
