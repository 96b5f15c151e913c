"""A rest teaches the bias about the vertical and about the horizontal apart, however the sensor is mounted."""

from __future__ import annotations

import numpy as np
import pytest

from solepath.foot.attitude import Rest
from solepath.foot.navigate.bias import FIRST_BIAS, Bias
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


def test_a_foot_that_sways_to_and_fro_still_shows_how_the_heading_drifts() -> None:
    rest = rested(np.eye(3), (0.0003, 0.006))
    assert rest.bias_filter.bias.variances[0] < 0.3 * rest.bias_filter.bias.variances[1]
    assert abs(rest.bias[2] - BIAS[2]) < 3e-4


def stand(session: Session, start: float, seconds: float, bias: float) -> None:
    """Feed a left foot that stands, with this bias about the vertical, rad/s."""
    rng = np.random.default_rng(int(start))
    for k in range(int(seconds * RATE)):
        gyro = (0.0, 0.0, bias + 2e-4 * float(rng.standard_normal()))
        acc = (0.0, 0.0, GRAVITY + 0.01 * float(rng.standard_normal()))
        session.feed(Sample(t=start + k / RATE, site=Site.LEFT_FOOT, acc=acc, gyro=gyro))


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
