"""Ground that moves under the wearer is noticed, and the position is as unsure as it makes it."""

from __future__ import annotations

from functools import cache
from math import hypot, pi

import pytest
from disturbed import on_walkway

from solepath import Session
from solepath.emulate.routes.route import Route
from solepath.emulate.walk import SampledWalk, sampled
from solepath.events import Defect, DefectFound, Event
from solepath.types import Sample

ROUTE = Route().stand(3).walk(90, 1.3).turn(pi / 2, 1.5).walk(30, 1.3).stop(2)
HELD = 5.991
"""Squared error within which a position is with 95 % probability (chi-square, 2)."""


@cache
def walk(seed: int) -> SampledWalk:
    return sampled(ROUTE, seed=seed)


def fed(samples: tuple[Sample, ...]) -> tuple[Session, list[Event]]:
    session = Session()
    return session, [event for sample in samples for event in session.feed(sample)]


def ground(events: list[Event]) -> list[DefectFound]:
    return [event for event in events if isinstance(event, DefectFound) and event.defect is Defect.MOVING_GROUND]


@pytest.mark.parametrize("seed", [1, 2, 3])
@pytest.mark.parametrize("velocity", [(0.65, 0.0), (-0.5, 0.0), (0.75, 0.0), (0.0, 0.5)])
def test_a_walkway_is_noticed_where_it_starts_and_where_it_ends(seed: int, velocity: tuple[float, float]) -> None:
    samples, way = on_walkway(walk(seed), 20.0, 50.0, velocity)
    session, events = fed(samples)
    first, second = ground(events)
    assert 20.0 < first.t < 24.0 and 50.0 < second.t < 54.0
    lacks = float(second.what.split("about ")[1].split(" m")[0])
    assert "moves by" in first.what and abs(lacks - hypot(*way)) < 0.25 * hypot(*way)
    assert not first.spoils and not second.spoils


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_the_covariance_holds_the_way_that_the_track_lacks(seed: int) -> None:
    samples, way = on_walkway(walk(seed), 20.0, 50.0, (0.65, 0.0))
    still, moving = fed(walk(seed).samples)[0].position, fed(samples)[0].position
    assert still is not None and moving is not None
    off = [a - b - w for a, b, w in zip(moving.position, still.position, (*way, 0.0), strict=True)]
    xx, xy, _, yy, _, _ = moving.covariance
    ex, ey, _ = off
    assert hypot(ex, ey) > 10.0, "the track lacks the way"
    assert (ex * ex * yy - 2.0 * ex * ey * xy + ey * ey * xx) / (xx * yy - xy * xy) < HELD
    xx, xy, _, yy, _, _ = still.covariance
    assert (ex * ex * yy - 2.0 * ex * ey * xy + ey * ey * xx) / (xx * yy - xy * xy) > HELD, "and would not have been"
