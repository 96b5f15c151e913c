"""Events as JSON knows them: what `event.to_dict()` gives, and a line of events.jsonl holds."""

from __future__ import annotations

from enum import Enum
from math import isfinite
from typing import Any

import attrs

from ..types import Site

FIRST_KEYS = ("t", "known_at", "final", "foot")


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
            return {a.name: json_ready(getattr(value, a.name)) for a in attrs.fields(type(value))}
        case _:
            return value


def record_of(event: object) -> dict[str, Any]:
    """An event as a JSON object: its class's name, its times, its foot where it has one, then its other fields. An
    event of a link has a site; where that is a foot, the foot is there too."""
    fields = json_ready(event)
    site = getattr(event, "site", None)
    if isinstance(site, Site) and site.foot is not None:
        fields.setdefault("foot", site.foot.value)
    first = {key: fields.pop(key) for key in FIRST_KEYS if key in fields}
    return {"event": type(event).__name__, **first, **fields}
