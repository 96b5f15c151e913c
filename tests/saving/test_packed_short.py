"""Shortage of memory or stack: the state is not reported as damaged, and can continue later."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest
from attrs import define, evolve
from fleets import walked
from own import StillDetector

from solepath import Session, SnapshotError, recipes

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
