"""What every event carries."""

from __future__ import annotations

from attrs import frozen


@frozen(kw_only=True)
class Happening:
    """The three times of truth of an event, which every one has."""

    t: float
    """When it happened, s."""
    known_at: float
    """When it was known, s; never earlier than `t`."""
    final: bool = True
    """False only for what a later event may revise."""
