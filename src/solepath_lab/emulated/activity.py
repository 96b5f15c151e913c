"""Scores a recipe's activities on emulated wearers with a SensorTag in each sole at 20 Hz."""

from __future__ import annotations

from attrs import frozen

from solepath.recipes import Recipe
from solepath.session import Session
from solepath.walk.walk import Walk

from ..evaluate.activity import score_rides, score_samples, score_windows
from ..measures.confusion import ActivityScore
from ..train import emulated

SAMPLING_INTERVAL = 0.05
"""Time between the samples of the true activity, s."""


@frozen
class EmulatedScore:
    """The activity scores of one walk."""

    windows: ActivityScore
    """Score of the windows of two seconds that lie within one activity."""
    time: ActivityScore
    """Score of the whole time, changes of activity and elevator rides included."""


def score(recipe: Recipe, seed: int) -> EmulatedScore:
    """Score a session of the recipe on the walk of a seed, which must not be a training seed (train/emulated.py)."""
    walk = emulated.walk(seed)
    session = Session(recipe)
    found = Walk.of(session.feed(walk.packets) + session.finish())
    truth = walk.truth
    t = [k * SAMPLING_INTERVAL for k in range(int(truth.duration / SAMPLING_INTERVAL))]
    in_time = score_samples(t, [truth.activity(at) for at in t], found.timeline)
    return EmulatedScore(
        score_windows(truth.activities, found.timeline), in_time + score_rides(truth.activities, list(found.rides))
    )
