"""A rest teaches the bias about the vertical and about the horizontal apart, however the sensor is mounted."""

from __future__ import annotations

import numpy as np
import pytest

from solepath.foot.attitude import Rest
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
    assert np.allclose(turned.variances, upright.variances, rtol=0.05)


def test_a_foot_that_sways_to_and_fro_still_shows_how_the_heading_drifts() -> None:
    rest = rested(np.eye(3), (0.0003, 0.006))
    assert rest.variances[0] < 0.2 * rest.variances[1]
    assert abs(rest.bias[2] - BIAS[2]) < 3e-4


def test_a_rest_that_trembles_or_is_short_teaches_less() -> None:
    still, trembling = rested(np.eye(3), (0.0003, 0.0003)), rested(np.eye(3), (0.006, 0.006))
    short = rested(np.eye(3), (0.006, 0.006), 2.0)
    assert still.variances[0] < 0.1 * trembling.variances[0] < 0.1 * short.variances[0]
