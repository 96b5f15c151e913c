"""Holds the positions that a person reported, for the marks on the drawing, and puts them into words."""

from __future__ import annotations

from math import degrees, hypot

from attrs import define, field

from ....events import PositionRejected, PositionReported, TrackRevised
from ..messages import rounded
from .lists import RecentItems

MAX_REPORTS = 100
"""Largest number of reported positions that are marked, chosen by hand."""

ReportMark = tuple[float | None, str | None, float | None, float | None, bool | None]
"""(t, level, x, y, used): s and m; the level is None in the world frame; `used` is None while nothing came of it."""


@define
class SceneReports:
    """The newest MAX_REPORTS reported positions.

    What the session makes of a report follows it at once, before any watcher is sent the report."""

    marks: RecentItems[ReportMark] = field(factory=lambda: RecentItems(MAX_REPORTS))

    def add(self, event: PositionReported, wearer: tuple[float, float] | None) -> None:
        """Add a report; `wearer` is the position of the wearer, m, which stands for that of a named place."""
        place = wearer if event.place else event.position or (0.0, 0.0)
        if place is not None:
            self.marks.add((rounded(event.t), event.level or None, rounded(place[0]), rounded(place[1]), None))

    def settle(self, event: TrackRevised | PositionRejected) -> None:
        """Note what the session made of the newest report."""
        items = self.marks.items
        if items and items[-1][0] == rounded(event.t):
            items[-1] = (*items[-1][:4], isinstance(event, TrackRevised))


def report_words(event: PositionReported, level_name: str) -> str:
    """Return a sentence on a report; `level_name` names its level, if it has one."""
    if event.position is None:
        return f"reported: at {event.place}" if event.place else "reported: back where the walk started"
    x, y = event.position
    return f"reported: {f'{level_name}, ' if event.level else ''}at x {x:.1f} m, y {y:.1f} m"


def outcome_words(event: TrackRevised | PositionRejected) -> str:
    """Return a sentence on what the session made of a report."""
    if isinstance(event, PositionRejected):
        return f"position rejected: {event.what}"
    by, turn = hypot(*event.by), abs(degrees(event.turn))
    return f"track revised: moved by {by:.1f} m, turned by {turn:.0f} degree{'s' * (round(turn) != 1)}"
