"""Checks of the arguments that an app passes to a session."""

from __future__ import annotations

from collections.abc import Mapping
from math import isfinite
from typing import TYPE_CHECKING, TypeVar

from ..calibration import Calibration, CalibrationError
from ..events import Event
from ..types import Site
from ..types.plain import number, plain_copy

if TYPE_CHECKING:
    from ..floorplan.index import IndexedPlan
    from ..floorplan.plan import FloorPlan, Start

_Record = TypeVar("_Record")


class ItemError(TypeError):
    """Error of one of the items of `Session.feed`, with the events before it.

    The item is neither packet nor sample, or has values of wrong types; the iterator failed; or a reader or part of the
    app raised. The error itself is `reason`, and `number` is the place of its item among those that were given, from 0.
    `events` are those of the items before it, which were used, and what the feet found in it before the app's part
    raised. The items after it were not used."""

    def __init__(self, number: int, reason: Exception, events: list[Event]) -> None:
        super().__init__(f"item {number}: {reason}")
        self.number, self.reason, self.events = number, reason, events


def keep_events(events: list[Event], error: Exception, number: int = 0) -> ItemError:
    """Return the error of an item with the events before it; those that it has come after them."""
    if isinstance(error, ItemError):
        return ItemError(number, error.reason, events + error.events)
    return ItemError(number, error, events)


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


def check_devices(devices: Mapping[Site, str] | None) -> Mapping[Site, str]:
    """Return the addresses of devices by site, none for None; raise TypeError for another type."""
    if devices is not None and not isinstance(devices, Mapping):
        raise TypeError(f"devices is a dict of a Site and the address of its device, not {type(devices).__name__}")
    return devices or {}


def check_now(now: float) -> float:
    """Return the time `now` as a float; raise TypeError for what is no number, ValueError for NaN and infinity."""
    time = number("now", now)
    if not isfinite(time):
        raise ValueError(f"now is {time}")
    return time
