"""Settings of a part never change; so a packed state omits them, since the recipe makes the same part again."""

from __future__ import annotations

from attrs import evolve
from walks import RECIPES, packets, samples

from solepath import Foot, Session, recipes
from solepath.body.fuse.both_feet import BothFeet, BothFeetSettings
from solepath.body.part import TrackPart
from solepath.emulate.sensors.insoles import layout
from solepath.foot.settings import CycleSettings
from solepath.foot.stance.cycle import Cycle
from solepath.recipes import shared_copy
from solepath.saving import codec as machine


def test_sessions_of_one_recipe_hold_one_copy_of_it_and_of_a_recipe_that_was_changed_another() -> None:
    body = BothFeet()
    recipe = recipes.DEFAULT.replace_part(TrackPart, body, "mine")
    own_copy = shared_copy(recipe)
    assert own_copy is shared_copy(recipe) is shared_copy(evolve(recipe)) and own_copy is not recipe
    assert own_copy == recipe
    usual_settings, body.settings = body.settings, BothFeetSettings(straightness=False)
    assert shared_copy(recipe) is not own_copy and own_copy != recipe
    body.settings = usual_settings
    assert shared_copy(recipe) is own_copy


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


def test_the_settings_with_which_a_session_is_unpacked_count_from_its_first_sample() -> None:
    tuned = evolve(recipes.DEFAULT, detector=Cycle(CycleSettings(threshold_position=0.9)))
    session = Session()
    for sample in samples(cells=0):
        session.feed(sample)
        for tracker in Session.unpack(session.pack(), tuned).feet.values():
            detector = tracker.detector
            assert isinstance(detector, Cycle) and detector.settings.threshold_position == 0.9
            kept = detector.threshold
            assert kept is None or kept == detector._find_threshold()
