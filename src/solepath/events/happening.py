"""What every event carries, and events as JSON knows them."""

from __future__ import annotations

from enum import Enum
from math import isfinite
from typing import Any

import attrs

from ..types import Site
from ..types.attrs import fields, frozen

FIRST_KEYS = ("t", "known_at", "final", "foot")


@frozen(kw_only=True)
class Happening:
    """The three times of truth of an event, which every one has."""

    t: float
    """When it happened, s."""
    known_at: float
    """When it was known, s; never earlier than `t`."""
    final: bool = True
    """False only for what a later event may revise."""

    def to_dict(self) -> dict[str, Any]:
        """The event as plain data for strict JSON, the same as its line of events.jsonl: `event` (the class's name),
        `t`, `known_at`, `final`, `foot` where it has one (also where an event of a link has a foot's site), then its
        other fields in SI units; enums by their values, null for a number that is none."""
        values = json_ready(self)
        site = getattr(self, "site", None)
        if isinstance(site, Site) and site.foot is not None:
            values.setdefault("foot", site.foot.value)
        first = {key: values.pop(key) for key in FIRST_KEYS if key in values}
        return {"event": type(self).__name__, **first, **values}


def json_ready(value: Any) -> Any:
    """`value` as strict JSON knows it: records as objects, enums by what they are called, tuples as lists, bytes as
    hex, and null for a number that is none."""
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
