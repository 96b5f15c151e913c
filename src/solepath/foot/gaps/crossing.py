"""Continuation over a gap in the samples: by infill if there is a stride template (gap.py), else by a straight line."""

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
    t_last: float,
    t: float,
    known_at: float,
    acc_and_gyro: tuple[Vec3, Vec3],
    interval: float,
    events: list[Event],
) -> float:
    """Cross a gap; return the time over which to integrate, s, and append the hidden phases to `events`.

    The gap lasts from the last sample at `t_last` to the one at `t`, s. `acc_and_gyro` holds acc and gyro at `t`
    (m/s^2, rad/s; without bias). `interval` is the usual interval between samples, s."""
    template = gait.template
    dt = t - t_last
    acc, gyro = acc_and_gyro
    infill = find_infill(template, corrector, t_last, t, acc, gyro)
    if infill is NoInfill.UNKNOWN:
        template.mark_bridged()
        if dt > LONGEST_BRIDGE:
            template.reset()
        return corrector.bridge(dt)
    for _ in range(2):  # within a second a foot may land, stand and leave again
        if isinstance(infill, NoInfill):
            break
        cues.reset()
        corrector.infill(t - t_last, infill.attitude, infill.velocity, infill.position)
        events += gait.apply_infill(infill, cues, known_at, corrector, interval)
        if infill.t_foot_flat is None:
            break
        t_last = infill.t_foot_flat
        infill = find_infill(template, corrector, t_last, t, acc, gyro)
    return 0.0
