"""Settings of a part never change; so a packed state omits them, since the recipe makes the same part again."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import attrs
import pytest
from attrs import evolve
from walks import RECIPES, machines, packets, run_machine, samples

from solepath import Calibration, Foot, Recipe, Session, recipes
from solepath.body.fuse.both_feet import BothFeet, BothFeetSettings
from solepath.body.part import TrackPart
from solepath.calibration import InsoleCalibration, Newtons
from solepath.emulate.sensors.insoles import layout
from solepath.recipes import own
from solepath.saving import codec as machine
from solepath.session.wearer import WearerParts

OTHER_WALKS = ("fragments", "four samples a frame", "cc2541 at 20 Hz", "samples with pressure", "seven sites")
WALKS = tuple(f"session, {name}" for name in (*RECIPES, *OTHER_WALKS))


def is_part(cls: type) -> bool:
    return attrs.has(cls) and any(not f.init for f in attrs.fields(cls))


def changed(fresh: Any, used: Any, path: str = "") -> Iterator[str]:
    """Yield the settings of `used`, and of the parts within it, that differ from those of `fresh`."""
    if type(fresh) is not type(used):
        yield f"{path}: another part"
        return
    for f in attrs.fields(type(fresh)):
        fresh_value, used_value = getattr(fresh, f.name), getattr(used, f.name)
        if attrs.has(type(fresh_value)) and not isinstance(fresh_value, Recipe | Calibration):
            yield from changed(fresh_value, used_value, f"{path}.{f.name}") if holds_state(fresh_value) else ()
        elif f.init and is_part(type(fresh)) and fresh_value != used_value:
            yield f"{path}.{f.name}: {fresh_value!r}, now {used_value!r}"


def holds_state(record: Any) -> bool:
    """Return whether a record is a part, or has parts among its settings."""
    inner = [getattr(record, f.name) for f in attrs.fields(type(record))]
    return is_part(type(record)) or any(attrs.has(type(one)) and holds_state(one) for one in inner)


def changed_in(session: Session) -> list[str]:
    """Return the changed settings of all parts of a session."""
    used = session._state.wearer
    fresh = WearerParts(used.settings)
    changes = list(changed(fresh, used))
    for foot, tracker in used.feet.items():
        changes += changed(fresh._tracker(foot), tracker, foot.value)
    assert used.feet, "a walk that nobody heard"
    return changes


@pytest.mark.parametrize("name", WALKS)
def test_settings_of_every_part_are_after_a_walk_what_they_were_before_it(name: str) -> None:
    session = machines()[name].load(run_machine(name).fed)
    assert changed_in(session) == []


def test_a_calibration_that_does_not_fit_the_insoles_is_left_out_not_changed() -> None:
    """The insoles report newtons themselves, and have another number of cells than the calibration's noise."""
    cubic = Newtons((0.0, 1.0, 0.0, 0.0))
    unfit = Calibration({foot: InsoleCalibration(newtons=cubic, noise=(1.0,) * 9) for foot in Foot})
    session, plain = Session(calibration=unfit), Session()
    emitted, usual = session.feed(packets()["whole frames"]), plain.feed(packets()["whole frames"])
    assert changed_in(session) == []
    assert {type(event).__name__ for event in emitted} - {type(event).__name__ for event in usual} == {"Limitation"}
    assert session.position == plain.position
    for foot, tracker in session.feet.items():
        assert tracker.sole.insole.in_newtons
        assert tracker.sole.insole.tare == plain.feet[foot].sole.insole.tare


def test_sessions_of_one_recipe_hold_one_copy_of_it_and_of_a_recipe_that_was_changed_another() -> None:
    body = BothFeet()
    recipe = recipes.DEFAULT.exchanged(TrackPart, body, "mine")
    own_copy = own(recipe)
    assert own_copy is own(recipe) is own(evolve(recipe)) and own_copy is not recipe
    assert own_copy == recipe
    usual_settings, body.settings = body.settings, BothFeetSettings(reach=1.25)
    assert own(recipe) is not own_copy and own_copy != recipe
    body.settings = usual_settings
    assert own(recipe) is own_copy


def test_what_a_walk_does_to_parts_does_not_reach_the_recipe() -> None:
    saved = machine.save(recipes.DEFAULT)
    session, second_session = Session(), Session()
    session.feed(samples(cells=0, rate=50.0))
    assert machine.save(session.recipe) == machine.save(second_session.recipe) == machine.save(recipes.DEFAULT) == saved


def test_wearers_of_one_kind_of_insole_hold_its_layout_once() -> None:
    session_1, session_2 = Session(), Session()
    for session in (session_1, session_2):
        session.feed(packets()["whole frames"][:40])
    for foot in Foot:
        shared_layout = session_1.feet[foot].sole.insole.layout
        assert shared_layout is not None and shared_layout is session_2.feet[foot].sole.insole.layout
        assert len(shared_layout.xs) == len(shared_layout.ys) == len(layout(96, foot).cells)


def test_every_part_that_a_recipe_has_is_among_those_that_the_contracts_try() -> None:
    def parts(names: tuple[str, ...]) -> set[type]:
        recipes_found = [recipes.by_name(name) for name in names]
        return {
            type(part)
            for one in recipes_found
            for part in (one.detector, one.corrector, one.cues, one.place, *one.parts)
        }

    assert parts(recipes.NAMES) == parts(("default", *RECIPES))
