"""What an app hands to a session, checked where it comes in."""

from __future__ import annotations

from copy import deepcopy
from math import inf
from typing import TYPE_CHECKING

from ..calibration import Calibration, CalibrationError

if TYPE_CHECKING:
    from ..floorplan.index import IndexedPlan
    from ..floorplan.plan import FloorPlan, Start


def sound(calibration: Calibration) -> Calibration:
    """A copy of the calibration. TypeError for what is none, CalibrationError for one of what cannot be."""
    from ..calibration.limits import unusable

    if not isinstance(calibration, Calibration):
        raise TypeError(f"calibration must be a Calibration, not {type(calibration).__name__}")
    why_not = unusable(calibration)
    if why_not is not None:
        raise CalibrationError(f"calibration: {why_not}")
    return deepcopy(calibration)


def indexed(floorplan: FloorPlan | IndexedPlan | None) -> IndexedPlan | None:
    """The floor plan made ready. TypeError for what is none."""
    if floorplan is None:
        return None
    from ..floorplan.index import IndexedPlan
    from ..floorplan.plan import FloorPlan

    if isinstance(floorplan, IndexedPlan):
        return floorplan
    if not isinstance(floorplan, FloorPlan):
        raise TypeError(f"floorplan must be a FloorPlan, not {type(floorplan).__name__}")
    return IndexedPlan(floorplan)


def beginning(start: Start, plan: IndexedPlan | None) -> Start:
    """A copy of the start. TypeError for what is none or has no floor plan, FloorPlanError for what cannot be."""
    from ..floorplan import plan as plans
    from ..floorplan.records import no_start

    if not isinstance(start, plans.Start) or plan is None:
        raise TypeError("start must be a Start, on a floor plan")
    why_not = no_start(start)
    if why_not is not None:
        raise plans.FloorPlanError(f"start: {why_not}")
    return deepcopy(start)


def as_float(value: float) -> float:
    """An int may be too large for a float; then it is as good as infinite."""
    try:
        return float(value)
    except OverflowError:
        return inf
