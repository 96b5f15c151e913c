"""The scores, on tracks and events whose errors are known by hand."""

from math import cos, pi, sin, sqrt

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numpy.testing import assert_allclose

from solepath.validate.alignment import position_errors, track_error
from solepath.validate.foot_run import FootRun
from solepath.validate.matching import Errors, Matching, interval_errors, match
from solepath_lab.measures.legs import leg_errors, leg_lengths
from solepath_lab.measures.score import Scored, summarise
from solepath_lab.measures.strides import StrideScore, counted_score, stride_score

SQUARE = np.array([[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 2.0, 0.0], [0.0, 2.0, 0.0]])

tracks = arrays(np.float64, (6, 3), elements=st.floats(-50, 50).map(lambda x: round(x, 3)))
yaws = st.floats(-pi, pi)
metres = st.floats(-100, 100)


def turned(track: np.ndarray, yaw: float, x: float, y: float) -> np.ndarray:
    c, s = cos(yaw), sin(yaw)
    return track @ np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]]) + [x, y, 0.0]


@settings(max_examples=30)
@given(track=tracks, truth=tracks, yaw=yaws, x=metres, y=metres)
def test_the_error_does_not_depend_on_the_frame_of_the_track(track, truth, yaw, x, y):
    before, after = track_error(track, truth), track_error(turned(track, yaw, x, y), truth)
    assert after.rms_2d == pytest.approx(before.rms_2d, abs=1e-6)
    assert after.rms_3d == pytest.approx(before.rms_3d, abs=1e-6)


def test_a_square_walked_a_tenth_too_large_is_a_tenth_of_its_half_diagonal_wrong():
    # every corner is 10 % of sqrt(2) m too far from the centre
    error = track_error(SQUARE * 1.1, SQUARE)
    assert error.rms_2d == pytest.approx(0.1 * sqrt(2.0))
    assert error.armse_2d == pytest.approx(0.1)  # pyshoe's: the mean over both axes


def test_a_mirror_image_is_not_forgiven():
    bent = np.array([[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [4.0, 2.0, 0.0]])
    assert track_error(bent * [1.0, -1.0, 1.0], bent).rms_2d > 0.5


def test_height_counts_in_the_3d_error_only_and_its_mean_not_at_all():
    climbing = SQUARE + np.array([[0, 0, 5.0], [0, 0, 5.0], [0, 0, 6.0], [0, 0, 6.0]])
    error = track_error(climbing, SQUARE)
    assert error.rms_2d == pytest.approx(0.0, abs=1e-12)
    assert error.rms_3d == pytest.approx(0.5)


def test_events_within_a_quarter_of_a_second_match_and_give_bias_and_spread():
    matching = match([1.0, 2.0, 3.0, 4.0], [1.0, 2.0625, 3.125, 4.5])
    # 4.5 is outside the labelled time (4.0 + 0.25), so it is neither right nor wrong, but 4.0 is missed
    assert matching == Matching(4, 3, (0.0, 0.0625, 0.125))
    assert matching.f1 == pytest.approx(2 * 3 / 7)
    assert matching.bias == 0.0625
    assert matching.mad == 0.0625


def test_an_event_found_twice_counts_once_and_the_nearer_one_matches():
    matching = match([1.0, 2.0], [1.125, 1.0625, 2.0])
    assert matching == Matching(2, 3, (0.0625, 0.0))


def test_only_labelled_windows_are_judged():
    matching = match([1.0, 2.0, 8.0], [1.0, 2.0, 4.0, 5.0, 8.0], windows=[(1.0, 2.0), (7.5, 8.0)])
    assert matching == Matching(3, 3, (0.0, 0.0, 0.0))


TIMES = np.array([1.0, 2.0, 3.0, 4.0])
PLACES = np.array([[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [2.0, 2.0]])


def test_each_found_stride_belongs_to_the_true_one_in_which_it_ends():
    # 0.9 and 1.1 end before the survey starts (1.0 plus END_TOLERANCE), 4.2 after its end; 1.8 and 2.1 are of the first
    # stride, 3.7 is of the third
    found = [(0.9, 1.0), (1.1, 1.0), (1.8, 0.25), (2.1, 1.125), (3.7, 1.5), (4.2, 1.0)]
    score = stride_score(TIMES, np.array([1.0, 1.0, 2.0]), found)
    assert (score.n_true, score.n_found, score.n_invented) == (3, 2, 1)
    assert score.errors.values == (0.125, -0.25)
    assert score.errors.mean == 0.1875 and score.errors.median == 0.1875


def test_counted_strides_are_compared_in_number_and_the_longest_shows_two_that_were_merged():
    merged_and_invented = counted_score(4, [1.0, 2.5, 1.0, 0.25])
    assert merged_and_invented == StrideScore(4, 4, 0, longest=2.5)
    assert counted_score(4, [1.0, 1.25]) == StrideScore(4, 2, 0, longest=1.25)
    assert counted_score(2, [1.0, 1.5, 1.0]) == StrideScore(2, 2, 1, longest=1.5)
    assert counted_score(2, []) == StrideScore(2, 0, 0)


def test_a_survey_is_aligned_on_its_first_two_metres_only():
    # right for the first two metres, then it goes on straight where the survey turns left
    t = TIMES
    track = turned(np.array([[0.0, 0, 0], [1, 0, 0], [2, 0, 0], [4, 0, 0]]), 1.0, 5.0, -3.0)
    errors = position_errors(TIMES, PLACES, t, track)
    assert errors == pytest.approx([0.0, 0.0, 0.0, sqrt(8.0)], abs=1e-9)


def test_figures_are_averaged_and_events_and_strides_are_pooled():
    scores = [
        Scored(
            "a", {"rms": 1.0}, {"heel_strike": Matching(2, 2, (0.0, 0.0))}, StrideScore(2, 2, 0, Errors((0.1, -0.1)))
        ),
        Scored("b", {"rms": 2.0}, {"heel_strike": Matching(1, 1, (0.25,))}, StrideScore(2, 1, 0, Errors((0.4,)))),
        Scored("c", {"rms": 6.0}, groups=("all", "odd")),
    ]
    summary = summarise(scores, "all")
    assert summary.count == 3
    assert summary.mean == {"rms": 3.0} and summary.median == {"rms": 2.0}
    assert summary.together["heel_strike_f1"] == 1.0 and summary.together["heel_strike_bias"] == 0.0
    assert summary.together["strides_found"] == 3 and summary.together["stride_error"] == pytest.approx(0.2)
    assert summarise(scores, "odd").mean == {"rms": 6.0}


def test_errors_of_stride_times_are_of_events_that_follow_each_other():
    # the third is not found, the last follows after a rest; a shift of all of them is no error
    true, found = [1.0, 2.0, 3.0, 4.0, 5.0, 9.0], [1.1, 2.12, 4.1, 5.05, 9.1]
    assert_allclose(interval_errors(true, found, longest=2.5).values, [0.02, -0.05])
    assert interval_errors([], found, longest=2.5).median is None


def test_a_leg_is_the_distance_between_the_places_of_two_stances():
    t = np.arange(0.0, 24.0, 0.01)
    along = np.interp(t, [2.0, 11.0, 13.0, 21.0], [0.0, 9.0, 9.0, 1.0])
    track = FootRun(t, np.outer(along, [0.8, 0.6, 0.0]))
    assert_allclose(leg_lengths([1.0, 12.0, 22.0], track), [9.0, 8.0], atol=1e-9)
    errors = leg_errors([1.0, 12.0, 22.0], [10.0, 10.0], track)
    assert_allclose(errors.values, [-0.1, -0.2])
    assert (errors.mean, errors.median, errors.bias) == pytest.approx((0.15, 0.15, -0.15))
