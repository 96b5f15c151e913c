"""Scores of long emulated walks, of tracks whose errors are known by hand, and the form of the walks."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solepath.emulate.routes.route import Route
from solepath.emulate.wearers.walker import Walker
from solepath.types import Foot
from solepath_lab.emulated.heading import HeadingTrack, heading_figures
from solepath_lab.emulated.walks import place_figures
from solepath_lab.measures.drift import drift_figures, drift_of_strides, drift_that_opens


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


def turned_track(walker, angle, start=(0.0, 0.0), covariance=(1.0, 0.0, 1.0)):
    """The true track, turned by `angle` rad about the start from the second stride on, and the truth."""
    truth = walker.truth()
    t = np.arange(10.0, walker.duration, 1.0)
    middle = 0.5 * sum(truth.pose(foot, t).position[:, :2] for foot in Foot)
    middle = middle - 0.5 * sum(truth.pose(foot, np.zeros(1)).position[:, :2] for foot in Foot)
    c, s = np.cos(angle), np.sin(angle)
    places = middle @ np.array([[c, s], [-s, c]]) + np.array(start)
    headings = [0.0, *[-angle] * (len(t) - 1)]
    rows = [(x, y) for x, y in places.tolist()]
    return HeadingTrack(t.tolist(), rows, [covariance] * len(t), headings, [0.1] * len(t)), truth


def test_a_heading_error_moves_the_end_and_is_weighed_by_the_covariance():
    walker = Walker(Route().stand(2.0).walk(120.0, 1.3).stop(2.0), seed=1)
    track, truth = turned_track(walker, 0.1, covariance=(25.0, 0.0, 36.0))
    found = heading_figures(track, truth)
    assert found["heading_end"] == pytest.approx(0.1)
    assert found["position_end"] == pytest.approx(2.0 * 120.0 * np.sin(0.05), rel=0.02)
    assert found["end_relative"] == pytest.approx(found["position_end"] / found["path"])
    assert found["heading_nees_60"] == pytest.approx(1.0)
    x = 1.3 * 57.5
    assert found["nees_60"] == pytest.approx(0.5 * ((x * 0.1) ** 2 / 36.0), rel=0.1)
    assert found["held_60"] == 1.0
    sure = heading_figures(turned_track(walker, 0.1, covariance=(0.5, 0.0, 0.5))[0], truth)
    assert sure["held_60"] == 0.0 and sure["nees_60"] > 30.0


@pytest.mark.parametrize("drift", [-0.002, 0.0, 0.001])
def test_a_drift_is_found_from_surveyed_strides_and_from_a_loop_that_stays_open(drift):
    t = np.arange(0.0, 120.0, 1.1)
    way = 2.0 * np.pi * t / t[-1]
    truth = np.column_stack([12.0 * np.sin(way), 5.0 * (1.0 - np.cos(way))])
    steps = np.diff(truth, axis=0) @ np.array([1.0, 1.0j]) * np.exp(1j * drift * 0.5 * (t[1:] + t[:-1]))
    places = np.concatenate([[0.0], np.cumsum(steps)])
    track = np.column_stack([places.real, places.imag, 0.0 * t])
    assert drift_of_strides(t, track, truth) == pytest.approx(drift, abs=1e-9)
    assert drift_that_opens(t, track) == pytest.approx(drift, rel=0.1, abs=1e-9), "linear in the drift"
    assert drift_figures(drift, t)["drift_stride"] == pytest.approx(abs(drift) * float(np.mean(np.diff(t))))
    assert drift_of_strides(t[:30], track[:30], truth[:30]) is None, "too short to tell"
