"""The base class of all events, and their form in JSON."""

from __future__ import annotations

from enum import Enum
from math import isfinite
from typing import Any

import attrs

from ..types import Site
from ..types.attrs import field, fields, frozen

FIRST_KEYS = ("t", "known_at", "final", "foot")
"""Keys that come first in an event's JSON, in this order."""


@frozen(kw_only=True)
class BaseEvent:
    """The base class of every event."""

    t: float
    """Time at which the event happened, s."""
    known_at: float = field()
    """First time at which the event could be reported, s, by default `t`; never earlier than `t`."""
    final: bool = True
    """True if no later event revises this event."""

    @known_at.default
    def _at_once(self) -> float:
        return self.t

    def to_dict(self) -> dict[str, Any]:
        """Return the event as plain data for strict JSON, as in its line of events.jsonl.

        The first keys are `event` (name of the class), `t`, `known_at`, `final`, and `foot` if the event has a foot or
        the site of a foot. The other fields follow, in SI units. Enums are written by their values, numbers that are
        not finite as null."""
        values = json_ready(self)
        site = getattr(self, "site", None)
        if isinstance(site, Site) and site.foot is not None:
            values.setdefault("foot", site.foot.value)
        first = {key: values.pop(key) for key in FIRST_KEYS if key in values}
        return {"event": type(self).__name__, **first, **values}


def json_ready(value: Any) -> Any:
    """Return `value` in the types of strict JSON.

    A record becomes an object, an enum its value, a tuple a list, bytes a text of hexadecimal digits, and a number that
    is not finite null."""
    match value:
        case Enum():
            return json_ready(value.value)
        case float():
            return value if isfinite(value) else None
        case bytes():
            return value.hex()
        case tuple() | list():
            return [json_ready(item) for item in value]
        case dict():
            return {str(json_ready(key)): json_ready(item) for key, item in value.items()}
        case _ if attrs.has(type(value)):
            return {one.name: json_ready(getattr(value, one.name)) for one in fields(type(value))}
        case _:
            return value
