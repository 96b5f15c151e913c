"""What a recipe makes of the activities of emulated wearers, who wear SensorTags in their soles at 20 Hz."""

from __future__ import annotations

from attrs import frozen

from ...recipes import Recipe
from ...session import Session
from ..evaluate.activity import compared, rides, windows
from ..evaluate.gathered import Gathering
from ..measures.confusion import ActivityScore
from ..train import emulated

EVERY = 0.05
"""The truth is asked so often, s."""


@frozen
class Emulated:
    """Of one walk."""

    windows: ActivityScore
    """Windows of two seconds that lie within one activity."""
    time: ActivityScore
    """All the time, changes included, and the rides."""


def score(recipe: Recipe, seed: int) -> Emulated:
    """What a session of the recipe says of the walk of a seed. Score seeds that nothing was learnt from."""
    walked = emulated.walk(seed)
    session = Session(recipe)
    gathering = Gathering.of(session.feed(walked.packets) + session.finish())
    truth = walked.truth
    t = [k * EVERY for k in range(int(truth.duration / EVERY))]
    told = compared(t, [truth.activity(at) for at in t], gathering.timeline)
    return Emulated(windows(truth.activities, gathering.timeline), told + rides(truth.activities, gathering.rides))
