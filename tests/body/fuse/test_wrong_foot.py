"""A foot whose data are wrong leaves the wearer's position, which the other foot carries on."""

from __future__ import annotations

from functools import cache
from math import dist, sqrt

import pytest
from attrs import evolve
from soak import longer
from walks import both_feet

from solepath import Foot, Sample, Session
from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.parts import LSM6DSOX
from solepath.emulate.wearers.walker import Walker
from solepath.types.vector import GRAVITY, add

FULL = 16.0 * GRAVITY
ROUTE = Route().stand(2.0).walk(20.0, 1.3).turn(1.5, 1.0).walk(25.0).stop(1.0)


@cache
def walk() -> tuple[Sample, ...]:
    return both_feet(Walker(ROUTE, seed=6), 100.0, LSM6DSOX)


@cache
def sound_end() -> tuple[float, float, float]:
    session = Session()
    session.feed(walk())
    assert session.position is not None
    return session.position.position


def failing(fault: str, since: float) -> list[Sample]:
    """Return the walk with a sensor of the right foot that fails."""
    found, last = list[Sample](), None
    for sample in walk():
        if sample.site.foot is Foot.RIGHT and sample.t > since and sample.acc is not None:
            last = last or sample
            if fault == "2 g more":
                sample = evolve(sample, acc=add(sample.acc, (2.0 * GRAVITY, 0.0, 0.0)))
            elif fault == "full scale":
                sample = evolve(sample, acc=(FULL, FULL, FULL))
            else:
                sample = evolve(sample, gyro=last.gyro)
        found.append(sample)
    return found


@pytest.mark.parametrize("since", [10.0, 10.5, *longer(10.25, 10.75, 11.0)])
@pytest.mark.parametrize("fault", ["2 g more", "full scale", "a stuck gyroscope"])
def test_the_position_follows_the_other_foot_whenever_one_fails(fault: str, since: float) -> None:
    session = Session()
    session.feed(failing(fault, since))
    position = session.position
    assert position is not None and dist(position.position, sound_end()) < 1.0
    xx, _, _, yy, *_ = position.covariance
    assert sqrt(xx + yy) < 3.0


def test_a_foot_that_was_wrong_for_a_moment_is_placed_beside_the_other_one_again() -> None:
    """Its strides count again once three of them have closed, and its track is aligned by three more."""
    samples = [now if now.t > 10.9 else one for one, now in zip(failing("2 g more", 10.0), walk(), strict=True)]
    session = Session()
    session.feed(samples)
    assert session.position is not None and dist(session.position.position, sound_end()) < 1.0
    assert all(track.is_here for track in session._state.find_attribute("tracks").values())
