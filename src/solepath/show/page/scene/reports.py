"""Holds the positions that a person reported, for the marks on the drawing, and puts them into words."""

from __future__ import annotations

from attrs import define, field

from ....events import PositionRejected, PositionReported, TrackRevised
from .lists import GrowingList

MAX_REPORTS = 100
"""Largest number of reported positions that are marked, chosen by hand."""

ReportMark = tuple[float, str | None, float, float, bool | None]
"""(t, level, x, y, used): s and m; the level is None in the world frame; `used` is None while nothing came of it."""


@define
class SceneReports:
    """The newest MAX_REPORTS reported positions.

    What the session makes of a report follows it at once, before any watcher is sent the report."""

    marks: GrowingList[ReportMark] = field(factory=lambda: GrowingList(MAX_REPORTS))

    def add(self, event: PositionReported, wearer: tuple[float, ...] | None) -> None:
        """Add a report; `wearer` is the position of the wearer, m, which stands for that of a named place."""
        place = wearer if event.place else event.position or (0.0, 0.0)
        if place is not None:
            self.marks.add((round(event.t, 3), event.level or None, round(place[0], 3), round(place[1], 3), None))

    def settle(self, event: TrackRevised | PositionRejected) -> None:
        """Note what the session made of the newest report."""
        marks = self.marks.items
        if marks and marks[-1][0] == round(event.t, 3):
            marks[-1] = (*marks[-1][:4], isinstance(event, TrackRevised))


def report_words(event: PositionReported, level_name: str) -> str:
    """Return a sentence on a report; `level_name` names its level, if it has one."""
    if event.position is None:
        return f"reported: at {event.place}" if event.place else "reported: back where the walk started"
    x, y = event.position
    return f"reported: {f'{level_name}, ' if event.level else ''}at x {x:.1f} m, y {y:.1f} m"
