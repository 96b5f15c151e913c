"""Static postures in which an emulated shoe is held, for `solepath emulate --postures`."""

from __future__ import annotations

from collections.abc import Sequence
from math import radians

import numpy as np

from ...types import Phase
from ..wearers.curves import constant, join
from ..wearers.motion import PHASES, FootMotion
from ..wearers.shoe import Shoe

PITCHES = tuple(radians(value) for value in (10.0, 22.0, 34.0, 46.0, 58.0))
"""Pitches of five postures between flat and toe-off, rad (assumed: Chen et al. 2019 give no values)."""
MOVING_TIME = 1.0
"""Time in which a held shoe goes from one posture to the next, s (assumed)."""


def held_shoe(pitches: Sequence[float], hold: float) -> FootMotion:
    """Return the motion of a shoe that is held in static postures, from 0 s on: `hold` s each, after MOVING_TIME.

    It stands flat for `hold` s at first. The `pitches`, rad, are positive when the heel is up."""
    arc = Shoe().forefoot
    flat, centre = constant(0.0), [constant(value) for value in (arc.x, 0.0, arc.radius)]
    starts, durations, curves = [0.0], [hold], [[*centre, flat, flat, flat]]
    before = 0.0
    for pitch in (-pitch for pitch in pitches):
        way = join((before, 0.0, 0.0), (pitch, 0.0, 0.0), MOVING_TIME)
        for duration, curve in ((MOVING_TIME, way), (hold, constant(pitch))):
            starts.append(starts[-1] + durations[-1])
            durations.append(duration)
            curves.append([*centre, curve, flat, flat])
        before = pitch
    count = len(starts)
    return FootMotion(
        start=np.array(starts),
        duration=np.array(durations),
        curves=np.array(curves),
        reference=np.tile([arc.x, arc.radius], (count, 1)),
        radius=np.full(count, arc.radius),
        phase=np.full(count, PHASES.index(Phase.PUSH_OFF), dtype=np.intp),
    )


def held_time(hold: float) -> float:
    """Return how long the motion of `held_shoe` in PITCHES takes, s."""
    return hold + len(PITCHES) * (MOVING_TIME + hold)
