"""What the wearer does now, and since when."""

from __future__ import annotations

from collections import deque
from typing import Any

from attrs import define, field

from ..events import ActivityChanged
from ..types import Activity
from .rounding import shown

MOST = 100
"""Changes that are kept: a later one revises the newest few."""


@define
class Doings:
    """Activities as they were told, less those that were replaced."""

    changes: deque[tuple[float, Activity]] = field(factory=lambda: deque(maxlen=MOST))

    def take(self, event: ActivityChanged) -> None:
        """The next change, in the order in which they are told."""
        from_then = event.t if event.revises is None else min(event.t, event.revises)
        while self.changes and self.changes[-1][0] >= from_then:
            self.changes.pop()
        if not self.changes or self.changes[-1][1] is not event.activity:
            self.changes.append((event.t, event.activity))

    def frame(self) -> dict[str, Any]:
        """As "activity" of a frame."""
        if not self.changes:
            return {"now": Activity.UNKNOWN.value, "since": 0.0}
        t, activity = self.changes[-1]
        return {"now": activity.value, "since": shown(t)}
