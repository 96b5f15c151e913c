"""Ground that moves under the wearer is noticed, and the position is as unsure as it makes it."""

from __future__ import annotations

from functools import cache
from math import hypot, pi

import pytest
from disturbed import on_walkway
from soak import longer, soaked

from solepath import Session
from solepath.emulate.routes.route import Route
from solepath.emulate.walk import SampledWalk, sampled
from solepath.events import Defect, DefectFound, Event

ROUTE = Route().stand(3).walk(90, 1.3).turn(pi / 2, 1.5).walk(30, 1.3).stop(2)


SEEDS = (1,)
"""Seeds of walks."""


@cache
def walk(seed: int) -> SampledWalk:
    return sampled(ROUTE, seed=seed)


@cache
def fed(seed: int, velocity: tuple[float, float]) -> tuple[Session, list[Event], tuple[float, float]]:
    """Return a session on ground that moves from 20 to 50 s, its events, and the way that the ground adds, m."""
    samples, way = on_walkway(walk(seed), 20.0, 50.0, velocity)
    session = Session()
    return session, session.feed(samples), way


def ground(events: list[Event]) -> list[DefectFound]:
    return [event for event in events if isinstance(event, DefectFound) and event.defect is Defect.MOVING_GROUND]


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("velocity", [*soaked((-0.5, 0.0)), *longer((0.0, 0.5))])
def test_a_walkway_is_noticed_where_it_starts_and_where_it_ends(seed: int, velocity: tuple[float, float]) -> None:
    _, events, way = fed(seed, velocity)
    first, second = ground(events)
    assert 20.0 < first.t < 24.0 and 50.0 < second.t < 54.0
    lacks = float(second.what.split("about ")[1].split(" m")[0])
    assert "moves by" in first.what and abs(lacks - hypot(*way)) < 0.25 * hypot(*way)
    assert not first.spoils and not second.spoils
