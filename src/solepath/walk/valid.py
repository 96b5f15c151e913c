"""Checks that every number of an event is finite: only such events are counted and drawn."""

from __future__ import annotations

from math import isfinite
from typing import Any

import attrs

from ..events import Event, FootMoved, FootPressed, GaitCycleMeasured

MAX_MAGNITUDE = 1e12
"""Magnitude from which a number of an event counts as not finite, in its SI unit; chosen by hand."""
MIN_STRIDE_TIME = 1e-3
"""Shortest stride time that is accepted, s; chosen by hand."""


def has_valid_numbers(event: Event) -> bool:
    """Return whether every number in an event is finite; the events of each sample have a fast path."""
    match event:
        case FootMoved(t=t, known_at=known_at, position=(x, y, z)):
            return abs(t) + abs(known_at) + abs(x) + abs(y) + abs(z) < MAX_MAGNITUDE
        case FootPressed(t=t, known_at=known_at, force=force, values=values):
            x, y = event.centre or (0.0, 0.0)
            return abs(t) + abs(known_at) + abs(force) + abs(x) + abs(y) < MAX_MAGNITUDE and isfinite(sum(values))
        case GaitCycleMeasured(stride_time=stride_time):
            return is_valid(event) and stride_time >= MIN_STRIDE_TIME
        case _:
            return is_valid(event)


def is_valid(value: Any) -> bool:
    """Return whether every number in a record is finite and smaller than MAX_MAGNITUDE."""
    if isinstance(value, float):
        return isfinite(value) and abs(value) < MAX_MAGNITUDE
    if isinstance(value, tuple):
        return all(map(is_valid, value))
    if attrs.has(type(value)):
        return all([is_valid(getattr(value, one.name)) for one in attrs.fields(type(value))])
    return True
