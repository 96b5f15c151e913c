"""Keeps the activities of the wearer over time; an activity that a later event replaced is left out."""

from __future__ import annotations

from bisect import bisect_right
from itertools import pairwise
from math import inf

from ..events import ActivityChanged
from ..types import Activity
from ..types.attrs import state, stateful


@stateful
class Timeline:
    """The activities from the start until now."""

    _starts: list[float] = state(factory=list)
    """Start of each activity, s, in rising order."""
    _activities: list[Activity] = state(factory=list)
    _min_duration: float = 1.0
    """Duration below which `_coarsen` leaves an activity out, s; it doubles with each call."""

    def add(self, event: ActivityChanged, max_count: int | None = None) -> None:
        """Add the next event, in the order in which they were reported.

        With more activities than `max_count`, the shortest are left out until at most half of `max_count` are left; the
        time of one that is left out goes to the activity before it. None keeps all."""
        if event.revises is not None:
            self._cut(event.revises)
        self._cut(event.t)
        self._starts.append(event.t)
        self._activities.append(event.activity)
        if max_count is not None and len(self._starts) > max_count:
            while len(self._starts) > max_count // 2:
                self._coarsen()

    @property
    def last(self) -> tuple[float, Activity]:
        """Last reported activity, after its start, s; (0, UNKNOWN) before the first."""
        if not self._starts:
            return 0.0, Activity.UNKNOWN
        k = len(self._starts) - 1
        while k > 0 and self._activities[k - 1] is self._activities[-1]:
            k -= 1
        return self._starts[k], self._activities[-1]

    def at(self, t: float) -> Activity:
        """Return the activity at `t`, s; UNKNOWN before the first."""
        i = bisect_right(self._starts, t)
        return self._activities[i - 1] if i else Activity.UNKNOWN

    def spans(self, until: float) -> list[tuple[float, float, Activity]]:
        """Return (start, end, activity) of all activities until `until`, s, in order of time."""
        edges = [*[t for t in self._starts if t < until], until]
        return [
            (start, end, activity) for (start, end), activity in zip(pairwise(edges), self._activities, strict=False)
        ]

    def durations(self, until: float) -> dict[Activity, float]:
        """Return the total duration of each activity until `until`, s; activities that never came are left out."""
        totals: dict[Activity, float] = {}
        for start, end, activity in self.spans(until):
            totals[activity] = totals.get(activity, 0.0) + end - start
        return {activity: totals[activity] for activity in Activity if activity in totals}

    def _cut(self, t: float) -> None:
        """Remove the activities that start at `t`, s, or later."""
        while self._starts and self._starts[-1] >= t:
            self._starts.pop()
            self._activities.pop()

    def _coarsen(self) -> None:
        """Leave out the activities that are shorter than `_min_duration`, then double that limit."""
        spans, self._starts, self._activities = self.spans(inf), [], []
        for start, end, activity in spans:
            if end - start >= self._min_duration and (not self._activities or self._activities[-1] is not activity):
                self._starts.append(start)
                self._activities.append(activity)
        self._min_duration *= 2.0
