"""The report of a person of where the wearer is, as the event of a packet; loaded with the first report."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ..events import PositionReported
from ..link.receiver import reported_position
from ..types import SITE_OF_FOOT, Foot, Site, Vec2
from ..types.plain import text
from ..wire.receiver import PositionFrame, build_position, parse_position
from .state import SessionState

if TYPE_CHECKING:
    from ..floorplan.index import IndexedPlan


def report_position(
    state: SessionState, plan: IndexedPlan | None, where: Vec2 | str | None, sigma: float, level: str
) -> tuple[PositionReported, Site]:
    """Return the event of a reported position, and the site that has it; `Session.here` has the arguments.

    Raises ValueError for a place without a name, and for a level that the plan does not have."""
    if isinstance(where, str) and not where:
        raise ValueError("a place needs a name")
    if state.now is None or state.finished:
        raise ValueError("the session is finished" if state.finished else "nobody is anywhere before the first sample")
    if text(level):
        if plan is None:
            raise ValueError("a level without a floor plan")
        # what is not there raises FloorPlanError, a ValueError
        where = plan.plan.landmark(where, level) if isinstance(where, str) else where
        plan.plan.level(level)
    position, place = (None, where or "") if where is None or isinstance(where, str) else (_pair(where), "")
    # the values that a packet would have, so that a replay of one is exact
    frame = parse_position(build_position(PositionFrame(position, sigma, place, text(level))))
    site = SITE_OF_FOOT[next(iter(state.feet), Foot.LEFT)]
    return reported_position(frame, state.now, site), site


def _pair(where: Any) -> Vec2:
    """Return x and y of a position as floats; raises TypeError for anything else than two numbers."""
    try:
        x, y = where
        return float(x), float(y)
    except (TypeError, ValueError) as error:
        raise TypeError(f"a position is x and y, m, not {where!r:.80}") from error
