"""What every event carries."""

from __future__ import annotations

from typing import Any

from attrs import frozen

from .record import record_of


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
        `t`, `known_at`, `final`, `foot` where it has one, then its other fields in SI units; enums by their values,
        null for a number that is none."""
        return record_of(self)
