"""Continuation over a gap in the samples, with the stride template where there is one (gap.py)."""

from __future__ import annotations

from ...events import Event
from ...types import Vec3
from ..cues.cues import Cues
from ..gait import Gait
from ..navigate.corrector import LONGEST_BRIDGE, Corrector
from .gap import NoInfill, find_infill


def cross_gap(
    gait: Gait,
    corrector: Corrector,
    cues: Cues,
    last: float,
    t: float,
    known_at: float,
    seen: tuple[Vec3, Vec3],
    interval: float,
    events: list[Event],
) -> float:
    """Return how long to integrate over a gap, s, and add the phases that it has hidden to `events`.

    The gap lasts from the last sample at `last` to the one at `t`, s. `seen` is acc and gyro at `t` (m/s^2, rad/s;
    without bias), `interval` the usual interval between samples, s."""
    template = gait.template
    dt = t - last
    acc, gyro = seen
    found = find_infill(template, corrector, last, t, acc, gyro)
    if found is NoInfill.UNKNOWN:
        template.mark_bridged()
        if dt > LONGEST_BRIDGE:
            template.reset()
        return corrector.bridge(dt)
    for _ in range(2):  # within a second a foot may land, stand and leave again
        if isinstance(found, NoInfill):
            break
        cues.reset()
        corrector.infill(t - last, found.attitude, found.velocity, found.position)
        events += gait.apply_infill(found, cues, known_at, corrector, interval)
        if found.t_foot_flat is None:
            break
        last = found.t_foot_flat
        found = find_infill(template, corrector, last, t, acc, gyro)
    return 0.0
