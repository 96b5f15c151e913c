"""What the wearer does now, and since when."""

from __future__ import annotations

from collections import deque
from typing import Any

from attrs import define, field

from ....events import ActivityChanged
from ....types import Activity
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

    @property
    def last(self) -> tuple[float, Activity]:
        """Since when, s, and what."""
        return self.changes[-1] if self.changes else (0.0, Activity.UNKNOWN)

    def frame(self, unheard_since: float | None) -> dict[str, Any]:
        """As "activity" of a frame. `unheard_since`: when a foot was heard last, s, while none is; then what the wearer
        does is not known."""
        t, activity = self.last
        if unheard_since is None:
            return {"now": activity.value, "since": shown(t), "last": None}
        last = None if activity is Activity.UNKNOWN else activity.value
        return {"now": Activity.UNKNOWN.value, "since": shown(unheard_since), "last": last}
