"""Collects the events of a session that the scores need, by foot, and those about the wearer's activity."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

import numpy as np
from attrs import define, field, frozen

from ...events import (
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
from ...show.timeline import Timeline
from ...types import Foot, Vec3
from ..measures.alignment import Floats

PHASES: tuple[type[Event], ...] = (HeelStrike, FootFlat, HeelOff, ToeOff)


@frozen(eq=False)
class FootRun:
    """Events of one foot: live track, strides and times of gait events.

    `positions` (n,3) in m is the track at `t` (n,) s."""

    t: Floats
    positions: Floats
    steps: tuple[StrideTaken, ...] = ()
    times: Mapping[type[Event], Sequence[float]] = field(factory=dict)
    """Times of HeelStrike, FootFlat, HeelOff and ToeOff, s."""

    @property
    def step_lengths(self) -> list[tuple[float, float]]:
        """(t_end, stride_length) of each stride."""
        return [(step.t_end, step.length) for step in self.steps]


@define
class _FootGathered:
    t: list[float] = field(factory=list)
    positions: list[Vec3] = field(factory=list)
    steps: list[StrideTaken] = field(factory=list)
    times: dict[type[Event], list[float]] = field(factory=lambda: {kind: [] for kind in PHASES})


@define
class Gathering:
    """Collects events as they arrive; `foot` returns those of one foot, which are empty when it has no events."""

    timeline: Timeline = field(factory=Timeline)
    rides: list[LiftRidden] = field(factory=list)
    turns: list[TurnMade] = field(factory=list)
    _feet: dict[Foot, _FootGathered] = field(factory=dict)

    @classmethod
    def of(cls, events: Iterable[Event]) -> Gathering:
        """Return the collection of these events."""
        gathering = cls()
        for event in events:
            gathering.add(event)
        return gathering

    def add(self, event: Event) -> None:
        """Add one event. Positions and activities always count, other events only when they are final."""
        match event:
            case FootMoved(foot=foot, t=t, position=position):
                one = self._of(foot)
                one.t.append(t)
                one.positions.append(position)
            case StrideTaken(foot=foot, final=True):
                self._of(foot).steps.append(event)
            case HeelStrike(final=True) | FootFlat(final=True) | HeelOff(final=True) | ToeOff(final=True):
                self._of(event.foot).times[type(event)].append(event.t)
            case ActivityChanged():
                self.timeline.add(event)
            case LiftRidden(final=True):
                self.rides.append(event)
            case TurnMade(final=True):
                self.turns.append(event)
            case _:
                pass

    def _of(self, foot: Foot) -> _FootGathered:
        return self._feet.setdefault(foot, _FootGathered())

    def foot(self, foot: Foot) -> FootRun:
        """Return the collected events of one foot."""
        one = self._of(foot)
        return FootRun(
            t=np.array(one.t, dtype=np.float64),
            positions=np.array(one.positions, dtype=np.float64).reshape(len(one.t), 3),
            steps=tuple(one.steps),
            times=one.times,
        )
