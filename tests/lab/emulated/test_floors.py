"""The right floor after each kind of connector, from the sensors to the place, and intervals of what is counted."""

from __future__ import annotations

import pytest
from pytest import approx
from soak import longer

from solepath_lab.emulated.floors import KINDS, FloorScore, score_walk
from solepath_lab.emulated.places import share_interval


@pytest.mark.parametrize(
    "kind", ["turning stairs", "lift", *longer(*sorted(KINDS.keys() - {"turning stairs", "lift"}))]
)
def test_a_walk_over_a_connector_ends_on_the_right_floor_with_a_start_and_is_found_without_one(kind: str) -> None:
    _, score = score_walk("default", (kind, 1))
    assert score == FloorScore(walks=1, right=1, decided=score.decided, wrong=0, found=1)


@pytest.mark.long
@pytest.mark.parametrize("kind", KINDS)
def test_ten_walks_over_a_connector_end_on_the_right_floor(kind: str) -> None:
    scores = [score_walk("default", (kind, seed))[1] for seed in range(201, 211)]
    assert sum([one.right for one in scores]) == 10 and sum([one.wrong for one in scores]) == 0
    assert sum([one.found for one in scores]) == 10


def test_the_interval_of_a_share_is_within_nothing_and_all() -> None:
    assert share_interval(9, 10) == approx(
        (0.596, 0.982), abs=0.001
    )  # by an own calculation from Wilson's (1927) formula
    low, high = share_interval(100, 100)
    assert low == approx(0.963, abs=0.001) and high == approx(1.0)
