"""Objects that sessions of one process share do not couple them: recipes, layouts, new sessions."""

from __future__ import annotations

import sys
import threading

import pytest
from attrs import define, evolve, field
from own import StillDetector
from walks import samples

from solepath import Foot, Session, recipes
from solepath.foot.settings import CycleSettings
from solepath.foot.stance.cycle import Cycle
from solepath.recipes import shared_copy


def test_sessions_are_started_in_many_threads_at_once() -> None:
    """Every session has a different recipe, so that the shared copies change all the time."""
    errors: list[Exception] = []

    def start_sessions(k: int) -> None:
        try:
            for i in range(25):
                cycle = Cycle(CycleSettings(least_threshold=1.0 + 1000 * k + i))
                Session(evolve(recipes.DEFAULT, detector=cycle))
        except Exception as error:
            errors.append(error)

    switch_interval = sys.getswitchinterval()
    sys.setswitchinterval(1e-5)
    try:
        threads = [threading.Thread(target=start_sessions, args=(k,)) for k in range(3)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
    finally:
        sys.setswitchinterval(switch_interval)
    assert errors == []


@define
class Likeness(StillDetector):
    """A detector whose limit does not count in comparisons, and a second one that cannot be compared at all."""

    limit: float = field(default=0.8, eq=False)


@define(eq=False)
class Quarrel(Likeness):
    def __eq__(self, other: object) -> bool:
        raise RuntimeError("compare me not")

    __hash__ = None  # type: ignore[assignment]


@define(eq=False)
class Loner(Likeness):
    """A detector that is equal only to itself."""

    __eq__ = object.__eq__
    __hash__ = object.__hash__


@pytest.mark.parametrize("kind", [Likeness, Quarrel, Loner])
def test_an_unpacked_session_has_the_settings_of_its_recipe_whatever_the_equality_of_its_detector(
    kind: type[Likeness],
) -> None:
    walked = samples(cells=0, rate=50.0)
    for limit in (0.5, 5.0, 0.0, -0.0):
        recipe = evolve(recipes.DEFAULT, name="mine", detector=kind(limit))
        session = Session(recipe)
        session.feed(walked[:40])
        again = Session.unpack(session.pack(), recipe)
        assert repr(again.recipe) == repr(session.recipe)
        assert repr(again.feet[Foot.LEFT].detector) == repr(session.feet[Foot.LEFT].detector)
        assert again._state.settings.recipe is shared_copy(recipe), "and it is held once"
