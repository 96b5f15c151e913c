"""Straight ways show the drift of the heading, other ways do not, and the covariance says how sure the place is."""

from __future__ import annotations

from collections.abc import Callable
from math import atan2, cos, hypot, pi, radians, sin

import numpy as np
import pytest

from solepath.body.fuse.common_error import DRIFT, DRIFT_CHANGE, HEADING_NOISE, NO_MOVE, TURNING, CommonError
from solepath.body.fuse.position_covariance import LENGTH_ERROR, position_covariance
from solepath.body.fuse.straightness import Straightness
from solepath.calibration import HeadingCalibration
from solepath.emulate.routes.wander import Wander
from solepath.foot.navigate.bias import Bias
from solepath.saving import codec as machine
from solepath.types import Foot

STEP = 0.65
"""Advance of the body from the stride of one foot to that of the other, m."""
STEP_TIME = 0.5


class Walked:
    """A wearer on a way, with both feet's strides as a gyroscope that drifts has them.

    `heading(s)` is the direction of the way after s m; the wearer wanders about it by 5 cm."""

    def __init__(self, heading: Callable[[float], float], length: float, drift: float, seed: int = 1) -> None:
        rng = np.random.default_rng(seed)
        wander = Wander.drawn(length + 10.0, 0.05, rng)
        self.error, self.straightness, self.found = CommonError(), Straightness(), 0
        self.off, self.turned = 0.0, 0.0
        """Heading error of the track, rad, and turn of the way so far, rad."""
        place = true_place = np.zeros(2)
        self.error.share(0, alone=False)
        for k in range(int(length / STEP)):
            s = k * STEP
            turn = heading(s + 2.0 * STEP) - heading(s)
            aside = wander.at(s + 2.0 * STEP)[0] - wander.at(s)[0] + 0.01 * float(rng.standard_normal())
            direction = heading(s + STEP)
            step = np.array([2.0 * STEP, aside])
            self.off += 0.5 * (drift - self.error.turn_of(1.0, turn, 2.0 * STEP_TIME))
            c, q = cos(direction - self.off), sin(direction - self.off)
            moved = (c * step[0] - q * step[1], q * step[0] + c * step[1])
            self.error.propagate(0.5, 1.0, turn, 2.0 * STEP_TIME, moved, (1e-4, 0.0, 1e-4))
            sigma = self.error.drift_variance(2.0 * STEP_TIME) ** 0.5
            one = self.straightness.add_stride(STEP_TIME * k, moved, 0.5, 1.0, turn, sigma)
            place = place + 0.5 * np.array(moved)
            true_place = true_place + 0.5 * np.array(
                [
                    cos(direction) * step[0] - sin(direction) * step[1],
                    sin(direction) * step[0] + cos(direction) * step[1],
                ]
            )
            if one is not None:
                self.found += 1
                dx, dy, yaw = self.error.correct_drift(one.drift, one.variance, one.weight, one.stride_time)
                place = place + (dx, dy)
                self.off -= yaw
        self.place, self.true_place = place, true_place


def corridors(length: float, angle: float) -> Callable[[float], float]:
    """Straights of `length` m, between them bends of 2 m by `angle` rad, in turn to the left and to the right."""

    def heading(s: float) -> float:
        number, along = divmod(s, length + 2.0)
        done = angle if int(number) % 2 else 0.0
        return done + (1.0 if int(number) % 2 == 0 else -1.0) * angle * min(1.0, max(0.0, along - length) / 2.0)

    return heading


def bends(radius: float) -> Callable[[float], float]:
    return lambda s: s / radius


def weaves(radius: float, arc: float) -> Callable[[float], float]:
    """Arcs of `arc` m, in turn to the left and to the right."""
    return lambda s: (min(s % (2.0 * arc), 2.0 * arc - s % (2.0 * arc)) - 0.5 * arc) / radius


@pytest.mark.parametrize("drift", [-0.002, -0.0007, 0.0007, 0.002])
def test_corridors_show_the_drift(drift: float) -> None:
    errors = [Walked(corridors(25.0, 1.0), 500.0, drift, seed).error for seed in range(6)]
    assert all(abs(one.drift - drift) < 4.0 * one.rr**0.5 for one in errors)
    assert np.mean([abs(one.drift - drift) for one in errors]) < 2.5e-4
    assert all(one.rr**0.5 < 0.4 * DRIFT for one in errors), "and the filter knows that it has learnt"


@pytest.mark.parametrize("radius", [-150.0, -60.0, 15.0, 40.0, 100.0])
def test_a_ring_is_not_straightened(radius: float) -> None:
    """Ten times round a ring of 40 m radius, and as far in others; the drift may be learnt by 3 % of the bend."""
    for seed in range(3):
        error = Walked(bends(radius), 2500.0, 0.0, seed).error
        assert abs(error.drift) < 0.03 * 2.0 * STEP / abs(radius)


@pytest.mark.parametrize(("radius", "arc"), [(60.0, 15.0), (100.0, 30.0), (150.0, 40.0)])
def test_a_slow_weave_is_not_straightened(radius: float, arc: float) -> None:
    drifts = [Walked(weaves(radius, arc), 1000.0, 0.0, seed).error.drift for seed in range(6)]
    assert np.mean(np.abs(drifts)) < 2.5e-4
    assert abs(np.mean(drifts)) < 2.0e-4


def test_a_straight_walk_without_drift_keeps_its_direction() -> None:
    walked = [Walked(lambda s: 0.0, 300.0, 0.0, seed) for seed in range(6)]
    assert all(one.found > 2 for one in walked)
    assert np.mean([abs(one.error.drift) for one in walked]) < 1.5e-4
    assert all(abs(one.off) < radians(5.0) for one in walked)


def test_what_a_way_has_shown_turns_the_track_back() -> None:
    for seed in range(4):
        learnt, ignored = (Walked(corridors(30.0, 1.0), 600.0, 0.0015, seed) for _ in range(2))
        assert abs(learnt.off) < radians(12.0) < 0.5 * 0.0015 * 600.0 / STEP
        assert hypot(*(learnt.place - learnt.true_place)) < 0.06 * 600.0 < 0.2 * 0.0015 * 600.0 / STEP * 300.0
        assert machine.load(CommonError, machine.save(ignored.error)) == learnt.error
        assert machine.load(Straightness, machine.save(ignored.straightness)) == learnt.straightness


def matrix(error: CommonError) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    """Covariance of x, y, heading, drift, turning and bias."""
    names = "xyhrkb"
    return np.array(
        [[getattr(error, min(a + b, b + a, key=lambda n: (names.index(n[0]), n))) for b in names] for a in names]
    )


def test_the_covariance_is_that_of_the_equations() -> None:
    error, rng = CommonError(), np.random.default_rng(3)
    error.bb = 1e-7
    expected = matrix(error)
    direction = 0.0
    for k in range(60):
        turn = float(rng.normal(0.0, 0.3))
        direction += turn
        dx, dy, share, n = cos(direction), sin(direction), (0.5, 1.0)[k % 2], 0.9
        error.propagate(share, n, turn, 1.1, (dx, dy), (2e-4, 1e-5, 1e-4))
        one = np.eye(6)
        one[2, 3:] = share * n, share * turn, share * 1.1
        middle = np.array([1.0, 0.5 * share * n, 0.5 * share * turn, 0.5 * share * 1.1])
        one[0, 2:], one[1, 2:] = -share * dy * middle, share * dx * middle
        expected = one @ expected @ one.T
        expected[:2, :2] += share * share * np.array([[2e-4, 1e-5], [1e-5, 1e-4]])
        expected[2, 2] += share * 1.1 * HEADING_NOISE**2
        expected[3, 3] += share * 1.1 * DRIFT_CHANGE**2
        assert np.allclose(matrix(error), expected, rtol=1e-9, atol=1e-15)
        if k % 20 == 10:
            measured = np.array([0.0, 0.0, 0.0, 1.0, 0.0, 1.2])
            gain = expected @ measured / (measured @ expected @ measured + 1e-7)
            error.correct_drift(1e-4, 1e-7, 1.0, 1.2)
            expected -= np.outer(gain, measured @ expected)
            assert np.allclose(matrix(error), expected, rtol=1e-9, atol=1e-15)


def known_bias(variance: float, t: float, change: float = 0.0) -> Bias:
    """Return what a rest that ended at `t`, s, has shown; `variance` is in (rad/s)^2, `change` in rad/s."""
    return Bias((0.0, 0.0, change), (variance, variance), t, change)


def test_a_bias_that_is_learnt_again_has_a_new_error() -> None:
    """Of a foot alone, whose rest teaches everything, and of one of two feet, whose other foot has learnt nothing."""
    for alone, left in ((True, 0.0), (False, 0.5)):
        error = CommonError()
        error.share(0, alone)
        for foot in range(1 if alone else 2):
            error.add_rest(foot, 0.0, known_bias(4e-6, -1.0))
        assert error.bb == pytest.approx(4e-6 if alone else 2e-6)
        for k in range(100):
            error.propagate(1.0 if alone else 0.5, 1.0, 0.0, 1.0, (1.3, 0.0), (1e-4, 0.0, 1e-4))
            assert error.add_rest(0, 0.01 * k, known_bias(4e-6, -1.0)) == NO_MOVE
        with_heading, heading = error.hb, error.hh
        assert with_heading > 0.0
        error.add_rest(0, 1.0, known_bias(1e-12, 1.0))
        assert error.hb == pytest.approx(left * with_heading, rel=0.01, abs=1e-8)
        assert error.bb == pytest.approx(left * left * 4e-6, rel=0.01, abs=1e-9)
        assert error.hh < heading, "the rest shows what the bias has turned"
        assert min(np.linalg.eigvalsh(matrix(error))) > -1e-12


@pytest.mark.parametrize("alone", [True, False])
def test_a_rest_after_a_walk_turns_the_track_back_by_what_its_bias_has_turned(alone: bool) -> None:
    """100 strides straight on with a bias of 1 mrad/s too much, which a long rest shows; of two feet, on both."""
    error, t, off = CommonError(), 0.0, -1e-3
    error.drift_variances, error.rr, error.kk = (0.0, 0.0), 0.0, 0.0
    error.share(0, alone)
    feet = (0,) if alone else (0, 1)
    for foot in feet:
        error.add_rest(foot, 0.0, known_bias(1e-6, 0.0))
    for k in range(100):
        t += 1.1
        error.propagate(1.0 if alone else 0.5, 1.0, 0.0, 1.1, (1.3, 0.0), (1e-4, 0.0, 1e-4))
        error.add_rest(feet[k % len(feet)], t, known_bias(1e-6, 0.0))
    turned = 110.0 * off * (1.0 if alone else 0.5)
    # the bias was too large by 1 mrad/s, the track turned too far to the right
    moves = [error.add_rest(foot, t, known_bias(1e-10, t, off)) for foot in feet]
    x, y, heading = (sum(move[axis] for move in moves) for axis in range(3))
    assert heading == pytest.approx(-turned, rel=0.1)
    assert y == pytest.approx(-turned * 0.5 * (130.0 if alone else 65.0), rel=0.1)
    assert error.bias == pytest.approx(0.0, abs=2e-5), "the feet have removed it"
    assert error.heading_sigma < 0.25 * (110.0 * 1e-3)


def test_a_bias_that_is_another_one_turns_nothing_back() -> None:
    """A jump of 0.3 degrees/s, of which nobody knows when it happened."""
    error = CommonError()
    error.share(0, alone=True)
    error.add_rest(0, 0.0, known_bias(1e-7, 0.0))
    for _ in range(50):
        error.propagate(1.0, 1.0, 0.0, 1.1, (1.3, 0.0), (1e-4, 0.0, 1e-4))
    before = error.hh
    assert error.add_rest(0, 55.0, known_bias(9e-8, 55.0, 0.005)) == NO_MOVE
    assert error.hh == before


def test_a_foot_that_stands_for_an_hour_is_turned_by_no_bias_that_it_has_learnt_since() -> None:
    error = CommonError()
    error.share(0, alone=True)
    error.add_rest(0, 0.0, known_bias(4e-6, 0.0))
    error.bias = 1e-3
    error.add_rest(0, 3600.0, known_bias(1e-10, 3600.0))
    assert abs(error.bias) < 1e-5


def test_a_foot_without_calibration_makes_two_feet_as_unsure_as_it_is() -> None:
    known = HeadingCalibration(0.0, 0.0, 1e-4, 1e-4)
    sigmas = []
    for feet in ((), (Foot.LEFT,), (Foot.LEFT, Foot.RIGHT)):
        error = CommonError()
        error.use_calibration(dict.fromkeys(feet, known))
        sigmas.append(error.rr**0.5)
    assert sigmas == pytest.approx([DRIFT / 2.0**0.5, (DRIFT**2 + 1e-8) ** 0.5 / 2.0, 1e-4 / 2.0**0.5])
    for foot, sigma in ((0, 1e-4), (1, DRIFT)):
        error = CommonError()
        error.use_calibration({Foot.LEFT: known})
        error.share(foot, alone=True)
        assert error.rr**0.5 >= sigma


@pytest.mark.parametrize("sigma", [0.05, 0.5, 1.0, 2.0, 4.0])
def test_a_heading_that_is_far_off_leaves_the_place_on_a_circle_about_where_it_turned(sigma: float) -> None:
    """The covariance of a place 30 m from where the heading went astray is that of drawn headings, of any size."""
    arm, rng = np.array([18.0, -24.0]), np.random.default_rng(1)
    error = CommonError()
    error.hh, variance = sigma * sigma, sigma * sigma
    b = np.array([-arm[1], arm[0]])
    error.xh, error.yh = variance * b[0], variance * b[1]
    error.xx, error.xy, error.yy = variance * b[0] ** 2 + 0.5, variance * b[0] * b[1], variance * b[1] ** 2 + 0.25
    xx, xy, yy = position_covariance(error, (0.0, 0.0))
    headings = sigma * rng.standard_normal(200_000)
    off = np.stack([(np.cos(headings) - 1.0) * arm[i] + np.sin(headings) * b[i] for i in range(2)])
    drawn = off @ off.T / len(headings) + np.diag([0.5, 0.25])
    assert np.allclose([[xx, xy], [xy, yy]], drawn, rtol=0.02, atol=0.02 * np.trace(drawn))


def test_strides_that_are_all_too_long_leave_the_place_uncertain_along_the_way() -> None:
    error = CommonError()
    error.xx = error.yy = 0.01
    xx, xy, yy = position_covariance(error, (30.0, 40.0))
    assert atan2(xy, xx - 0.01) == pytest.approx(atan2(40.0, 30.0))
    assert xx + yy == pytest.approx(0.02 + (50.0 * LENGTH_ERROR) ** 2)


def test_a_gap_and_a_turn_make_the_heading_less_sure() -> None:
    error = CommonError()
    error.share(0, alone=False)
    before = error.hh
    error.add_gap(0.1)
    short = error.hh - before
    error.add_gap(3.0)
    assert 0.0 < short < error.hh - short
    straight_on, round_about = CommonError(), CommonError()
    for one, turn in ((straight_on, 0.0), (round_about, 2.0 * pi)):
        one.propagate(0.5, 1.0, turn, 1.0, (1.3, 0.0), (1e-4, 0.0, 1e-4))
    assert round_about.hh - straight_on.hh == pytest.approx(0.5 * (pi * TURNING) ** 2)
