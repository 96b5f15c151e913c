"""A rest shows by which rate the strides before it have turned the track, unless the bias has changed meanwhile."""

from __future__ import annotations

from math import hypot, pi

import numpy as np
import pytest

from solepath.body.fuse.both_feet import BothFeet
from solepath.body.fuse.common_error import DRIFT, FEET, NO_MOVE, TURNING, CommonError
from solepath.body.fuse.learnt_bias import add_rest, has_rested
from solepath.calibration import HeadingCalibration
from solepath.emulate.routes.route import Route
from solepath.emulate.walk import sampled
from solepath.foot.navigate.bias import FIRST_BIAS, Bias
from solepath.lab.emulated.heading_walks import insoles_of, wearer_of
from solepath.session import Session
from solepath.types import Foot, Site

ON = (1.3, 0.0)
"""A stride straight on, m."""
SURE = (1e-4, 0.0, 1e-4)


def bias_of(variance: float, spans: int, change: float = 0.0, device: int = 0) -> Bias:
    """Return what `spans` spans of rest have shown; `variance` is in (rad/s)^2, `change` in rad/s."""
    return Bias((0.0, 0.0, change), (variance, variance), 0.0, change, spans, device)


def error_of(*feet: int) -> CommonError:
    """Return the error of feet that have no drift, or of a foot alone, at its first stride, with a bias of 1 mrad/s."""
    error = CommonError()
    for row in FEET:
        error.covariance[row][row] = error.covariance[row + 1][row + 1] = 0.0
    for foot in feet:
        error.start_stride(foot, len(feet) == 1)
        assert add_rest(error, foot, 0.0, bias_of(1e-6, 4)) == NO_MOVE
    return error


def walk(error: CommonError, strides: int, *feet: int) -> float:
    """Walk on; return the duration, s."""
    for k in range(strides):
        foot = feet[k % len(feet)]
        error.start_stride(foot, len(feet) == 1)
        error.propagate(foot, 1.0, 0.0, 1.1, ON, SURE)
        assert add_rest(error, foot, 0.0, bias_of(1e-6, 4)) == NO_MOVE
    return 1.1 * strides


def is_covariance(error: CommonError) -> bool:
    p = np.array(error.covariance)
    scale = np.sqrt(np.maximum(np.diag(p), 1e-30))
    return bool(np.array_equal(p, p.T) and min(np.linalg.eigvalsh(p / np.outer(scale, scale))) > -1e-7)


@pytest.mark.parametrize("feet", [(0,), (1,), (0, 1)])
def test_a_rest_after_a_walk_turns_the_track_back_by_what_its_bias_has_turned(feet: tuple[int, ...]) -> None:
    """100 strides straight on with a bias that is too large by 1 mrad/s, which a long rest of both feet shows."""
    error = error_of(*feet)
    t = walk(error, 100, *feet)
    turned, length = 1e-3 * t / len(feet), 130.0 / len(feet)
    moves = [add_rest(error, foot, 0.0, bias_of(1e-10, 5, -1e-3)) for foot in feet]
    y, heading = (sum(move[axis] for move in moves) for axis in (1, 2))
    assert heading == pytest.approx(turned, rel=0.05)
    assert y == pytest.approx(0.5 * turned * length, rel=0.1)
    assert error.bias == pytest.approx([0.0, 0.0], abs=2e-5), "the feet have removed it"
    assert error.heading_sigma < 0.3 * turned and is_covariance(error)


def test_a_rest_of_a_foot_that_has_not_walked_turns_nothing_back() -> None:
    error = error_of(0, 1)
    walk(error, 100, 0)
    assert add_rest(error, 1, 110.0, bias_of(1e-10, 5, 1e-3)) == pytest.approx(NO_MOVE, abs=1e-9)


@pytest.mark.parametrize("change", [0.005, 0.035])
def test_a_bias_that_has_changed_leaves_the_heading_unsure_and_turns_nothing(change: float) -> None:
    """A jump of 0.3 or 2 degrees/s, of which nobody knows when it happened."""
    error = CommonError()
    error.start_stride(0, alone=True)
    add_rest(error, 0, 0.0, bias_of(1e-7, 4))
    for k in range(50):
        error.propagate(0, 1.0, 0.0, 1.1, ON, SURE)
        add_rest(error, 0, 1.1 * k, bias_of(1e-7, 4))
    before = error.heading_sigma
    assert add_rest(error, 0, 55.0, bias_of(9e-8, 8, change)) == NO_MOVE
    assert error.turn_of(0, 0.0, 0.0, 1.0) == 0.0, "the foot has removed the new bias itself"
    assert error.heading_sigma > max(before, min(1.9, 0.5 * change * 55.0)) and is_covariance(error)


def test_a_rest_that_is_too_restless_to_show_anything_changes_nothing() -> None:
    error = error_of(0, 1)
    walk(error, 40, 0, 1)
    before = [list(row) for row in error.covariance]
    assert add_rest(error, 0, 44.0, bias_of(1.1e-6, 5, 2e-5)) == NO_MOVE
    after = [list(row) for row in error.covariance]
    after[FEET[0] + 2][FEET[0] + 2] = before[FEET[0] + 2][FEET[0] + 2]  # it wanders
    assert after == before and error.bias[0] == 2e-5, "the foot has removed so much more"


def test_a_first_rest_amid_the_walk_shows_a_bias_that_is_larger_than_usual() -> None:
    """20 strides with 2.3 degrees/s, and no rest before them."""
    error = CommonError()
    error.start_stride(0, alone=True)
    add_rest(error, 0, 0.0, bias_of(FIRST_BIAS**2, 0))
    for k in range(20):
        error.propagate(0, 1.0, 0.0, 1.1, ON, SURE)
        add_rest(error, 0, 1.1 * k, bias_of(FIRST_BIAS**2, 0))
    _, _, heading = add_rest(error, 0, 22.0, bias_of(1e-7, 8, 0.04))
    assert heading == pytest.approx(-0.04 * 22.0, rel=0.1)
    assert is_covariance(error)


def test_a_clock_that_restarts_and_a_rest_before_the_first_stride_are_no_measurements() -> None:
    error = error_of(0, 1)
    walk(error, 40, 0, 1)
    before = [list(row) for row in error.covariance]
    restarted = Bias((0.0, 0.0, 0.0), (1e-6, 1e-6), None, 0.0, 4)
    assert not has_rested(error, 0, restarted)
    assert add_rest(error, 0, 0.0, restarted) == NO_MOVE and error.covariance == before


def test_another_device_has_another_bias_and_another_drift() -> None:
    """Which may be the same: it is kept, but it is no surer than that of any device."""
    error = error_of(0, 1)
    walk(error, 40, 0, 1)
    error.bias[0], error.drift[0] = 1e-3, 2e-3
    assert add_rest(error, 0, 0.0, bias_of(FIRST_BIAS**2, 0, device=1)) == NO_MOVE
    assert has_rested(error, 0, bias_of(FIRST_BIAS**2, 0, device=2))
    p, row = error.covariance, FEET[0]
    assert error.bias[0] == 0.0 and error.drift[0] == 2e-3
    assert [p[row + k][row + k] for k in range(3)] == [2.0 * DRIFT**2, 2.0 * TURNING**2, FIRST_BIAS**2]
    assert not any(p[row][:row]) and is_covariance(error)


def test_a_device_that_replaced_another_one_before_the_first_stride_is_not_the_calibrated_one_for_certain() -> None:
    error = CommonError()
    error.use_calibration(dict.fromkeys(Foot, HeadingCalibration(0.002, 0.0, 1e-4, 1e-3)))
    for foot, device in enumerate((0, 1)):
        error.start_stride(foot, alone=False)
        add_rest(error, foot, 0.0, bias_of(1e-6, 4, device=device))
    assert [error.covariance[row][row] for row in FEET] == [1e-8, 2.0 * DRIFT**2]


def test_a_session_whose_devices_were_exchanged_knows_their_drift_no_longer() -> None:
    walk = sampled(Route().stand(3.0).walk(60.0, 1.3).stop(3.0), wearer=wearer_of(103), insoles=insoles_of(103), seed=3)
    session = Session()
    (part,) = [part for part in session._state.wearer.parts if isinstance(part, BothFeet)]
    for sample in walk.samples:
        if sample.t >= 30.0 > (session.now or 0.0):
            part.common.covariance[FEET[0]][FEET[0]] = part.common.covariance[FEET[1]][FEET[1]] = 1e-10
            session.bind(Site.LEFT_FOOT, "another")
        session.feed(sample)
    assert part.common.covariance[FEET[0]][FEET[0]] > DRIFT**2 > 1e-9 > part.common.covariance[FEET[1]][FEET[1]]


def test_nobody_knows_where_a_wearer_turned_while_both_clocks_restarted() -> None:
    walk = sampled(Route().stand(3.0).walk(20.0, 1.3).stop(3.0), seed=3)
    session = Session()
    session.feed(walk.samples)
    session.restart_clock(0.0)
    session.feed(walk.samples)
    assert session.position is not None and (session.position.heading_sigma or 0.0) > 1.0


def test_feet_that_come_and_go_and_rest_at_random_keep_a_covariance() -> None:
    rng = np.random.default_rng(5)
    error, spans, variances = CommonError(), [4, 4], [1e-6, 1e-6]
    for k in range(3000):
        foot = int(rng.integers(2))
        error.start_stride(foot, bool(rng.uniform() < 0.3))
        if rng.uniform() < 0.05:
            spans[foot] += 3
            variances[foot] = float(10.0 ** rng.uniform(-8.0, -5.0))
        change = float(rng.normal(0.0, 1e-3))
        add_rest(error, foot, float(k), bias_of(variances[foot], spans[foot], change))
        direction = float(rng.uniform(-3.0, 3.0))
        step = (float(np.cos(direction)), float(np.sin(direction)))
        error.propagate(foot, 1.0, float(rng.normal(0.0, 0.5)), 1.1, step, SURE)
        if k % 50 == 0:
            error.correct_drift(float(rng.normal(0.0, 1e-3)), 1e-6, float(rng.uniform()), 1.1)
            assert is_covariance(error)


def test_a_foot_that_falls_silent_now_and_then_leaves_the_track_and_its_sigma_as_they_were() -> None:
    """For 2 s in every 12 s, between two halts."""
    route = Route().stand(3.0)
    for side in (1.0, 1.0, -1.0):
        route = route.walk(25.0, 1.3).stand(5.0).turn(side * 0.5 * pi, 1.0)
    walk = sampled(route.walk(10.0).stop(3.0), wearer=wearer_of(103), insoles=insoles_of(103), seed=103)
    ends, sigmas = [], []
    for has_gaps in (False, True):
        session = Session()
        for sample in walk.samples:
            if not (has_gaps and sample.site is Site.RIGHT_FOOT and sample.t % 12.0 > 10.0):
                session.feed(sample)
        assert session.position is not None and session.position.heading_sigma is not None
        ends.append(session.position)
        sigmas.append(session.position.heading_sigma)
    (x, y, _), (u, v, _) = (end.position for end in ends)
    assert hypot(x - u, y - v) < 2.5
    assert 0.7 * sigmas[0] < sigmas[1] < 2.0 * sigmas[0]
    assert min(ends[1].covariance[0], ends[1].covariance[3]) > 0.05
