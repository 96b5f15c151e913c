"""Puts activities and turns into words, the same in the terminal and in the report."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ...recording import read_start_time
from ...types import Activity, Turn


def activity_words(activity: Activity) -> str:
    """Return the name of an activity in a sentence: "stairs up", "lift down"."""
    return activity.value.replace("_", " ").lower().replace("elevator", "lift")


def turn_words(turn: Turn) -> str:
    """Return the direction of a turn in a sentence: "to the left", "to the right", "about"."""
    return "about" if turn is Turn.ABOUT else f"to the {turn.value.lower()}"


def moment_text(header: Mapping[str, Any]) -> str:
    """Return the date and time at which a recording with this header started; "" if they are not known."""
    moment = read_start_time(header)
    return "" if moment is None else f"{moment[0]:%Y-%m-%d %H:%M} UTC"


def directions(counts: Mapping[bool, int]) -> list[tuple[str, int]]:
    """Return how often it went "up" (True) and "down" (False), without the direction in which it did not go."""
    return [(way, counts[up]) for up, way in ((True, "up"), (False, "down")) if counts.get(up)]
