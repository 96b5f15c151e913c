"""The live track, strides and gait events of one foot as arrays and times, for scores."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from attrs import field, frozen

from ..events import Event, StrideTaken
from ..types import Foot
from ..walk.walk import GAIT_EVENTS, Walk
from .alignment import Floats


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

    @classmethod
    def of(cls, walk: Walk, foot: Foot) -> FootRun:
        """Return the run of a foot in a walk that keeps all; all fields are empty when there is none."""
        moved = walk.positions[foot]
        return cls(
            t=np.array([one.t for one in moved], dtype=np.float64),
            positions=np.array([one.position for one in moved], dtype=np.float64).reshape(len(moved), 3),
            strides=tuple(walk.strides[foot]),
            times={kind: walk.times[foot][name] for kind, name in GAIT_EVENTS.items()},
        )

    @property
    def stride_lengths(self) -> list[tuple[float, float]]:
        """End (s) and length (m) of each stride."""
        return [(stride.t_end, stride.length) for stride in self.strides]
