"""Checks that every number of an event is finite: only such events are counted and drawn."""

from __future__ import annotations

from math import isfinite
from typing import Any

import attrs

from ..events import Event, FootMoved, FootPressed, GaitCycleMeasured

LARGEST = 1e12
"""Limit of every number of an event, in whatever unit; a larger one counts as no number."""
SHORTEST_STRIDE = 1e-3
"""Shortest stride time that is accepted, s."""


def has_valid_numbers(event: Event) -> bool:
    """Return whether every number in an event is finite; quickly for the events of every sample."""
    match event:
        case FootMoved(t=t, known_at=known_at, position=(x, y, z)):
            return abs(t) + abs(known_at) + abs(x) + abs(y) + abs(z) < LARGEST
        case FootPressed(values=values):
            return is_valid((event.t, event.known_at, event.force, event.centre)) and isfinite(sum(values))
        case GaitCycleMeasured(stride_time=stride_time):
            return is_valid(event) and stride_time >= SHORTEST_STRIDE
        case _:
            return is_valid(event)


def is_valid(value: Any) -> bool:
    """Return whether every number in a record is finite and smaller than LARGEST."""
    if isinstance(value, float):
        return isfinite(value) and abs(value) < LARGEST
    if isinstance(value, tuple):
        return all(map(is_valid, value))
    if attrs.has(type(value)):
        return all([is_valid(getattr(value, one.name)) for one in attrs.fields(type(value))])
    return True
