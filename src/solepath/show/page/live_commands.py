"""Commands that a page may send while it shows a live session: a person reports where the wearer is."""

from __future__ import annotations

from ...floorplan.plan import FloorPlan
from ...wire.receiver import PositionFrame
from .messages import Command, CommandError


def position_of(command: Command, plan: FloorPlan | None) -> PositionFrame:
    """Return the position that a command reports to a live session on `plan`.

    CommandError is raised for any other command, and for a level that the plan does not have."""
    position = command.position
    if position is None:
        raise CommandError(f"a browser requested to {command.do}, and there is nothing to play")
    if position.level and (plan is None or all([level.id != position.level for level in plan.levels])):
        raise CommandError("a browser reported a position on a level that is not there")
    return position
