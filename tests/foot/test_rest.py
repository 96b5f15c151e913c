"""A rest teaches the bias about the vertical and about the horizontal apart, however the sensor is mounted."""

from __future__ import annotations

import numpy as np
import pytest

from solepath.foot.attitude import Rest
from solepath.foot.navigate.bias import BIAS_ERROR, FIRST_BIAS, Bias
from solepath.session import Session
from solepath.types import Foot, Sample, Site
from solepath.types.vector import GRAVITY

RATE = 100.0
BIAS = np.array([0.004, -0.003, 0.002])


def rested(mounting: np.ndarray, trembling: tuple[float, float], seconds: float = 8.0) -> Rest:
    """Return what is learnt from a rest of a foot that trembles about the vertical and about the horizontal, rad/s.

    The mounting turns vectors of the foot, z up, into those of the sensor."""
    rng, rest = np.random.default_rng(7), Rest()
    count = int(seconds * RATE)
    about_up, about_level = trembling
    # slower than a block of the rest: what averages out in a block teaches nothing about the error of its mean
    slow = np.repeat(rng.standard_normal((count // 25, 3)), 25, axis=0) * [about_level, about_level, about_up]
    forces = np.array([0.0, 0.0, GRAVITY]) + 0.01 * rng.standard_normal((count, 3))
    for k in range(len(slow)):
        acc, gyro = mounting @ forces[k], mounting @ (BIAS + slow[k])
        rest.update(k / RATE, tuple(acc.tolist()), tuple(gyro.tolist()))
    return rest


def rotations() -> list[np.ndarray]:
    rng = np.random.default_rng(3)
    found = [np.eye(3)]
    for _ in range(4):
        q, r = np.linalg.qr(rng.standard_normal((3, 3)))
        q = q * np.sign(np.diag(r))
        found.append(q if np.linalg.det(q) > 0.0 else -q)
    return found


@pytest.mark.parametrize("mounting", rotations())
def test_the_mounting_changes_nothing(mounting: np.ndarray) -> None:
    upright, turned = rested(np.eye(3), (0.0005, 0.004)), rested(mounting, (0.0005, 0.004))
    assert np.allclose(mounting.T @ np.array(turned.bias), upright.bias, atol=2e-5)
    assert np.allclose(turned.bias_filter.bias.variances, upright.bias_filter.bias.variances, rtol=0.05)


def test_a_foot_that_sways_to_and_fro_still_shows_how_the_heading_drifts() -> None:
    rest = rested(np.eye(3), (0.0003, 0.006))
    assert rest.bias_filter.bias.variances[0] < 0.3 * rest.bias_filter.bias.variances[1]
    assert abs(rest.bias[2] - BIAS[2]) < 3e-4


def test_a_rest_that_trembles_or_is_short_teaches_less() -> None:
    still, trembling = rested(np.eye(3), (0.0003, 0.0003)), rested(np.eye(3), (0.006, 0.006))
    short = rested(np.eye(3), (0.006, 0.006), 2.0)
    variances = [one.bias_filter.bias.variances[0] for one in (still, trembling, short)]
    assert variances[0] < 0.3 * variances[1] < 0.1 * variances[2]


def sways(seconds: float, seed: int) -> Rest:
    """Return what a rest shows in which the foot turns to and fro by 0.06 degrees within a second, as real ones do.

    The angle is a first-order Gauss-Markov process, smoothed over a fifth of a second, because a foot has mass."""
    rng, rest, aim, angle = np.random.default_rng(seed), Rest(), 0.0, 0.0
    decay, smooth = np.exp(-1.0 / RATE), np.exp(-5.0 / RATE)
    for k in range(int(seconds * RATE)):
        aim = decay * aim + np.radians(0.06) * np.sqrt(1.0 - decay * decay) * rng.standard_normal()
        turned = smooth * angle + (1.0 - smooth) * aim
        acc = np.array([0.0, 0.0, GRAVITY]) + 0.01 * rng.standard_normal(3)
        rest.update(k / RATE, tuple(acc.tolist()), tuple((BIAS + [0.0, 0.0, (turned - angle) * RATE]).tolist()))
        angle = turned
    return rest


def test_a_rest_of_thrice_the_time_is_worth_three_of_it() -> None:
    """A standing foot turns to and fro, so that the error of its mean rate falls with the time, not with its root."""
    errors, claimed = {}, {}
    for seconds in (3.0, 9.0, 27.0):
        found = [sways(seconds, seed) for seed in range(40)]
        errors[seconds] = float(np.sqrt(np.mean([(one.bias[2] - BIAS[2]) ** 2 for one in found])))
        claimed[seconds] = float(np.mean([one.bias_filter.bias.variances[0] for one in found])) ** 0.5
    assert errors[9.0] < 0.45 * errors[3.0] and errors[27.0] < 0.45 * errors[9.0]
    for seconds in (3.0, 9.0):
        assert 0.4 * claimed[seconds] < errors[seconds] < 1.6 * claimed[seconds]
    assert claimed[27.0] == pytest.approx(BIAS_ERROR, rel=0.2), "no gyroscope keeps its bias for ever"


def test_a_foot_that_starts_to_turn_before_it_lifts_does_not_make_that_its_bias() -> None:
    """A wearer turns over the last half second of a rest, by half a degree a second."""
    rng, rest = np.random.default_rng(8), Rest()
    for k in range(int(4.0 * RATE)):
        turn = 0.009 if 3.0 < k / RATE <= 3.5 else 0.0
        gyro = BIAS + [0.0, 0.0, turn] + 0.0005 * rng.standard_normal(3)
        acc = np.array([0.0, 0.0, GRAVITY]) + (3.0 if k / RATE > 3.5 else 0.01) * rng.standard_normal(3)
        rest.update(k / RATE, tuple(acc.tolist()), tuple(gyro.tolist()))
    assert rest.bias[2] == pytest.approx(BIAS[2], abs=2e-4)


def stand(session: Session, start: float, seconds: float, bias: float) -> None:
    """Feed a left foot that stands, with this bias about the vertical, rad/s."""
    rng = np.random.default_rng(int(start))
    for k in range(int(seconds * RATE)):
        gyro = (0.0, 0.0, bias + 2e-4 * float(rng.standard_normal()))
        session.feed(Sample(t=start + k / RATE, site=Site.LEFT_FOOT, acc=(0.0, 0.0, GRAVITY), gyro=gyro))


def bias_of(session: Session) -> Bias:
    return session.feet[Foot.LEFT].rest.bias_filter.bias


def test_a_gap_ends_a_rest_because_the_bias_may_be_another_one_after_it() -> None:
    session = Session()
    stand(session, 0.0, 10.0, 0.001)
    stand(session, 1800.0, 10.0, 0.0035)
    assert bias_of(session).value[2] == pytest.approx(0.0035, abs=3e-4)


def test_a_rest_of_ten_minutes_follows_a_gyroscope_that_warms_up() -> None:
    """By 0.1 degrees/s; half of a degree a minute may be left."""
    rng, rest = np.random.default_rng(4), Rest()
    for k in range(int(600.0 * 25.0)):
        bias = 0.001 + 0.00175 * k / (600.0 * 25.0)
        rest.update(k / 25.0, (0.0, 0.0, GRAVITY), (0.0, 0.0, bias + 2e-4 * float(rng.standard_normal())))
    assert rest.bias[2] == pytest.approx(0.00275, abs=np.radians(0.6) / 60.0)


def test_another_device_at_the_foot_has_an_unknown_bias() -> None:
    session = Session()
    stand(session, 0.0, 5.0, 0.001)
    assert bias_of(session).spans > 5
    session.bind(Site.LEFT_FOOT, "00:11:22:33:44:55")
    assert bias_of(session).spans == 0 and bias_of(session).variances == (FIRST_BIAS**2, FIRST_BIAS**2)
    stand(session, 20.0, 5.0, 0.02)
    assert bias_of(session).value[2] == pytest.approx(0.02, abs=3e-4)
