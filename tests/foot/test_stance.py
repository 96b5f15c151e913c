"""Stance evidence of every detector, and the height of the sensor above the sole."""

from __future__ import annotations

from math import pi
from typing import Any

import numpy as np
import pytest

from solepath.foot.settings import ShoeSettings
from solepath.foot.stance.cycle import Cycle
from solepath.foot.stance.shoe import ShoeDetector
from solepath.foot.stance.stance import Stance
from solepath.types.vector import GRAVITY

SIGMA_ACC, SIGMA_GYRO = 0.01, 0.1 * pi / 180.0
"""Noise levels that scale the statistics, m/s^2 and rad/s (Skog et al.)."""

Rows = list[tuple[float, float, float]]


def shoe(acc: Rows, gyro: Rows) -> float:
    """T = 1/W sum(|a - g m/|m||^2 / s_a^2 + |w|^2 / s_w^2), m the mean of a."""
    a, w = np.array(acc), np.array(gyro)
    mean = a.mean(axis=0)
    residual = ((a - GRAVITY * mean / np.linalg.norm(mean)) ** 2).sum() / SIGMA_ACC**2
    return float((residual + (w**2).sum() / SIGMA_GYRO**2) / len(a))


ACC: Rows = [(0.0, 0.0, 9.80665), (0.3, 0.0, 9.80665), (0.0, -0.4, 9.50665), (0.1, 0.2, 10.30665)]
GYRO: Rows = [(0.0, 0.0, 0.0), (0.0, 0.02, 0.0), (0.01, 0.0, -0.03), (0.1, 0.2, 0.2)]


def run(detector: Any, acc: Rows, gyro: Rows, dt: float = 0.01) -> list[Stance]:
    return [detector.update(k * dt, dt, a, w, None) for k, (a, w) in enumerate(zip(acc, gyro, strict=True))]


@pytest.mark.parametrize(
    ("detector", "length"),
    [(ShoeDetector(ShoeSettings(window=0.035)), 4), (ShoeDetector(), 3), (Cycle(), 3)],
    ids=lambda value: type(value).__name__ if hasattr(value, "update") else None,
)
def test_the_statistic_follows_its_formula(detector: Any, length: int) -> None:
    evidences = run(detector, ACC, GYRO)[-1].statistic
    assert evidences == pytest.approx(shoe(ACC[-length:], GYRO[-length:]), rel=1e-9)
