"""A silence may end anywhere in a stride: what the foot does then is no push-off, and no finding follows."""

from __future__ import annotations

from functools import cache

import pytest
from soak import soaked

from solepath import Session, recipes
from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.parts import LSM6DSOX
from solepath.emulate.wearers.walker import Walker
from solepath.events import DefectFound, StrideTaken
from solepath.types import Foot, Sample

PHASES = 36
"""Number of instants of a stride of 1.1 s at which a silence ends."""


@cache
def walked(seed: int) -> tuple[Sample, ...]:
    route = Route().stand(3.0).walk(40.0, 1.3).stand(3.0)
    return tuple(Walker(route, seed=seed).samples(Foot.LEFT, 100.0, LSM6DSOX))


@pytest.mark.parametrize("seed", [1, *soaked(2)])
@pytest.mark.parametrize("phase", [0, 12, 24, 32, *soaked(*(k for k in range(PHASES) if k not in (0, 12, 24, 32)))])
def test_a_foot_walks_on_after_a_silence_that_ends_anywhere_in_its_stride(seed: int, phase: int) -> None:
    begins, ends = 15.0, 25.0 + 1.1 * phase / PHASES
    session = Session(recipes.DEFAULT)
    events = [event for one in walked(seed) if not begins < one.t < ends for event in session.feed(one)]
    events += session.finish()
    assert [event.what for event in events if isinstance(event, DefectFound)] == []
    taken = [event for event in events if isinstance(event, StrideTaken) and event.t_start > ends - 0.5]
    assert len(taken) >= 7  # of about 9
