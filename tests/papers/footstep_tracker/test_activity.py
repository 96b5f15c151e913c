"""Two-second windows: features, decision tree, pulses of an elevator, hidden Markov model; expected values by hand."""

from math import log, pi

import numpy as np
import pytest
from hypothesis import strategies as st
from views import fed

from solepath.events import ActivityChanged, LiftRidden
from solepath.foot.cues.gait_cues import GaitCues
from solepath.foot.navigate.error_state import ErrorStateFilter
from solepath.foot.stance.cycle import Cycle
from solepath.foot.tracker import FootTracker
from solepath.papers.footstep_tracker.activity import two_second_windows
from solepath.papers.footstep_tracker.activity.two_second_windows import MOVING_ACTIVITIES, TwoSecondWindows
from solepath.papers.footstep_tracker.activity.window_model import FEATURES, Gaussian, WindowModel
from solepath.papers.footstep_tracker.activity.windows import BLOCKS, FootWindows
from solepath.types import SITE_OF_FOOT, Activity, Foot, Sample
from solepath.types.vector import GRAVITY
from solepath.walk.timeline import Timeline

SAMPLE_RATE = 20.0
TRACKERS = {foot: FootTracker(foot, Cycle(), ErrorStateFilter(), GaitCues()) for foot in Foot}
STILL, UP, DOWN = Activity.STANDING, Activity.ELEVATOR_UP, Activity.ELEVATOR_DOWN


def windows(accs, gyros=None, rate=SAMPLE_RATE):
    """Return the windows of one foot."""
    foot = FootWindows()
    for k, acc in enumerate(accs):
        foot.update(k / rate, acc, None if gyros is None else gyros[k])
    return list(foot.ready)


def upright(*a_z):
    return [(0.0, 0.0, GRAVITY + value) for value in a_z]


def test_variance_and_mean_of_a_window_by_hand():
    (first, *_) = windows(upright(*[0.5, -0.5] * 40))
    assert first.mean == pytest.approx(GRAVITY)
    assert first.variance == pytest.approx(0.25)
    assert first.skewness == pytest.approx(0.0, abs=1e-9)
    assert first.across == pytest.approx(0.0, abs=1e-9)


def test_skewness_of_one_peak_in_four_samples_by_hand():
    # 3, -1, -1, -1: mean 0, variance (9 + 3) / 4 = 3, third moment (27 - 3) / 4 = 6
    (first, *_) = windows(upright(*[3.0, -1.0, -1.0, -1.0] * 30), rate=40.0)
    assert first.variance == pytest.approx(3.0)
    assert first.skewness == pytest.approx(6.0 / 3.0**1.5)


def test_what_swings_across_the_axis_is_no_part_of_its_variance():
    (first, *_) = windows([(2.0 * (-1.0) ** k, 0.0, GRAVITY) for k in range(80)])
    assert first.variance == pytest.approx(0.0, abs=1e-9)
    assert first.across == pytest.approx(4.0)


def test_the_gyroscope_counts_by_its_mean_square_and_is_optional():
    still = upright(*[0.0] * 80)
    assert windows(still, [(0.0, 2.0, 1.0)] * 80)[0].turning == pytest.approx(5.0)
    assert windows(still)[0].turning is None
    assert windows(still, [(0.0, 9.0, 9.0)] * 80)[0].turning == pytest.approx((250.0 * pi / 180.0) ** 2)


turns = st.tuples(*[st.floats(-1, 1)] * 4).filter(lambda q: sum(x * x for x in q) > 0.01)


PULSE_ACCELERATION = 0.8
"""Acceleration of an elevator, m/s^2."""


def samples(acc, seconds, feet=tuple(Foot), rate=SAMPLE_RATE, start=0.0):
    """Return samples whose specific force exceeds gravity by `acc(t)` m/s^2, with `t` in s."""
    found = []
    for k in range(round(seconds * rate)):
        t = start + k / rate
        found += [Sample(t=t, site=SITE_OF_FOOT[foot], acc=(0.0, 0.0, GRAVITY + acc(t - start))) for foot in feet]
    return found


def events_of(items, part=None):
    part = TwoSecondWindows() if part is None else part
    return [event for item in items for event in fed(part, TRACKERS[item.site.foot], item, [])]


def timeline(events):
    found = Timeline()
    for event in events:
        if isinstance(event, ActivityChanged):
            found.add(event)
    return found


def ride_acceleration(t, start, end, up=1.0):
    """Return the acceleration, m/s^2, of an elevator that departs at `start` s and stops at `end` s."""
    if start <= t < start + 1.25:
        return up * PULSE_ACCELERATION
    return -up * PULSE_ACCELERATION if end - 1.25 <= t < end else 0.0


@pytest.mark.parametrize(("up", "activity"), [(1.0, UP), (-1.0, DOWN)])
def test_hypergravity_then_weightlessness_is_a_lift_up_and_the_other_order_one_down(up, activity):
    events = events_of(samples(lambda t: ride_acceleration(t, 6.0, 16.0, up), 24.0))
    (arrived,) = [event for event in events if isinstance(event, LiftRidden)]
    assert arrived.up is (up > 0.0) and arrived.height is None
    assert arrived.t_start == pytest.approx(6.0, abs=0.5) and arrived.t == pytest.approx(16.0, abs=0.5)
    found = timeline(events)
    assert [found.at(t) for t in (3.0, 7.0, 11.0, 15.0, 20.0)] == [STILL, activity, activity, activity, STILL]


@pytest.mark.parametrize("up", [True, False])
def test_a_lift_that_sets_off_as_the_recording_begins_goes_where_its_last_pulse_says(up):
    sign = 1.0 if up else -1.0
    events = events_of(samples(lambda t: ride_acceleration(t + 0.2, 0.0, 16.0, sign), 24.0))
    assert [event.up for event in events if isinstance(event, LiftRidden)] == [up]


def width_one_model():
    """Return a model of three states with equal covariances, whose means of the log variance differ by 1."""

    def at(middle):
        width = tuple(tuple(1.0 if k == row else 0.0 for k in range(row + 1)) for row in range(len(FEATURES)))
        return (Gaussian(1.0, (middle, 0.0, GRAVITY, log(1e-6), 0.0), width),)

    transitions = ((0.9, 0.06, 0.04), (0.1, 0.9, 0.0), (0.2, 0.0, 0.8))
    middles = {"walking": at(3.0), "stairs_up": at(4.0), "stairs_down": at(2.0)}
    return WindowModel(trained_on="nothing", moving=1.0, pulse=0.2, transitions=transitions, **middles)


def test_a_gaussian_is_the_density_of_its_covariance():
    factor = np.array([[0.5, 0, 0], [0.2, 0.7, 0], [-0.1, 0.3, 0.4]])
    gaussian = Gaussian(0.5, (1.0, 2.0, 3.0), tuple(tuple(row[: k + 1]) for k, row in enumerate(factor.tolist())))
    x, covariance = np.array([1.3, 1.5, 3.6]), factor @ factor.T
    away = x - np.array(gaussian.mean)
    expected = log(0.5) - 0.5 * away @ np.linalg.inv(covariance) @ away - 0.5 * log(np.linalg.det(covariance))
    assert gaussian.log_density(tuple(x.tolist())) == pytest.approx(expected)


def test_the_forward_filter_by_hand():
    # a_z swings by +-v: its log variance is 2 log v, and each state is off by its own distance. With one foot the
    # likelihoods are exp(-d^2 / 2) to the power of 1/4, for each window is seen four times.
    swing = np.exp(0.5 * 3.6)
    part = TwoSecondWindows(two_second_windows.TwoSecondSettings(width_one_model()))
    items = samples(lambda t: swing * (-1.0) ** round(t * SAMPLE_RATE), 4.55, feet=(Foot.LEFT,))
    # windows end at 2.5, 3.0, 3.5, 4.0 and 4.5 s; the first without any standing is the fourth of a movement
    events_of(items, part)
    likely = np.exp(-0.5 * (3.6 - np.array([3.0, 4.0, 2.0])) ** 2 / BLOCKS)
    belief = likely / likely.sum()
    belief = belief @ np.array(width_one_model().transitions) * likely
    assert part.belief == pytest.approx((belief / belief.sum()).tolist(), rel=1e-6)
    assert part.belief[0] > part.belief[1] and part.activity is Activity.WALKING


def test_the_variance_tree_comes_first():
    # variance 0.81 is below the threshold of 1, 1.21 above it, for any state of the hidden Markov model
    for swing, moves in ((0.9, False), (1.1, True)):
        part = TwoSecondWindows(two_second_windows.TwoSecondSettings(width_one_model()))
        events_of(samples(lambda t, v=swing: v * (-1.0) ** round(t * SAMPLE_RATE), 6.0), part)
        assert (part.activity in MOVING_ACTIVITIES) is moves


numbers = st.floats(-499, 499)
rows = st.tuples(st.floats(0, 3), st.booleans(), st.tuples(numbers, numbers, numbers))
