"""Straight ways show the drift of the heading, other ways do not, and the covariance says how sure the place is."""

from __future__ import annotations

from collections.abc import Callable
from math import atan2, cos, hypot, pi, radians, sin

import numpy as np
import pytest

from solepath.body.fuse.common_error import DRIFT, DRIFT_CHANGE, FEET, HEADING_NOISE, TURNING, CommonError
from solepath.body.fuse.position_covariance import LENGTH_ERROR, position_covariance
from solepath.body.fuse.straightness import Straightness
from solepath.calibration import HeadingCalibration
from solepath.emulate.routes.wander import Wander
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
        for row in FEET:  # the bias is known
            self.error.covariance[row + 2][row + 2] = 0.0
        for k in range(int(length / STEP)):
            s = k * STEP
            turn = heading(s + 2.0 * STEP) - heading(s)
            aside = wander.at(s + 2.0 * STEP)[0] - wander.at(s)[0] + 0.01 * float(rng.standard_normal())
            direction = heading(s + STEP)
            step = np.array([2.0 * STEP, aside])
            foot = k % 2
            self.off += 0.5 * (drift - self.error.turn_of(foot, 1.0, turn, 2.0 * STEP_TIME))
            c, q = cos(direction - self.off), sin(direction - self.off)
            moved = (c * step[0] - q * step[1], q * step[0] + c * step[1])
            self.error.propagate(foot, 1.0, turn, 2.0 * STEP_TIME, moved, (1e-4, 0.0, 1e-4))
            sigma = self.error.drift_variance(2.0 * STEP_TIME) ** 0.5
            stretch = self.straightness.add_stride(STEP_TIME * k, moved, 0.5, 1.0, turn)
            one = None if stretch is None else self.straightness.drift_of(stretch, sigma)
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
    off = [abs(one.drift_with_bias(0.0) - drift) for one in errors]
    sigmas = [one.drift_variance(0.0) ** 0.5 for one in errors]
    assert all(error < 4.0 * sigma for error, sigma in zip(off, sigmas, strict=True))
    assert np.mean(off) < 2.5e-4
    assert all(sigma < 0.4 * DRIFT for sigma in sigmas), "and the filter knows that it has learnt"


@pytest.mark.parametrize("radius", [-150.0, -60.0, 15.0, 40.0, 100.0])
def test_a_ring_is_not_straightened(radius: float) -> None:
    """Ten times round a ring of 40 m radius, and as far in others; the drift may be learnt by 3 % of the bend."""
    for seed in range(3):
        error = Walked(bends(radius), 2500.0, 0.0, seed).error
        assert abs(error.drift_with_bias(0.0)) < 0.03 * 2.0 * STEP / abs(radius)


@pytest.mark.parametrize(("radius", "arc"), [(60.0, 15.0), (100.0, 30.0), (150.0, 40.0)])
def test_a_slow_weave_is_not_straightened(radius: float, arc: float) -> None:
    drifts = [Walked(weaves(radius, arc), 1000.0, 0.0, seed).error.drift_with_bias(0.0) for seed in range(6)]
    assert np.mean(np.abs(drifts)) < 2.5e-4
    assert abs(np.mean(drifts)) < 2.0e-4


def test_a_straight_walk_without_drift_keeps_its_direction() -> None:
    walked = [Walked(lambda s: 0.0, 300.0, 0.0, seed) for seed in range(6)]
    assert all(one.found > 2 for one in walked)
    assert np.mean([abs(one.error.drift_with_bias(0.0)) for one in walked]) < 1.5e-4
    assert all(abs(one.off) < radians(5.0) for one in walked)


def test_what_a_way_has_shown_turns_the_track_back() -> None:
    for seed in range(4):
        learnt, ignored = (Walked(corridors(30.0, 1.0), 600.0, 0.0015, seed) for _ in range(2))
        assert abs(learnt.off) < radians(12.0) < 0.5 * 0.0015 * 600.0 / STEP
        assert hypot(*(learnt.place - learnt.true_place)) < 0.06 * 600.0 < 0.2 * 0.0015 * 600.0 / STEP * 300.0
        assert machine.load(CommonError, machine.save(ignored.error)) == learnt.error
        assert machine.load(Straightness, machine.save(ignored.straightness)) == learnt.straightness


def test_feet_whose_clocks_are_apart_make_stretches_too() -> None:
    """By 0.8 s, so that every other stride ends before the one before it."""
    straightness = Straightness()
    for k in range(30):
        straightness.add_stride(0.5 * k + (0.8 if k % 2 else 0.0), (1.3, 0.0), 0.5, 1.0, 0.0)
    stretch = straightness.break_off()
    assert stretch is not None
    one = straightness.drift_of(stretch, DRIFT)
    assert one is not None and abs(one.drift) < 1e-6


def matrix(error: CommonError) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    """Return the covariance as an array, and test that it is one."""
    found = np.array(error.covariance)
    assert np.array_equal(found, found.T)
    scale = np.sqrt(np.maximum(np.diag(found), 1e-30))
    assert min(np.linalg.eigvalsh(found / np.outer(scale, scale))) > -1e-9
    return found


def test_the_covariance_is_that_of_the_equations() -> None:
    error, rng = CommonError(), np.random.default_rng(3)
    expected = matrix(error).copy()
    direction = 0.0
    for k in range(60):
        turn = float(rng.normal(0.0, 0.3))
        direction += turn
        foot, alone = int(rng.integers(2)), bool(rng.uniform() < 0.2)
        dx, dy, share, n = cos(direction), sin(direction), error.start_stride(foot, alone), 0.9
        error.propagate(foot, n, turn, 1.1, (dx, dy), (2e-4, 1e-5, 1e-4))
        one, own = np.eye(9), slice(FEET[foot], FEET[foot] + 3)
        one[2, own] = share * n, share * turn, share * 1.1
        middle = np.zeros(9)
        middle[2], middle[own] = 1.0, 0.5 * one[2, own]
        one[0], one[1] = one[0] - share * dy * middle, one[1] + share * dx * middle
        expected = one @ expected @ one.T
        expected[:2, :2] += share * share * np.array([[2e-4, 1e-5], [1e-5, 1e-4]])
        expected[2, 2] += share * 1.1 * HEADING_NOISE**2
        expected[FEET[foot], FEET[foot]] += 1.1 * DRIFT_CHANGE**2
        assert np.allclose(matrix(error), expected, rtol=1e-9, atol=1e-15)
        if k % 20 == 10:
            measured = np.zeros(9)
            for row, weight in zip(FEET, error.shares, strict=True):
                measured[row], measured[row + 2] = weight, 1.2 * weight
            gain = expected @ measured / (measured @ expected @ measured + 1e-7)
            error.correct_drift(1e-4, 1e-7, 1.0, 1.2)
            expected -= np.outer(gain, measured @ expected)
            assert np.allclose(matrix(error), expected, rtol=1e-9, atol=1e-15)


def test_a_foot_without_calibration_makes_two_feet_as_unsure_as_it_is() -> None:
    known = HeadingCalibration(0.0, 0.0, 1e-4, 1e-4)
    sigmas = []
    for feet in ((), (Foot.LEFT,), (Foot.LEFT, Foot.RIGHT)):
        error = CommonError()
        error.use_calibration(dict.fromkeys(feet, known))
        sigmas.append(error.drift_variance(0.0) ** 0.5)
    assert sigmas == pytest.approx([DRIFT / 2.0**0.5, (DRIFT**2 + 1e-8) ** 0.5 / 2.0, 1e-4 / 2.0**0.5])
    for foot, sigma in ((0, 1e-4), (1, DRIFT)):
        error = CommonError()
        error.use_calibration({Foot.LEFT: known})
        error.start_stride(foot, alone=True)
        assert error.drift_variance(0.0) ** 0.5 == pytest.approx(sigma)


@pytest.mark.parametrize("sigma", [0.05, 0.5, 1.0, 2.0, 4.0])
def test_a_heading_that_is_far_off_leaves_the_place_on_a_circle_about_where_it_turned(sigma: float) -> None:
    """The covariance of a place 30 m from where the heading went astray is that of drawn headings, of any size."""
    arm, rng = np.array([18.0, -24.0]), np.random.default_rng(1)
    error, variance = CommonError(), sigma * sigma
    b = np.array([-arm[1], arm[0]])
    place = variance * np.outer(b, b) + np.diag([0.5, 0.25])
    for i in range(2):
        error.covariance[i][:3] = [*place[i].tolist(), variance * b[i]]
    error.covariance[2][:3] = [variance * b[0], variance * b[1], variance]
    xx, xy, yy = position_covariance(error, (0.0, 0.0))
    headings = sigma * rng.standard_normal(200_000)
    off = np.stack([(np.cos(headings) - 1.0) * arm[i] + np.sin(headings) * b[i] for i in range(2)])
    drawn = off @ off.T / len(headings) + np.diag([0.5, 0.25])
    assert np.allclose([[xx, xy], [xy, yy]], drawn, rtol=0.02, atol=0.02 * np.trace(drawn))


def test_strides_that_are_all_too_long_leave_the_place_uncertain_along_the_way() -> None:
    error = CommonError()
    error.inflate(0.01)
    xx, xy, yy = position_covariance(error, (30.0, 40.0))
    assert atan2(xy, xx - 0.01) == pytest.approx(atan2(40.0, 30.0))
    assert xx + yy == pytest.approx(0.02 + (50.0 * LENGTH_ERROR) ** 2)


def test_a_gap_and_a_turn_make_the_heading_less_sure() -> None:
    error, sigmas = CommonError(), [0.0]
    error.start_stride(0, alone=False)
    for duration, unseen in ((0.1, False), (3.0, False), (20.0, True)):
        error.add_gap(duration, unseen)
        sigmas.append(error.heading_sigma)
    assert sigmas[0] < sigmas[1] < 0.1 * sigmas[3] and sigmas[1] < sigmas[2] < 0.1 < 1.0 < sigmas[3]
    assert error.covariance[0][0] > 20.0**2, "nobody knows where a wearer went meanwhile"
    short = CommonError()
    short.add_gap(0.4, unseen=True)
    assert short.covariance[0][0] == 0.0 and short.heading_sigma == pytest.approx(0.2), "a stride fills a short gap"
    straight_on, round_about = CommonError(), CommonError()
    for one, turn in ((straight_on, 0.0), (round_about, 2.0 * pi)):
        one.propagate(0, 1.0, turn, 1.0, (1.3, 0.0), (1e-4, 0.0, 1e-4))
    more = round_about.heading_sigma**2 - straight_on.heading_sigma**2
    assert more == pytest.approx((pi * TURNING) ** 2)
