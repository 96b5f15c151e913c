"""Settings of a part never change: a packed state leaves them out, since the recipe makes the same part again."""

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

BESIDES = ("fragments", "four samples a frame", "cc2541 at 20 Hz", "samples with pressure", "seven sites")
WALKS = tuple(f"session, {name}" for name in (*RECIPES, *BESIDES))


def is_part(cls: type) -> bool:
    return attrs.has(cls) and any(not f.init for f in attrs.fields(cls))


def changed(fresh: Any, used: Any, path: str = "") -> Iterator[str]:
    """Settings of `used`, and of the parts that it was made with, that are not those of `fresh`."""
    if type(fresh) is not type(used):
        yield f"{path}: another part"
        return
    for f in attrs.fields(type(fresh)):
        before, now = getattr(fresh, f.name), getattr(used, f.name)
        if attrs.has(type(before)) and not isinstance(before, Recipe | Calibration):
            yield from changed(before, now, f"{path}.{f.name}") if holds_state(before) else ()
        elif f.init and is_part(type(fresh)) and before != now:
            yield f"{path}.{f.name}: {before!r}, now {now!r}"


def holds_state(record: Any) -> bool:
    """Return whether it is a part, or has parts among its settings."""
    inner = [getattr(record, f.name) for f in attrs.fields(type(record))]
    return is_part(type(record)) or any(attrs.has(type(one)) and holds_state(one) for one in inner)


def changed_in(session: Session) -> list[str]:
    """Return the changed settings of all parts of a session."""
    used = session._state.wearer
    fresh = WearerParts(used.settings)
    found = list(changed(fresh, used))
    for foot, tracker in used.feet.items():
        found += changed(fresh._tracker(foot), tracker, foot.value)
    assert used.feet, "a walk that nobody heard"
    return found


@pytest.mark.parametrize("name", WALKS)
def test_settings_of_every_part_are_after_a_walk_what_they_were_before_it(name: str) -> None:
    session = machines()[name].load(run_machine(name).fed)
    assert changed_in(session) == []


def test_a_calibration_that_does_not_fit_the_insoles_is_left_out_not_changed() -> None:
    """The insoles report newtons themselves, and have other cells than those of the measured noise."""
    cubic = Newtons((0.0, 1.0, 0.0, 0.0))
    odd = Calibration({foot: InsoleCalibration(newtons=cubic, noise=(1.0,) * 9) for foot in Foot})
    session, plain = Session(calibration=odd), Session()
    emitted, usual = session.feed(packets()["whole frames"]), plain.feed(packets()["whole frames"])
    assert changed_in(session) == []
    assert {type(event).__name__ for event in emitted} - {type(event).__name__ for event in usual} == {"Limitation"}
    assert session.position == plain.position
    for foot, tracker in session.feet.items():
        assert tracker.sole.insole.in_newtons
        assert tracker.sole.insole.tare == plain.feet[foot].sole.insole.tare


def test_sessions_of_one_recipe_hold_one_copy_of_it_and_of_a_recipe_that_was_changed_another() -> None:
    body = BothFeet()
    mine = recipes.DEFAULT.exchanged(TrackPart, body, "mine")
    held = own(mine)
    assert held is own(mine) is own(evolve(mine)) and held is not mine
    assert held == mine
    usual, body.settings = body.settings, BothFeetSettings(reach=1.25)
    assert own(mine) is not held and held != mine
    body.settings = usual
    assert own(mine) is held


def test_what_a_walk_does_to_parts_does_not_reach_the_recipe() -> None:
    before = machine.save(recipes.DEFAULT)
    one, other = Session(), Session()
    one.feed(samples(cells=0, rate=50.0))
    assert machine.save(one.recipe) == machine.save(other.recipe) == machine.save(recipes.DEFAULT) == before


def test_wearers_of_one_kind_of_insole_hold_its_layout_once() -> None:
    one, other = Session(), Session()
    for session in (one, other):
        session.feed(packets()["whole frames"][:40])
    for foot in Foot:
        where = one.feet[foot].sole.insole.layout
        assert where is not None and where is other.feet[foot].sole.insole.layout
        assert len(where.xs) == len(where.ys) == len(layout(96, foot).cells)


def test_every_part_that_a_recipe_has_is_among_those_that_the_contracts_try() -> None:
    def parts(names: tuple[str, ...]) -> set[type]:
        found = [recipes.by_name(name) for name in names]
        return {type(part) for one in found for part in (one.detector, one.corrector, one.cues, one.place, *one.parts)}

    assert parts(recipes.NAMES) == parts(("default", *RECIPES))
