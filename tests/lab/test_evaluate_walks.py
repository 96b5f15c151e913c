"""Scores of long emulated walks, of tracks whose errors are known by hand, and the form of the walks."""

from math import hypot, pi, remainder

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solepath.emulate.routes.route import Stairs, Stand, TurnAction
from solepath.emulate.wearers.walker import Walker
from solepath.lab.emulated.walks import (
    HALF_HOUR,
    STOREYS,
    four_floors,
    half_hour_walk,
    long_walk,
    mean_position,
    place_figures,
)
from solepath.types import Foot


def straight(bend=0.0, climb=0.0):
    """100 m at 1 m/s; after 50 m it turns by `bend` rad, and it rises evenly by `climb` m."""
    t = np.arange(0.0, 100.5, 0.5)
    beyond = np.maximum(t - 50.0, 0.0)
    return t, np.column_stack([t - beyond * (1.0 - np.cos(bend)), beyond * np.sin(bend), climb * t / 100.0])


def test_a_walk_that_is_only_turned_and_shifted_is_not_off():
    t, truth = straight()
    found = place_figures(t, truth[:, [1, 0, 2]] * [-1.0, 1.0, 1.0] + [3.0, 4.0, 5.0], truth)
    assert_allclose([found[key] for key in ("rms_2d", "position_end", "position_max", "height_max")], 0.0, atol=1e-9)
    assert found["path"] == pytest.approx(100.0)


def test_a_heading_error_counts_over_the_rest_of_the_walk():
    t, truth = straight()
    _, track = straight(bend=0.1, climb=-0.5)
    found = place_figures(t, track, truth)
    chord = 50.0 * 2.0 * np.sin(0.05)
    assert found["position_end"] == found["position_max"] == pytest.approx(chord)
    assert found["end_relative"] == pytest.approx(chord / 100.0)
    assert found["height_end"] == found["height_max"] == pytest.approx(0.5)
    assert found["rms_2d"] < 0.3 * chord


def test_ways_are_as_long_as_they_are_called():
    for seed in (101, 102, 103):
        route = long_walk(seed)
        assert 500.0 <= route.length <= 540.0
        assert sum(isinstance(action, TurnAction) for action in route.actions) >= 10
        stood = sum(action.duration for action in half_hour_walk(seed).actions if isinstance(action, Stand))
        assert 0.9 * HALF_HOUR <= stood + half_hour_walk(seed).length / half_hour_walk(seed).speed <= 1.05 * HALF_HOUR


def test_four_floors_lead_up_and_down_again():
    actions = four_floors(101).actions
    heights = np.cumsum([action.steps * action.rise for action in actions if isinstance(action, Stairs)])
    assert heights.max() == pytest.approx(STOREYS * 3.2) and heights[-1] == pytest.approx(0.0)
    turned = sum(action.angle for action in actions if isinstance(action, TurnAction))
    assert remainder(turned, pi) == pytest.approx(0.0, abs=1e-9)


def test_the_truth_is_the_mean_of_both_feet():
    walker = Walker(four_floors(101), seed=101)
    t = np.array([0.0, 60.0, walker.duration])
    place = mean_position(walker.truth(), t)
    assert_allclose(place[0], 0.0, atol=1e-9)
    feet = [walker.truth().pose(foot, t).position for foot in Foot]
    assert_allclose(place, 0.5 * (feet[0] + feet[1]))
    assert abs(place[-1, 2]) < 1e-9 and hypot(*place[-1, :2]) > 1.0
