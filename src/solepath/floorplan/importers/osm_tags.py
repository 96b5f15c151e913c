"""Interpretation of the tags of Simple Indoor Tagging for one element."""

from __future__ import annotations

import re
from math import floor

from ..checks import MAX_LEVELS
from ..plan import ConnectorKind, FloorPlanError
from .drawing import Border
from .osm_file import Element

BORDERS = {"room": Border.WALL, "corridor": Border.OPEN, "area": Border.FREE, "column": Border.SOLID,
           "wall": Border.SOLID}  # fmt: skip
"""Border for each value of indoor=* (OpenStreetMap wiki, Key:indoor).

The values mean: a room with walls, a walled walkway between rooms, an area without walls, a pillar, a wall."""

_NUMBER = r"-?\d{1,4}(?:\.\d{1,3})?"
_RANGE = re.compile(rf"\s*({_NUMBER})\s*(?:-\s*({_NUMBER})\s*)?", re.ASCII)
_LENGTH = re.compile(r"\s*(\d{1,6}(?:[.,]\d{1,6})?)\s*(m|cm)?\s*", re.ASCII)


def parse_levels(text: str) -> list[float]:
    """Return the levels in a value of `level` or `repeat_on`, each once, ascending.

    Examples: "0", "-1", "0.5", "0;1", "0-3", "-3--1", "-1;2-4". A range gives its ends and the whole numbers between
    them. Raises FloorPlanError when the text is no list of levels."""
    levels: set[float] = set()
    for part in text.split(";"):
        match = _RANGE.fullmatch(part)
        if match is None:
            raise FloorPlanError(f"{text[:40]!r} tells no levels")
        low = float(match[1])
        high = float(match[2]) if match[2] is not None else low
        low, high = min(low, high), max(low, high)
        if high - low > MAX_LEVELS:
            raise FloorPlanError(f"{text[:40]!r} tells more than {MAX_LEVELS} levels")
        levels |= {low + 0.0, high + 0.0, *(float(k) for k in range(floor(low) + 1, floor(high) + 1))}
    return sorted(levels)


def levels_of(element: Element) -> list[float]:
    """Return the levels that an element is on, by `level` and `repeat_on`."""
    levels: set[float] = set()
    for key in ("level", "repeat_on"):
        if key in element.tags:
            try:
                levels.update(parse_levels(element.tags[key]))
            except FloorPlanError as error:
                raise FloorPlanError(f"{element.name}: its {key} {error}") from None
    return sorted(levels)


def level_id(level: float) -> str:
    """Return a level as text: "0", "-1", "0.5"."""
    return f"{level:g}"


def connector_kind(element: Element) -> ConnectorKind | None:
    """Return whether the element is an elevator or stairs, None for neither; escalators are stairs."""
    tags = element.tags
    if tags.get("highway") == "elevator" or tags.get("room") == "elevator" or tags.get("elevator") == "yes":
        return ConnectorKind.LIFT
    if tags.get("highway") == "steps" or tags.get("room") == "stairs" or tags.get("stairs") == "yes":
        return ConnectorKind.STAIRS
    return None


def is_door(element: Element) -> bool:
    """Return whether the element is a door, an entrance, or a gap to walk through."""
    tags = element.tags
    return tags.get("indoor") == "door" or any(tags.get(key, "no") != "no" for key in ("door", "entrance"))


def is_indoor(element: Element) -> bool:
    """Return whether the element draws something inside a building, on known levels."""
    draws = element.tags.get("indoor") in (*BORDERS, "level") or connector_kind(element) is not None or is_door(element)
    return draws and ("level" in element.tags or "repeat_on" in element.tags)


def label_of(element: Element) -> str:
    """Return the name or number of the element, "" when it has none."""
    return element.tags.get("name") or element.tags.get("ref") or ""


def parse_length(text: str | None) -> float | None:
    """Return the length in a text ("0.9", "1.2 m", "90 cm"), m; None for any other text."""
    match = _LENGTH.fullmatch(text) if text is not None else None
    if match is None:
        return None
    value = float(match[1].replace(",", "."))
    return value / 100.0 if match[2] == "cm" else value
