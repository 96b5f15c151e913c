"""The score of a place: the reported one may be a mirror image, so the candidate nearest to the truth is scored too."""

from __future__ import annotations

import pytest

from solepath import Turn
from solepath.emulate.wearers.walker import Walker
from solepath.events import Candidate, Event, Placed, TurnMade
from solepath.validate.place import score
from solepath_lab.emulated.buildings import corridor

FAR, NEAR = 30.0, 0.5
"""Distances of the heavier and the lighter candidate from the wearer, m."""


def test_the_nearest_candidate_is_scored_beside_the_place_that_is_reported() -> None:
    way = corridor()
    walker = Walker(way.route, seed=1)
    events: list[Event] = []
    for t in (10.0, 12.0, 20.0, 30.0):
        ((level, x, y),) = way.places(walker, t)
        places = [(x + FAR, y, 0.0), (x + NEAR, y, 0.0)]
        candidates = tuple(
            Candidate(level, place, None, weight, "start") for place, weight in zip(places, (0.6, 0.4), strict=True)
        )
        events.append(
            Placed(t=t, known_at=t, level=level, position=places[0], room=None, spread=1.0, candidates=candidates)
        )
    turns = [TurnMade(t=t, known_at=t, t_start=t - 1.0, angle=1.6, turn=Turn.LEFT) for t in (13.0, 15.0)]
    scored = score(way, walker, walker.truth(), events + turns)
    assert scored.off == pytest.approx((FAR, FAR)), "only those after the second turn count"
    assert scored.nearest == pytest.approx((NEAR, NEAR))
    assert scored.dropped == 0
