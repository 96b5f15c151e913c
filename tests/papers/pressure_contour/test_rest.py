"""Noise of a sensor at rest: what is put in comes out, and a sensor that moved is no calibration."""

from __future__ import annotations

from math import sqrt

import numpy as np
import pytest

from solepath.calibration import Calibration, CalibrationError, RestNoise
from solepath.calibration.merging import merged
from solepath.papers.pressure_contour.bias_zupt import BiasZupt
from solepath.papers.pressure_contour.rest import allan_variance, fit_noise, rest_calibration, rest_noise
from solepath.types import Foot, Sample, Site
from solepath.types.vector import GRAVITY

RATE = 50.0
ACC, GYRO = (1.2e-3, 1.5e-4), (6e-5, 2e-6)
"""Density, u/sqrt(Hz), and walk, u/sqrt(s), of an accelerometer, m/s^2, and a gyroscope, rad/s."""


def noise(density: float, walk: float, count: int, rng: np.random.Generator) -> np.ndarray:
    white = density * sqrt(0.5 * RATE) * rng.standard_normal((count, 3))
    return white + np.cumsum(walk / sqrt(RATE) * rng.standard_normal((count, 3)), axis=0)


def at_rest(duration: float, site: Site = Site.RIGHT_FOOT, seed: int = 1) -> list[Sample]:
    count, rng = int(duration * RATE), np.random.default_rng(seed)
    acc = noise(*ACC, count, rng) + (0.3, -0.2, GRAVITY)
    gyro = noise(*GYRO, count, rng) + (0.01, 0.0, -0.02)
    return [
        Sample(k / RATE, site, tuple(a), tuple(g))
        for k, (a, g) in enumerate(zip(acc.tolist(), gyro.tolist(), strict=True))
    ]


def test_the_densities_and_walks_of_an_hour_at_rest_come_out() -> None:
    (fit,) = rest_noise(at_rest(3600.0))
    assert fit.foot is Foot.RIGHT and fit.duration == pytest.approx(3600.0, abs=0.1)
    found = fit.noise
    assert found.acc_density == pytest.approx(ACC[0], rel=0.03) and found.gyro_density == pytest.approx(
        GYRO[0], rel=0.03
    )
    assert found.acc_wander == pytest.approx(ACC[1], rel=0.35) and found.gyro_wander == pytest.approx(GYRO[1], rel=0.35)
    assert found.rate == pytest.approx(RATE)
    assert fit.acc_instability < ACC[0]


def test_two_minutes_show_the_densities() -> None:
    left, right = rest_noise([*at_rest(150.0, Site.LEFT_FOOT, 2), *at_rest(150.0, Site.RIGHT_FOOT, 3)])
    assert (left.foot, right.foot) == (Foot.LEFT, Foot.RIGHT)
    for fit in (left, right):
        assert fit.noise.acc_density == pytest.approx(ACC[0], rel=0.1)
        assert fit.noise.gyro_density == pytest.approx(GYRO[0], rel=0.1)
        assert fit.noise.acc_wander < 5.0 * ACC[1]


def test_white_noise_averages_down_with_the_time_and_has_no_walk() -> None:
    values = 0.02 * np.random.default_rng(4).standard_normal((100_000, 3))
    tau, variance = allan_variance(values, 0.02)
    assert tau[0] == 0.02 and variance[0] == pytest.approx(4e-4, rel=0.02)
    assert variance[5] == pytest.approx(variance[0] / 32.0, rel=0.1)
    density, walk = fit_noise(tau, variance, 2000.0)
    assert density == pytest.approx(0.02 * sqrt(2.0 * 0.02), rel=0.02)
    assert walk < 2e-4


def moved(one: Sample, acc: tuple[float, float, float], gyro: tuple[float, float, float]) -> Sample:
    assert one.acc is not None and one.gyro is not None
    (x, y, z), (p, q, r) = one.acc, one.gyro
    return Sample(one.t, one.site, (x + acc[0], y + acc[1], z + acc[2]), (p + gyro[0], q + gyro[1], r + gyro[2]))


@pytest.mark.parametrize(
    ("acc", "gyro", "during", "reason"),
    [
        ((0.0, 0.0, 0.0), (0.0, 0.0, 0.2), (90.0, 93.0), "moved 90 s after the start"),
        ((0.0, 0.0, 0.0), (0.0, 0.0, 2.0), (0.0, 150.0), "turns by up to 2 rad/s on average"),
        ((0.0, 0.0, -9.0), (0.0, 0.0, 0.0), (0.0, 150.0), "reads 0.9 m/s"),
    ],
)
def test_a_sensor_that_turns_or_falls_is_not_at_rest(
    acc: tuple[float, float, float], gyro: tuple[float, float, float], during: tuple[float, float], reason: str
) -> None:
    start, end = during
    samples = [moved(one, acc, gyro) if start <= one.t < end else one for one in at_rest(150.0)]
    with pytest.raises(CalibrationError, match=reason):
        rest_noise(samples)


def test_noise_below_the_resolution_is_no_calibration() -> None:
    coarse = [Sample(0.05 * k, Site.LEFT_FOOT, (0.0, 0.0, GRAVITY), (0.0, 0.0, 0.0)) for k in range(3000)]
    with pytest.raises(CalibrationError, match="reads the same all the time"):
        rest_noise(coarse)


def test_a_gap_of_four_intervals_ends_a_rest() -> None:
    with pytest.raises(CalibrationError, match="75 s without a gap"):
        rest_noise([one for one in at_rest(150.0) if not 75.0 < one.t < 75.07])


@pytest.mark.parametrize(
    ("samples", "reason"),
    [
        (at_rest(60.0), "60 s without a gap; 120 s of rest"),
        ([Sample(0.0, Site.RIGHT_FOOT, pressure=(1.0,))], "no foot's accelerations"),
        (
            [
                Sample(one.t, one.site, (one.acc[0] + (2.0 if 90.0 < one.t < 93.0 else 0.0), *one.acc[1:]), one.gyro)
                for one in at_rest(150.0)
                if one.acc is not None
            ],
            "moved 90 s after the start",
        ),
    ],
)
def test_too_short_a_rest_and_a_sensor_that_moved_are_no_calibration(samples: list[Sample], reason: str) -> None:
    with pytest.raises(CalibrationError, match=reason):
        rest_noise(samples)


def test_the_filter_trusts_a_standing_foot_by_the_noise_of_its_sensor_at_rest() -> None:
    (fit,) = rest_noise(at_rest(150.0))
    known = merged(Calibration(rest={Foot.LEFT: RestNoise(0.01, 1e-3, 1e-4, 1e-5, 100.0)}), rest_calibration([fit]))
    assert set(known.rest) == set(Foot)
    bias = BiasZupt().calibrated(Foot.RIGHT, known).bias
    assert bias.settings.sample_noise == pytest.approx(ACC[0] * sqrt(0.5 * RATE), rel=0.1)
    assert BiasZupt().calibrated(Foot.LEFT, known).bias.settings.sample_noise == pytest.approx(0.01 * sqrt(50.0))
    bias.correct((-0.1, 0.0, 0.0))
    usual = BiasZupt().bias
    usual.correct((-0.1, 0.0, 0.0))
    assert usual.variance is not None and bias.variance is not None
    assert bias.settings.sample_noise < usual.settings.sample_noise and bias.variance < usual.variance
