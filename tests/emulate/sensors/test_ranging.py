"""The emulated sensor of the distance between the feet."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from solepath import Foot, Site
from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.ranging import RangeErrors, measure_ranges
from solepath.emulate.wearers.walker import Walker

EXACT = RangeErrors("exact", noise=0.0, bias=0.0, blocked=0.0)


@cache
def walker() -> Walker:
    return Walker(Route().stand(2.0).walk(20.0, 1.3).stop(1.0), seed=4)


def distances(t: list[float]) -> np.ndarray:
    left, right = (walker().kinematics(foot, np.array(t)).position for foot in Foot)
    return np.linalg.norm(left - right, axis=1)


def test_an_exact_range_is_the_distance_of_the_sensors() -> None:
    found = measure_ranges(walker(), EXACT, foot=Foot.LEFT)
    assert len(found) > 0.9 * 50.0 * walker().duration
    assert {one.site for one in found} == {Site.LEFT_FOOT}
    assert [one.range for one in found] == pytest.approx(distances([one.t for one in found]).tolist())


def test_noise_and_bias_are_as_large_as_they_should_be() -> None:
    errors = RangeErrors("noisy", noise=0.02, bias=0.05, rate=200.0, blocked=0.0)
    found = measure_ranges(walker(), errors)
    error = np.array([one.range for one in found]) - distances([one.t for one in found])
    assert np.std(error) == pytest.approx(0.02, rel=0.1)
    assert 0.0 < abs(np.mean(error)) < 0.2


def test_a_foot_far_in_front_is_outside_the_cone() -> None:
    seen = measure_ranges(walker(), RangeErrors("narrow", noise=0.0, bias=0.0, cone=1.0, blocked=0.0))
    farthest = max(one.range for one in seen if one.range is not None)
    assert farthest < 0.45 < max(distances([0.01 * k for k in range(1500)]))


def test_something_is_in_the_way_for_its_share_of_the_time() -> None:
    free, blocked = (
        len(measure_ranges(walker(), RangeErrors("", 0.0, 0.0, rate=400.0, blocked=share, blocked_time=0.05)))
        for share in (0.0, 0.3)
    )
    assert blocked / free == pytest.approx(0.7, abs=0.08)
