"""Interpretation of the tags of Simple Indoor Tagging for one element."""

from __future__ import annotations

import re
from math import floor

from ..checks import MOST_LEVELS
from ..plan import ConnectorKind, FloorPlanError
from .drawing import Border
from .osm_file import Element

BORDERS = {"room": Border.WALL, "corridor": Border.OPEN, "area": Border.FREE, "column": Border.SOLID,
           "wall": Border.SOLID}  # fmt: skip
"""Border by the value of indoor=* (Key:indoor).

A conventional room with walls, a walled walkway between rooms, an area without walls, a pillar, a wall."""

_NUMBER = r"-?\d{1,4}(?:\.\d{1,3})?"
_RANGE = re.compile(rf"\s*({_NUMBER})\s*(?:-\s*({_NUMBER})\s*)?", re.ASCII)
_LENGTH = re.compile(r"\s*(\d{1,6}(?:[.,]\d{1,6})?)\s*(m|cm)?\s*", re.ASCII)


def parse_levels(text: str) -> list[float]:
    """Return the levels in a value of `level` or `repeat_on`, each once, ascending.

    Examples: "0", "-1", "0.5", "0;1", "0-3", "-3--1", "-1;2-4"; of a range its ends and the whole numbers between.
    Raises FloorPlanError when it has none."""
    found: set[float] = set()
    for one in text.split(";"):
        match = _RANGE.fullmatch(one)
        if match is None:
            raise FloorPlanError(f"{text[:40]!r} tells no levels")
        low = float(match[1])
        high = float(match[2]) if match[2] is not None else low
        low, high = min(low, high), max(low, high)
        if high - low > MOST_LEVELS:
            raise FloorPlanError(f"{text[:40]!r} tells more than {MOST_LEVELS} levels")
        found |= {low + 0.0, high + 0.0, *(float(k) for k in range(floor(low) + 1, floor(high) + 1))}
    return sorted(found)


def levels(one: Element) -> list[float]:
    """Return the levels that an element is on, by `level` and `repeat_on`."""
    found: set[float] = set()
    for key in ("level", "repeat_on"):
        if key in one.tags:
            try:
                found.update(parse_levels(one.tags[key]))
            except FloorPlanError as error:
                raise FloorPlanError(f"{one.name}: its {key} {error}") from None
    return sorted(found)


def level_id(level: float) -> str:
    """Return a level as text: "0", "-1", "0.5"."""
    return f"{level:g}"


def connector_kind(one: Element) -> ConnectorKind | None:
    """Return whether the element is a lift or stairs, None for neither; escalators are stairs."""
    tags = one.tags
    if tags.get("highway") == "elevator" or tags.get("room") == "elevator" or tags.get("elevator") == "yes":
        return ConnectorKind.LIFT
    if tags.get("highway") == "steps" or tags.get("room") == "stairs" or tags.get("stairs") == "yes":
        return ConnectorKind.STAIRS
    return None


def is_door(one: Element) -> bool:
    """Return whether it is a door, an entrance, or a gap to walk through."""
    tags = one.tags
    return tags.get("indoor") == "door" or any(tags.get(key, "no") != "no" for key in ("door", "entrance"))


def is_indoor(one: Element) -> bool:
    """Return whether it draws something inside a building."""
    known = one.tags.get("indoor") in (*BORDERS, "level") or connector_kind(one) is not None or is_door(one)
    return known and ("level" in one.tags or "repeat_on" in one.tags)


def label(one: Element) -> str:
    """Return its name or number, "" when it has none."""
    return one.tags.get("name") or one.tags.get("ref") or ""


def parse_length(text: str | None) -> float | None:
    """Return a length in m ("0.9", "1.2 m", "90 cm"); None when the text is none."""
    match = _LENGTH.fullmatch(text) if text is not None else None
    if match is None:
        return None
    value = float(match[1].replace(",", "."))
    return value / 100.0 if match[2] == "cm" else value
