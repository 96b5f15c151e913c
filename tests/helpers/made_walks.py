"""Walks as strides and gait cycles made by hand, whole or with times without samples of a foot."""

from __future__ import annotations

from strides import cycle, stride

from solepath.events import Event, GaitCycleMeasured, SampleGap, StrideTaken
from solepath.types import SITE_OF_FOOT, Foot

L, R = Foot.LEFT, Foot.RIGHT


def walk(start: float, seconds: int, length: float = 1.2) -> list[Event]:
    """Return strides of 1 s: the left foot swings from k + 0.5 to k + 0.9 s after `start`, the right one from k + 1.0
    to k + 1.4 s, for as many k as `seconds`."""
    made: list[Event] = []
    for k in range(seconds):
        for foot, offset in ((L, 0.5), (R, 1.0)):
            off = start + k + offset
            made.append(stride(foot, off + 0.5, (length, 0.0, 0.0), t_toe_off=off, t_heel_strike=off + 0.4))
            if k:
                made.append(cycle(foot, off - 0.6, 1.0, length))
    return made


def without(events: list[Event], foot: Foot, start: float, end: float) -> list[Event]:
    """Return the events of a walk in which the sensor of a foot sent nothing from `start` to `end`, s."""
    gap = SampleGap(t=start, known_at=end, site=SITE_OF_FOOT[foot], duration=end - start, count=0)
    kept = [
        one
        for one in events
        if not isinstance(one, StrideTaken | GaitCycleMeasured)
        or one.foot is not foot
        or one.t <= start
        or one.t_start >= end
    ]
    return [*kept, gap]
