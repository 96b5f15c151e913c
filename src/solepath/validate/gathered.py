"""Collects the events of a session that scores need: those of each foot, activities, elevator rides and turns."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

import numpy as np
from attrs import define, field, frozen

from ..events import (
    ActivityChanged,
    Event,
    FootFlat,
    FootMoved,
    HeelOff,
    HeelStrike,
    LiftRidden,
    StrideTaken,
    ToeOff,
    TurnMade,
)
from ..show.timeline import Timeline
from ..types import Foot, Vec3
from .alignment import Floats

GAIT_EVENTS: tuple[type[Event], ...] = (HeelStrike, FootFlat, HeelOff, ToeOff)


@frozen(eq=False)
class FootRun:
    """The live track, strides and times of gait events of one foot."""

    t: Floats
    """Times of `positions`, (n,), s."""
    positions: Floats
    """Live positions of the sensor in the world frame, (n,3), m."""
    strides: tuple[StrideTaken, ...] = ()
    times: Mapping[type[Event], Sequence[float]] = field(factory=dict)
    """Times of HeelStrike, FootFlat, HeelOff and ToeOff, s."""

    @property
    def stride_lengths(self) -> list[tuple[float, float]]:
        """End (s) and length (m) of each stride."""
        return [(stride.t_end, stride.length) for stride in self.strides]


@define
class _FootEvents:
    t: list[float] = field(factory=list)
    positions: list[Vec3] = field(factory=list)
    strides: list[StrideTaken] = field(factory=list)
    times: dict[type[Event], list[float]] = field(factory=lambda: {kind: [] for kind in GAIT_EVENTS})


@define
class EventCollection:
    """Collects the events of a session as they arrive."""

    timeline: Timeline = field(factory=Timeline)
    activities: list[ActivityChanged] = field(factory=list)
    """Activities in the order in which they were reported."""
    rides: list[LiftRidden] = field(factory=list)
    turns: list[TurnMade] = field(factory=list)
    _feet: dict[Foot, _FootEvents] = field(factory=dict)

    @classmethod
    def of(cls, events: Iterable[Event]) -> EventCollection:
        """Return a collection with these events."""
        collection = cls()
        for event in events:
            collection.add(event)
        return collection

    def add(self, event: Event) -> None:
        """Add one event. Positions and activities are always kept, other events only when they are final."""
        match event:
            case FootMoved(foot=foot, t=t, position=position):
                foot_events = self._events_of(foot)
                foot_events.t.append(t)
                foot_events.positions.append(position)
            case StrideTaken(foot=foot, final=True):
                self._events_of(foot).strides.append(event)
            case HeelStrike(final=True) | FootFlat(final=True) | HeelOff(final=True) | ToeOff(final=True):
                self._events_of(event.foot).times[type(event)].append(event.t)
            case ActivityChanged():
                self.timeline.add(event)
                self.activities.append(event)
            case LiftRidden(final=True):
                self.rides.append(event)
            case TurnMade(final=True):
                self.turns.append(event)
            case _:
                pass

    def _events_of(self, foot: Foot) -> _FootEvents:
        return self._feet.setdefault(foot, _FootEvents())

    def foot(self, foot: Foot) -> FootRun:
        """Return the collected events of one foot; all fields are empty when it has none."""
        foot_events = self._events_of(foot)
        return FootRun(
            t=np.array(foot_events.t, dtype=np.float64),
            positions=np.array(foot_events.positions, dtype=np.float64).reshape(len(foot_events.t), 3),
            strides=tuple(foot_events.strides),
            times=foot_events.times,
        )
