"""Floors with equal walls keep their weights however long the wearer walks there; a door that only one has decides."""

from __future__ import annotations

import pytest
from floors import CORNERS, LOW, METHODS, RIGHT, WIDE, Method, Pedestrian, follow

ROUNDS = 3


def on_both_floors(part: Method, pedestrian: Pedestrian, share: float) -> None:
    """Let the part follow the pedestrian, and move this share of its weight to the other floor, at the same place."""
    pedestrian.known_to(part)
    pedestrian.walk((20.0, LOW))
    follow(part, pedestrian.received)
    pedestrian.received.clear()
    staying = [one._replace(weight=(1.0 - share) * one.weight) for one in part.particles]
    other = 1 - staying[0].level
    moved = [one._replace(weight=share * one.weight, level=other) for one in part.particles[::3]]
    part.set_particles(staying + moved)


def weight_of(part: Method, level: str) -> float:
    assert part.place is not None
    return sum([one.weight for one in part.place.candidates if one.level == level])


@pytest.mark.parametrize("method", METHODS)
def test_rounds_on_a_floor_do_not_change_which_of_two_alike_floors_it_is(method: type[Method]) -> None:
    part, pedestrian = method(), Pedestrian(2, "1", (12.0, LOW))
    on_both_floors(part, pedestrian, 0.5)
    pedestrian.walk((22.0, LOW))
    follow(part, pedestrian.received)
    pedestrian.received.clear()
    at_first = weight_of(part, "0")
    assert 0.1 < at_first < 0.5
    for _ in range(ROUNDS):
        pedestrian.walk(*CORNERS[1:], CORNERS[0])
    follow(part, pedestrian.received)
    assert weight_of(part, "0") == pytest.approx(at_first, abs=0.1)


@pytest.mark.parametrize("method", METHODS)
def test_an_exit_that_only_one_floor_has_decides(method: type[Method]) -> None:
    part, pedestrian = method(), Pedestrian(4, "0", (12.0, LOW))
    on_both_floors(part, pedestrian, 0.9)
    pedestrian.walk((RIGHT, LOW), (WIDE - 1.5, LOW), (WIDE + 4.0, LOW))
    follow(part, pedestrian.received)
    assert weight_of(part, "0") > 0.95
