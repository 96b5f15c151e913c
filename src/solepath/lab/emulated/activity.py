"""Scores a recipe's activities on emulated wearers, who wear SensorTags in their soles at 20 Hz."""

from __future__ import annotations

from attrs import frozen

from ...recipes import Recipe
from ...session import Session
from ..evaluate.activity import score_rides, score_samples, score_windows
from ..evaluate.gathered import Gathering
from ..measures.confusion import ActivityScore
from ..train import emulated

EVERY = 0.05
"""Interval at which the true activity is sampled, s."""


@frozen
class EmulatedScore:
    """Activity scores of one walk."""

    windows: ActivityScore
    """Score of the windows of two seconds that lie within one activity."""
    time: ActivityScore
    """Score of the whole time, changes of activity and lift rides included."""


def score(recipe: Recipe, seed: int) -> EmulatedScore:
    """Score a session of the recipe on the walk of a seed. Use seeds that nothing was learnt from."""
    walked = emulated.walk(seed)
    session = Session(recipe)
    gathering = Gathering.of(session.feed(walked.packets) + session.finish())
    truth = walked.truth
    t = [k * EVERY for k in range(int(truth.duration / EVERY))]
    in_time = score_samples(t, [truth.activity(at) for at in t], gathering.timeline)
    return EmulatedScore(
        score_windows(truth.activities, gathering.timeline), in_time + score_rides(truth.activities, gathering.rides)
    )
