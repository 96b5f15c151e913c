"""Checks of the arguments that an app passes to a session."""

from __future__ import annotations

from math import isfinite
from typing import TYPE_CHECKING, TypeVar

from ..calibration import Calibration, CalibrationError
from ..events import Event
from ..types.plain import number, plain_copy

if TYPE_CHECKING:
    from ..floorplan.index import IndexedPlan
    from ..floorplan.plan import FloorPlan, Start

_Record = TypeVar("_Record")


class ItemError(TypeError):
    """Error of one of several items of `Session.feed`: it is neither packet nor sample, or has values of wrong types.

    `number` is its place among them, from 0, and `events` are those of the items before it, which were used. The items
    after it were not."""

    def __init__(self, number: int, reason: TypeError, events: list[Event]) -> None:
        super().__init__(f"item {number}: {reason}")
        self.number, self.events = number, events


def check_calibration(calibration: Calibration) -> Calibration:
    """Return a copy of the calibration.

    Raises TypeError for another type, CalibrationError for impossible values."""
    if not isinstance(calibration, Calibration):
        raise TypeError(f"calibration must be a Calibration, not {type(calibration).__name__}")
    return _checked(calibration, Calibration, CalibrationError)


def index_floorplan(floorplan: FloorPlan | IndexedPlan | None) -> IndexedPlan | None:
    """Return the indexed floor plan; raise TypeError for another type."""
    if floorplan is None:
        return None
    from ..floorplan.index import IndexedPlan
    from ..floorplan.plan import FloorPlan

    if isinstance(floorplan, IndexedPlan):
        return floorplan
    if not isinstance(floorplan, FloorPlan):
        raise TypeError(f"floorplan must be a FloorPlan (read_floorplan), not {type(floorplan).__name__}")
    return IndexedPlan(floorplan)


def check_start(start: Start, plan: IndexedPlan | None) -> Start:
    """Return a copy of the start.

    Raises TypeError for another type or without a floor plan, FloorPlanError for impossible values."""
    from ..floorplan import plan as plans

    if not isinstance(start, plans.Start) or plan is None:
        raise TypeError("start must be a Start, on a floor plan")
    return _checked(start, plans.Start, plans.FloorPlanError)


def _checked(record: _Record, cls: type[_Record], error: type[Exception]) -> _Record:
    """Return a copy of the record with plain numbers; raise `error` for impossible values."""
    from ..types.checking import find_fault  # a session without a calibration and a start needs no check

    own_record = plain_copy(record)
    fault = find_fault(own_record, cls)
    if fault is not None:
        raise error(f"{cls.__name__.lower()}: {fault}")
    return own_record


def check_now(now: float) -> float:
    """Return the time `now` as a float; raise TypeError for what is no number, ValueError for NaN and infinity."""
    time = number("now", now)
    if not isfinite(time):
        raise ValueError(f"now is {time}")
    return time
