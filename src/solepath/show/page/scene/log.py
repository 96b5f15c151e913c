"""The lines of the log that a page shows."""

from __future__ import annotations

from attrs import define, field

from ....events import BatteryLevel, Event, FootSilent
from ....types import SITE_OF_FOOT
from ...observer import Observer
from .lists import Recent
from .rounding import shown
from .sentences import LOW, sentence

MOST_LINES = 50

LogLine = tuple[float | None, str, str]
"""(t, kind, sentence)."""


@define
class SceneLog:
    """The newest sentences of what happened."""

    lines: Recent[LogLine] = field(factory=lambda: Recent(MOST_LINES))

    def tell(self, event: Event, before: Observer) -> None:
        """A line of an event that is worth one and was not said just now. `before`: what was observed before it."""
        told = sentence(event)
        if told is None:
            return
        if isinstance(event, FootSilent) and before.link(SITE_OF_FOOT[event.foot]).state(before.now) != "ok":
            return
        if isinstance(event, BatteryLevel):
            level = before.link(event.site).battery
            if level is not None and level <= LOW:
                return
        self.add(event.t, *told)

    def add(self, t: float, kind: str, told: str) -> None:
        """One more line, of what happened at `t` s."""
        self.lines.add((shown(t), kind, told))
