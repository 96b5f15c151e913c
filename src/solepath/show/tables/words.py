"""Puts activities and turns into words, the same in the terminal and in the report."""

from __future__ import annotations

from ...types import Activity, Turn


def activity_words(activity: Activity) -> str:
    """Return the name of an activity in a sentence: "stairs up", "lift down"."""
    return activity.value.replace("_", " ").lower().replace("elevator", "lift")


def turn_words(turn: Turn) -> str:
    """Return the direction of a turn in a sentence: "to the left", "to the right", "about"."""
    return "about" if turn is Turn.ABOUT else f"to the {turn.value.lower()}"
