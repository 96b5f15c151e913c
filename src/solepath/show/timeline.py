"""Activities of the wearer over time; what a later event replaced is left out."""

from __future__ import annotations

from bisect import bisect_right
from itertools import pairwise
from math import inf

from attrs import define, field

from ..events import ActivityChanged
from ..types import Activity


@define
class Timeline:
    """The activities from the start until now."""

    _starts: list[float] = field(factory=list, init=False)
    """Start of each activity, s, rising."""
    _activities: list[Activity] = field(factory=list, init=False)
    _shortest: float = field(default=1.0, init=False)
    """Activities shorter than this are left out next, s."""

    def add(self, event: ActivityChanged, most: int | None = None) -> None:
        """Add the next event, in the order in which they were reported.

        With more changes than `most`, the shortest activities are left out and their time goes to the one before, until
        half as many are left. None keeps all."""
        if event.revises is not None:
            self._cut(event.revises)
        self._cut(event.t)
        self._starts.append(event.t)
        self._activities.append(event.activity)
        if most is not None and len(self._starts) > most:
            while len(self._starts) > most // 2:
                self._coarsen()

    @property
    def last(self) -> tuple[float, Activity]:
        """Start, s, and kind of the activity that was reported last; UNKNOWN since 0 before any."""
        if not self._starts:
            return 0.0, Activity.UNKNOWN
        k = len(self._starts) - 1
        while k > 0 and self._activities[k - 1] is self._activities[-1]:
            k -= 1
        return self._starts[k], self._activities[-1]

    def at(self, t: float) -> Activity:
        """Return the activity at `t` s; UNKNOWN before any was reported."""
        i = bisect_right(self._starts, t)
        return self._activities[i - 1] if i else Activity.UNKNOWN

    def spans(self, until: float) -> list[tuple[float, float, Activity]]:
        """Return (start, end, activity) of all activities until `until` s, one after the other."""
        edges = [*[t for t in self._starts if t < until], until]
        return [(a, b, what) for (a, b), what in zip(pairwise(edges), self._activities, strict=False)]

    def lasted(self, until: float) -> dict[Activity, float]:
        """Return the total duration of each activity until `until` s, without those that never came."""
        found: dict[Activity, float] = {}
        for a, b, what in self.spans(until):
            found[what] = found.get(what, 0.0) + b - a
        return {what: found[what] for what in Activity if what in found}

    def _cut(self, t: float) -> None:
        """Remove the activities that start at `t` s or later."""
        while self._starts and self._starts[-1] >= t:
            self._starts.pop()
            self._activities.pop()

    def _coarsen(self) -> None:
        """Leave out the activities that are shorter than `_shortest`, then double that limit."""
        spans, self._starts, self._activities = self.spans(inf), [], []
        for start, end, what in spans:
            if end - start >= self._shortest and (not self._activities or self._activities[-1] is not what):
                self._starts.append(start)
                self._activities.append(what)
        self._shortest *= 2.0
