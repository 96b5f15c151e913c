"""Two feet of one body: each stride corrects the other foot's track."""

from __future__ import annotations

from functools import cache
from math import atan2, cos, dist, hypot, pi, remainder, sin

import pytest
from attrs import evolve

from solepath import recipes
from solepath.body.fuse.both_feet import BothFeet
from solepath.body.fuse.position import MeanOfFeet
from solepath.body.part import TrackPart
from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.parts import LSM6DSOX
from solepath.emulate.walk import sampled
from solepath.emulate.wearers.walker import Walker
from solepath.events import Event, StrideTaken
from solepath.session import Session
from solepath.types import Foot, Sample, Site, Vec3

LONG = Route().stand(2.0).walk(40.0, 1.3).stop(1.0)
CHEAP = evolve(LSM6DSOX, gyro=evolve(LSM6DSOX.gyro, scale=0.03, cross=0.02))
"""A gyroscope that turns the strides of one foot otherwise than those of the other."""


@cache
def _samples(seed: int) -> tuple[Sample, ...]:
    walker = Walker(LONG, seed=seed)
    both = [sample for foot in Foot for sample in walker.samples(foot, 50.0, CHEAP)]
    return tuple(sorted(both, key=lambda sample: sample.t))


@cache
def _walked(part: str) -> tuple[Session, list[Event]]:
    body = {"both": BothFeet(), "mean": MeanOfFeet()}[part]
    session = Session(recipes.DEFAULT.replace_part(TrackPart, body))
    events = [event for sample in _samples(102) for event in session.feed(sample)]
    return session, events


def _apart(session: Session) -> float:
    """Return the distance between the feet as their body has placed them, m."""
    body = next(part for part in session._state.parts if isinstance(part, MeanOfFeet))
    left, right = [body.tracks[foot].place(session.feet[foot].position) for foot in Foot]
    return hypot(left[0] - right[0], left[1] - right[1])


@pytest.mark.soak
def test_feet_that_drift_apart_are_held_together() -> None:
    alone, _ = _walked("mean")
    both, _ = _walked("both")
    assert _apart(alone) > 1.2
    assert _apart(both) < 0.5
    assert both.position is not None
    assert hypot(both.position.position[0] - 40.0, both.position.position[1]) < 0.1 * 40.0


@pytest.mark.parametrize("first_direction", [-1.0, 3.1])
def test_a_foot_that_first_steps_aside_does_not_bend_either_track(first_direction: float) -> None:
    session = Session()
    steps: list[StrideTaken] = []
    for sample in _samples(102):
        for event in session.feed(sample):
            if isinstance(event, StrideTaken):
                steps.append(event)
                if event.foot is Foot.LEFT and event.number == 1:
                    # as if its first step, which its world frame begins along, had led there
                    session.feet[Foot.LEFT].gait.world.north = (cos(first_direction), sin(first_direction))
    assert _apart(session) < 0.5
    for foot in Foot:
        own = [step.displacement for step in steps if step.foot is foot][2:-1]
        first = atan2(own[0][1], own[0][0])
        # 40 m of this gyroscope turn a track by some degrees
        assert max(abs(remainder(atan2(y, x) - first, 2.0 * pi)) for x, y, _ in own) < 0.3


@pytest.mark.soak
def test_a_foot_that_returns_pulls_nothing_before_it_is_aligned() -> None:
    """The right foot is silent in a bend and comes back tens of metres from where it was seen last."""
    route = Route().stand(3.0).walk(12.0, 1.3).turn(0.5 * pi, 1.0).walk(50.0, 1.3).stop(2.0)
    walk = sampled(route, seed=4)
    session, steps = Session(), [0.0]
    before: Vec3 | None = None
    for sample in walk.samples:
        if sample.site.foot is Foot.LEFT or not 8.0 < sample.t < 36.0:
            session.feed(sample)
        if sample.t > 36.0 and session.position is not None:
            here = session.position.position
            steps.append(0.0 if before is None else dist(here, before))
            before = here
    assert max(steps) < 0.5


def test_a_foot_that_was_silent_in_mid_walk_is_beside_the_other_foot_again_after_some_strides() -> None:
    walker = Walker(Route().stand(2).walk(24.0, 1.2).stop(1), seed=6)
    feet = [walker.samples(foot, 100.0, LSM6DSOX) for foot in Foot]
    worn = sorted((one for samples in feet for one in samples), key=lambda one: one.t)
    session = Session()
    for sample in worn:
        if sample.site is Site.LEFT_FOOT or not 6.0 < sample.t < 10.0:
            session.feed(sample)
    (both,) = [part for part in session._state.parts if isinstance(part, BothFeet)]
    left, right = (both.tracks[foot] for foot in Foot)
    assert (
        both.is_aligned and abs(left.newest[0] - right.newest[0]) < 1.0 and abs(left.newest[1] - right.newest[1]) < 0.6
    )
