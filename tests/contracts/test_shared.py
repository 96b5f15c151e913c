"""Objects that sessions of one process share do not couple them: recipes, layouts, new sessions."""

from __future__ import annotations

import json
import sys
import threading

import pytest
from attrs import define, evolve, field
from own import StillDetector
from walks import samples

from solepath import Calibration, Foot, Session, recipes
from solepath.body.fuse.both_feet import BothFeet, BothFeetSettings
from solepath.body.part import TrackPart
from solepath.calibration import InsoleCalibration
from solepath.emulate.sensors.insoles import layout
from solepath.recipes import own
from solepath.types import Cell, shared


def test_sessions_are_started_in_many_threads_at_once() -> None:
    """Every session has a different recipe, so that the shared copies change all the time."""
    errors: list[Exception] = []

    def start_sessions(k: int) -> None:
        try:
            for i in range(25):
                both_feet = BothFeet(BothFeetSettings(reach=1.0 + 0.001 * (1000 * k + i)))
                Session(recipes.DEFAULT.exchanged(TrackPart, both_feet))
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


@define(slots=False)
class Loose(StillDetector):
    """A part that may hold state outside its fields."""


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
        assert again._state.wearer.settings.recipe is own(recipe), "and it is held once"


def test_recipes_are_distinguished_by_all_values_of_a_part_and_uncopyable_ones_are_not_kept() -> None:
    recipe_1, recipe_2 = (evolve(recipes.DEFAULT, detector=Loose()) for _ in range(2))
    assert own(recipe_1) is own(recipe_2)
    recipe_2.detector.__dict__["beside"] = 1.0
    assert own(recipe_1) is not own(recipe_2) is own(recipe_2)
    uncopyable = evolve(recipes.DEFAULT, detector=Likeness({0.5, 0.75}))  # type: ignore[arg-type]
    default = own(recipes.DEFAULT)
    for _ in range(40):
        assert own(uncopyable) == uncopyable
    assert own(recipes.DEFAULT) is default is own(default)


def test_minus_zero_in_a_recipe_or_in_a_calibration_stays_what_it_is() -> None:
    for zero in (0.0, -0.0):
        recipe = recipes.DEFAULT.exchanged(TrackPart, BothFeet(BothFeetSettings(reach=zero)))
        known = Calibration(toe_out={Foot.LEFT: zero}, drift={Foot.LEFT: (zero, 0.0)})
        session = Session(recipe, calibration=known)
        again = Session.unpack(session.pack(), recipe)
        assert json.dumps(again.snapshot()) == json.dumps(session.snapshot())
        assert again.pack() == session.pack()


def test_a_layout_is_shared_only_with_those_that_are_the_same_to_the_bit() -> None:
    layout_24 = layout(24, Foot.LEFT)
    for first, second in ((0.0, -0.0), (-0.0, 0.0)):
        number = 40 if str(first) == "0.0" else 41
        pair = [evolve(layout_24, id=number, cells=(Cell(x, 0.01), *layout_24.cells[1:])) for x in (first, second)]
        assert [repr(shared(one)) for one in pair] == [repr(one) for one in pair]
        sessions = [Session(calibration=Calibration({Foot.LEFT: InsoleCalibration(one)})) for one in pair]
        for session in sessions:
            session.feed(samples()[:60])
            again = Session.unpack(session.pack())
            assert again.pack() == session.pack()
            assert json.dumps(again.snapshot()) == json.dumps(session.snapshot())
    for changed in (
        evolve(layout_24, id=layout_24.id + 1), evolve(layout_24, foot=Foot.RIGHT), evolve(layout_24, length=0.3),
        evolve(layout_24, scale=None), evolve(layout_24, scale=0.0), evolve(layout_24, scale=-0.0),
        evolve(layout_24, full_scale=9.0),
        evolve(layout_24, cells=layout_24.cells[:-1]), evolve(layout_24, cells=()),
    ):  # fmt: skip
        assert repr(shared(changed)) == repr(changed)
        assert shared(changed) is shared(evolve(changed)) is not shared(layout_24)
