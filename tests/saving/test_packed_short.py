"""Shortage of memory or stack: the state is not reported as damaged, and can continue later."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from typing import Any

import pytest
from attrs import define, evolve
from fleets import WEARER, walked
from own import StillDetector

from solepath import Calibration, Session, SnapshotError, recipes
from solepath.fleet import Fleet

SHORT: list[Exception] = []
"""Exceptions with which copying a detector may end."""


@define
class Large(StillDetector):
    """A detector that takes room."""

    def __deepcopy__(self, memo: Any) -> Large:
        for error in SHORT:
            raise error
        return Large(self.limit)


@pytest.fixture(autouse=True)
def afterwards_there_is_room() -> Iterator[None]:
    yield
    SHORT.clear()


@pytest.mark.parametrize("short", [MemoryError(), RecursionError("too deep")], ids=["memory", "stack"])
def test_a_session_that_there_is_no_room_for_is_not_reported_as_damaged(short: Exception) -> None:
    recipe = evolve(recipes.DEFAULT, name="large", detector=Large(0.5 if isinstance(short, MemoryError) else 0.6))
    session = Session(recipe)
    session.feed([one.what for one in walked().sent[:200]])
    saved = session.pack()
    SHORT.append(short)
    with pytest.raises(type(short)):
        Session.unpack(saved, recipe)
    SHORT[:] = [RuntimeError("wrong by itself")]
    with pytest.raises(SnapshotError, match="wrong by itself"):
        Session.unpack(saved, recipe)
    SHORT.clear()
    assert Session.unpack(saved, recipe).pack() == saved


def test_near_the_end_of_the_stack_a_good_state_is_not_reported_as_damaged() -> None:
    saved = Session().pack()

    def deeper(by: int) -> Session:
        return deeper(by - 1) if by else Session.unpack(saved)

    frame, here = sys._getframe(), 1
    while frame.f_back is not None:
        frame, here = frame.f_back, here + 1
    outcomes = set()
    for left in range(5, 60):
        try:
            outcomes.add(deeper(sys.getrecursionlimit() - here - left).pack() == saved)
        except RecursionError:
            outcomes.add("no room")
    assert outcomes == {True, "no room"}


def test_a_fleet_that_is_short_of_memory_stops_and_goes_on_from_the_state_that_it_had() -> None:
    recipe = evolve(recipes.DEFAULT, name="large", detector=Large(0.7))
    fleet = Fleet(recipe, calibrations={WEARER: Calibration(weight=700.0)})
    keyed = fleet.open(WEARER, None)
    keyed.feed(walked().sent[:200])
    state = keyed.state()
    SHORT.append(MemoryError())
    with pytest.raises(MemoryError):
        fleet.step(WEARER, state, walked().sent[200:300])
    SHORT.clear()
    after, emitted = fleet.step(WEARER, state, walked().sent[200:300])
    assert emitted == keyed.feed(walked().sent[200:300]) != []
    assert after == keyed.state()
