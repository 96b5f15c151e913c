"""What is kept of a long walk: few values, evenly spread, however long it is."""

from __future__ import annotations

from collections.abc import Iterator
from math import isfinite
from typing import Any, Generic, TypeVar

import attrs
from attrs import define, field

from ...events import ActivityChanged, Event, FootPressed
from ..timeline import Timeline

T = TypeVar("T")

LARGEST = 1e12
"""No number of an event is as large, in whatever unit: it is none."""


def finite(value: Any) -> bool:
    """Whether every number in a record is one."""
    if isinstance(value, float):
        return isfinite(value) and abs(value) < LARGEST
    if isinstance(value, tuple):
        return all(map(finite, value))
    if attrs.has(type(value)):
        return all([finite(getattr(value, one.name)) for one in attrs.fields(type(value))])
    return True


def sound(event: Event) -> bool:
    """Whether every number in an event is one; quickly for those of every sample."""
    if isinstance(event, FootPressed):
        return finite(event.t) and finite(event.force) and isfinite(sum(event.values)) and finite(event.centre)
    return finite(event)


@define
class Thinned(Generic[T]):
    """The first and the last item and, evenly among the others, so many that there are fewer than `most`."""

    most: int
    kept: list[T] = field(factory=list, init=False)
    every: int = field(default=1, init=False)
    """Each so-many-th item is kept."""
    count: int = field(default=0, init=False)
    last: T | None = field(default=None, init=False)

    def add(self, item: T) -> None:
        """One more."""
        if self.count % self.every == 0:
            if len(self.kept) >= self.most:
                self.kept = self.kept[::2]
                self.every *= 2
            if self.count % self.every == 0:
                self.kept.append(item)
        self.count += 1
        self.last = item

    def __iter__(self) -> Iterator[T]:
        yield from self.kept
        if self.last is not None and self.kept and self.kept[-1] is not self.last:
            yield self.last

    def __len__(self) -> int:
        return len(self.kept)


def coarser(timeline: Timeline, until: float, shortest: float) -> Timeline:
    """The same without activities that lasted for less than `shortest` s: they go to the one before."""
    made = Timeline()
    for begin, end, what in timeline.spans(until):
        if end - begin >= shortest and made.at(begin) is not what:
            made.add(ActivityChanged(t=begin, known_at=begin, activity=what, probability=None))
    return made
