"""Ground that moves under the wearer is noticed, and the position is as unsure as it makes it."""

from __future__ import annotations

from cmath import rect
from functools import cache
from math import hypot, pi

import pytest
from attrs import evolve
from disturbed import on_walkway
from floors import stepped
from soak import longer, soaked

from solepath import Foot, Session
from solepath.body.fuse.moving_ground import MovingGround
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


def told_by(
    errors: dict[int, complex], step: float = 0.55, direction: float = 0.0, count: int = 60
) -> list[str | None]:
    """Return what each of `count` strides of both feet shows, whose velocity is off by 2 cm/s or by these errors, m/s.

    The errors are along the strides, which have this direction in the world, rad."""
    ground_below, told = MovingGround(), []
    for k in range(count):
        way, error = 1.3 * rect(1.0, direction), errors.get(k, 0.02 + 0j) * rect(1.0, direction)
        stride = stepped(step * k, (Foot.LEFT, Foot.RIGHT)[k % 2], k, (0.0, 0.0, 0.0))
        stride = evolve(stride, displacement=(way.real, way.imag, 0.0))
        told.append(ground_below.add_stride(stride, (error.real, error.imag, 0.3)))
    return told


ONTO, OFF = {20: 0.5 + 0.1j, 21: 0.6 + 0.1j}, {50: -0.5 - 0.1j, 51: -0.6 - 0.1j}


@pytest.mark.parametrize("direction", [0.0, 1.0, -2.5])
def test_the_ground_moves_from_the_step_onto_it_to_the_step_off_it_whatever_the_direction(direction: float) -> None:
    told = told_by(ONTO | OFF, direction=direction)
    assert [k for k, text in enumerate(told) if text] == [21, 51]
    assert str(told[21]).startswith("the ground moves by 0.6 m/s, as a moving walkway does")
    way = hypot(0.55, 0.1) * 30 * 0.55
    assert told[51] == f"the ground stands still again; the track lacks about {way:.0f} m that it has moved"


@pytest.mark.parametrize(
    "errors",
    [
        {20: 0.5 + 0j},  # of one foot
        {20: 0.5 + 0j, 22: 0.5 + 0j},
        {20: 0.5 + 0j, 21: -0.5 + 0j},  # each its own
        {20: 0.5 + 0j, 21: 0.8 + 0j},
        {20: 0.5 + 0j, 21: 0.5 + 0.3j},
        {20: 0.3 + 0j, 21: 0.3 + 0j},  # too slow, and too fast
        {20: 1.3 + 0j, 21: 1.3 + 0j},
        {4: 0.5 + 0j, 5: 0.5 + 0j},  # before it is known what is usual
    ],
)
def test_what_is_off_of_one_foot_or_of_each_in_its_own_way_is_no_ground(errors: dict[int, complex]) -> None:
    assert not any(told_by(errors))


def test_ground_is_that_of_two_steps_in_a_row_and_is_still_after_five_minutes() -> None:
    assert any(told_by(ONTO, step=1.4)) and not any(told_by(ONTO, step=1.6))
    late = {600: -0.5 - 0.1j, 601: -0.6 - 0.1j}
    texts = [text for text in told_by(ONTO | late, count=610) if text]
    assert len(texts) == 2 and all(text.startswith("the ground moves by 0.6 m/s") for text in texts)


def test_a_stride_of_no_length_says_nothing_of_the_ground() -> None:
    stride = evolve(stepped(1.0, Foot.LEFT, 1, (0.0, 0.0, 0.0)), displacement=(0.0, 0.0, 0.0))
    ground_below = MovingGround()
    assert ground_below.add_stride(stride, (0.5, 0.0, 0.0)) is None and ground_below == MovingGround()
