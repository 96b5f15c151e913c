"""What is final is said once: each time has one final activity, whatever the chain of activities thinks later."""

from __future__ import annotations

from itertools import pairwise
from operator import attrgetter

import pytest
from soak import soaked

from solepath import Session, recipes
from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.parts import LSM6DSOX
from solepath.emulate.wearers.walker import Walker
from solepath.events import ActivityChanged
from solepath.types import Foot

STAIRS = [
    (False, 0.22),
    *(pytest.param(*one, marks=pytest.mark.soak) for one in ((True, 0.2), (True, 0.3), (False, 0.4))),
]
"""Whether the stairs go up, and the speed on them, m/s."""


@pytest.mark.parametrize("seed", [1, 3, *soaked(2, 4, 5)])
@pytest.mark.parametrize(("up", "speed"), STAIRS)
def test_a_change_is_final_once_it_cannot_come_later(seed: int, up: bool, speed: float) -> None:
    walker = Walker(Route().stand(3.0).walk(5.0, 1.0).stairs(11, up=up, speed=speed).walk(5.0).stop(8.0), seed=seed)
    samples = sorted([one for foot in Foot for one in walker.samples(foot, 100.0, LSM6DSOX)], key=attrgetter("t"))
    session = Session(recipes.DEFAULT)
    events = [event for one in samples for event in session.feed(one)] + session.finish()
    final = [event for event in events if isinstance(event, ActivityChanged) and event.final]
    assert len(final) > 3
    assert all(after.t - before.t > 0.1 and after.activity is not before.activity for before, after in pairwise(final))
