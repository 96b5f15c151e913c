"""The score of a place: the reported one may be a mirror image, so the candidate nearest to the truth is scored too."""

from __future__ import annotations

import pytest

from solepath import Turn
from solepath.emulate.wearers.walker import Walker
from solepath.events import Candidate, Event, Placed, TurnMade
from solepath.validate.place import PlaceScore, score
from solepath_lab.emulated.buildings import corridor

FAR, NEAR = 30.0, 0.5
"""Distances of the heavier and the lighter candidate from the wearer, m."""


def scored(weight: float, offsets: tuple[float, float]) -> PlaceScore:
    """Return the score of places with two candidates so far from the wearer, m, of which the first has this weight."""
    way = corridor()
    walker = Walker(way.route, seed=1)
    events: list[Event] = []
    for t in (10.0, 12.0, 20.0, 30.0):
        ((level, x, y),) = way.places(walker, t)
        places = [(x + offset, y, 0.0) for offset in offsets]
        weights = (weight, 1.0 - weight)
        candidates = tuple(map(Candidate, [level] * 2, places, [None] * 2, weights, ["start"] * 2))
        events.append(Placed(t=t, known_at=t, level=level, position=places[0], spread=1.0, candidates=candidates))
    turns = [TurnMade(t=t, known_at=t, t_start=t - 1.0, angle=1.6, turn=Turn.LEFT) for t in (13.0, 15.0)]
    return score(way, walker, walker.truth(), events + turns)


def test_the_nearest_candidate_is_scored_beside_the_place_that_is_reported() -> None:
    found = scored(0.6, (FAR, NEAR))
    assert found.off == pytest.approx((FAR, FAR)), "only those after the second turn count"
    assert found.nearest == pytest.approx((NEAR, NEAR))
    assert found.dropped == 0


@pytest.mark.parametrize("weight", [0.6, 0.99, 0.997])
def test_a_place_is_scored_as_decided_by_the_weight_by_which_it_is_reported_as_decided(weight: float) -> None:
    is_decided = weight > 0.995
    assert scored(weight, (NEAR, FAR)).decided == (1 if is_decided else None)
    assert scored(weight, (NEAR, FAR)).wrong == 0
    assert scored(weight, (FAR, NEAR)).wrong == 4 * is_decided
