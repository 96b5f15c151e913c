"""What comes after a pause decides nothing about what came before it."""

from __future__ import annotations

import pytest

from solepath import Foot, Session, StrideTaken
from solepath.emulate import Route, Walker
from solepath.emulate.sensors.parts import LSM6DSOX


@pytest.mark.parametrize("seed", [111, 112, 114, 117])
def test_a_lone_step_does_not_become_a_stride_a_minute_later(seed: int) -> None:
    route = Route(speed=1.2).stand(3.0).walk(8.0).stand(8.0).walk(0.55, 1.0).stand(60.0).walk(8.0, 1.3).stop(4.0)
    fed = sorted(
        [one for foot in Foot for one in Walker(route, seed=seed).samples(foot, 50.0, LSM6DSOX)], key=lambda one: one.t
    )
    session = Session()
    strides = [one for one in session.feed(fed) + session.finish() if isinstance(one, StrideTaken) and one.final]
    assert len(strides) > 10 and max([one.known_at - one.t_end for one in strides]) < 6.0
