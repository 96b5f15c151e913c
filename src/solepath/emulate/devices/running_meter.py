"""Speed, cadence, stride length and distance now, from the events of a session."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from math import inf
from typing import Protocol

from attrs import define, field

from ...events import ActivityChanged, Event, GaitCycleMeasured, StrideTaken
from ...session import Session
from ...types import Activity, Foot, Packet
from ...wire.running import RscMeasurement

STANDING_TIME = 3.0
"""Time since the last gait cycle ended after which the wearer stands, s: twice the longest cycle of slow walking."""
MAX_CADENCE = 255
"""Largest cadence that a measurement can have, 1/min."""


class RunningSource(Protocol):
    """Something that knows the measurement at a time."""

    def measure(self, t: float) -> RscMeasurement:
        """Return the measurement at `t` s; times never decrease until `restart`."""

    def restart(self) -> None:
        """Start again, for a walk that starts again."""


@define
class RunningMeter:
    """Takes the events of a session as they are reported; speeds in m/s, lengths in m, cadence in steps/min.

    Speed, cadence and stride length are those of the newest gait cycle of each foot, averaged over both feet."""

    distance: float = field(default=0.0, init=False)
    """Mean of both feet's sums of stride lengths, m; of one foot, while the other one has none. It never decreases."""
    _cycles: dict[Foot, GaitCycleMeasured] = field(factory=dict, init=False)
    _distances: dict[Foot, float] = field(factory=dict, init=False)
    _stood_at: float = field(default=-inf, init=False)
    """Time of the last change to standing, s."""

    def add(self, events: Iterable[Event]) -> None:
        """Take the next events of the session."""
        for event in events:
            match event:
                case GaitCycleMeasured():
                    self._cycles[event.foot] = event
                case StrideTaken(final=True):
                    self._distances[event.foot] = self._distances.get(event.foot, 0.0) + event.length
                    both = list(self._distances.values())
                    mean = 0.5 * (both[0] + both[1]) if len(both) == 2 else both[0]
                    self.distance = max(self.distance, mean)
                case ActivityChanged(activity=Activity.STANDING):
                    self._stood_at = event.t
                case _:
                    pass

    def measure(self, t: float) -> RscMeasurement:
        """Return the measurement at `t` s on the session's clock."""
        recent = [
            cycle
            for cycle in self._cycles.values()
            if t - cycle.t <= STANDING_TIME and cycle.t > self._stood_at and cycle.speed is not None
        ]
        if not recent:
            return RscMeasurement(0.0, 0, 0.0, self.distance)
        return RscMeasurement(
            speed=_mean([cycle.speed for cycle in recent if cycle.speed is not None]),
            cadence=min(MAX_CADENCE, round(_mean([cycle.cadence for cycle in recent]))),
            stride_length=_mean([cycle.stride_length for cycle in recent if cycle.stride_length is not None]),
            distance=self.distance,
            running=all([cycle.running for cycle in recent]),
        )

    def restart(self) -> None:
        """Start again; a live session has no other start, so that its distance goes on."""


class ReplayedMeter:
    """A RunningSource that runs the packets of a walk through a session as their time comes."""

    def __init__(self, packets: Sequence[Packet]) -> None:
        self._packets = packets
        self.restart()

    def restart(self) -> None:
        self._session, self._meter, self._fed = Session(), RunningMeter(), 0

    def measure(self, t: float) -> RscMeasurement:
        while self._fed < len(self._packets) and self._packets[self._fed].t <= t:
            self._meter.add(self._session.feed(self._packets[self._fed]))
            self._fed += 1
        return self._meter.measure(t)


def _mean(values: Sequence[float]) -> float:
    total = 0.0
    for value in values:
        total += value
    return total / len(values) if values else 0.0
