"""Claims of docs/accuracy.md on places on a plan: walks through the emulator's building, from sensor to place."""

from __future__ import annotations

from statistics import median

import pytest

from solepath import Foot, Session, recipes
from solepath.emulate.routes.building import BUILDING
from solepath.emulate.routes.ways import wandering
from solepath.emulate.sensors.insole_device import Insole
from solepath.emulate.sensors.sensortags import CC2541
from solepath.emulate.walk import emulate
from solepath.emulate.wearers.shoe import IN_SOLE
from solepath.floorplan.index import IndexedPlan
from solepath.lab.emulated import place as emulated_place
from solepath.lab.emulated.place import PlaceScore
from solepath.types import SITE_OF_FOOT

PLAN = IndexedPlan(BUILDING)


def score_walk(recipe: str, seed: int) -> PlaceScore:
    """Return the score of SensorTags at 20 Hz for the recipe made for them, else of small insoles at 100 Hz."""
    planned_walk = wandering(seed)
    tag = CC2541(rate=20.0, mounting=IN_SOLE)
    devices = {SITE_OF_FOOT[foot]: tag if recipe == "footstep-tracker" else Insole(cells=8) for foot in Foot}
    walk = emulate(planned_walk.route, devices=devices, seed=seed)
    session = Session(recipes.by_name(recipe), floorplan=PLAN)
    return emulated_place.score(planned_walk, walk.walker, walk.truth, session.feed(walk.packets) + session.finish())


@pytest.mark.soak
@pytest.mark.parametrize(("recipe", "walks", "most"), [("footstep-tracker", 50, 4), ("default", 25, 0)])
def test_walks_through_the_building_keep_the_true_candidate(recipe: str, walks: int, most: int) -> None:
    """Aim at no true candidate dropped by either recipe.

    Stairs that are taken for the other direction make some of footstep-tracker's walks end on the wrong one of two
    floors that are alike.
    """
    scores = [score_walk(recipe, seed) for seed in range(1, walks + 1)]
    distances = [sum(score.off) / len(score.off) for score in scores if score.off]
    for seed, score in enumerate(scores, 1):
        print(seed, score.strides, score.decided, score.dropped, score.wrong, sum(score.off) / max(1, len(score.off)))
    dropped = sum(score.dropped > 0 for score in scores)
    near = sum(one <= 1.0 for one in distances)
    print(
        f"{recipe}: {dropped} of {walks} dropped; from the second turn on {median(distances):.2f} m in the median walk,"
    )
    print(f"{sum(distances) / len(distances):.2f} m on average, at most 1 m in {near}")
    assert sum(score.strides > 0 for score in scores) == walks
    assert median(distances) <= 1.0 and near >= 0.75 * walks
    assert dropped <= most
