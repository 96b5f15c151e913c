"""What the experiments have in common: emulated walks, cut in two where a wearer stood, and sessions that hear them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from ..calibration import Calibration
from ..evaluate.alignment import Floats, align
from ..events import Event
from ..recipes import BY_NAME
from ..session import Session
from ..sim.truth import Truth
from ..sim.walk import EmulatedWalk
from ..types import Foot, Packet, Sample

STREAMS = ("insole/frame",)
"""Channels of samples; what comes on others (how an insole is laid out and scaled) is read at every beginning."""
ALIGNED_OVER = 2.0
"""m at the beginning over which a track's heading is laid on the truth's, as everywhere in evaluate."""


def longest_rest(truth: Truth) -> float:
    """The middle of the longest stand between two steps of the walk, s."""
    moving = sorted((step.t_heel_off, step.t_end) for foot in Foot for step in truth.steps(foot))
    rest, until = (0.0, 0.0), moving[0][1]
    for begin, end in moving[1:]:
        rest = max(rest, (begin - until, 0.5 * (begin + until)))
        until = max(until, end)
    return rest[1]


def cut(walk: EmulatedWalk, t: float) -> tuple[list[Packet], list[Packet]]:
    """The packets before and after `t` (s), as two recordings: devices say in both what they are."""
    before = [packet for packet in walk.packets if packet.t < t]
    known = [packet for packet in before if packet.channel not in STREAMS]
    return before, known + [packet for packet in walk.packets if packet.t >= t]


def heard(
    recipe: str, items: Sequence[Packet | Sample], calibration: Calibration, *, poses: bool = False
) -> list[Event]:
    """All that a session of the named recipe says."""
    session = Session(BY_NAME[recipe], calibration=calibration, poses=poses)
    events = session.feed(items)
    return events + session.finish()


def laid(track: Floats, truth: Floats, over: float = ALIGNED_OVER) -> Floats:
    """`track` (n, 2) turned and shifted onto `truth` (n, 2), row by row the same instants, so that both are as near as
    can be over the first `over` metres."""
    far = np.linalg.norm(truth - truth[0], axis=1) > over
    count = int(np.argmax(far)) + 1 if far.any() else len(truth)
    return align(track[:count], truth[:count]).apply(track)


def thinned(points: Iterable[Sequence[float]], most: int = 4000) -> tuple[tuple[float, float], ...]:
    """(x, y) of at most so many of these places, evenly chosen, the last one among them."""
    all_of = [(float(p[0]), float(p[1])) for p in points]
    every = -(-len(all_of) // most) or 1
    return tuple(all_of[::-1][::every][::-1])
