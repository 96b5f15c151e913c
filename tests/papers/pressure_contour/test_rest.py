"""Noise of a sensor at rest: what is put in comes out, and a sensor that moved is no calibration."""

from __future__ import annotations

from functools import cache
from math import sqrt

import numpy as np
import pytest
from attrs import evolve

from solepath.calibration import Calibration, CalibrationError, RestNoise
from solepath.papers.pressure_contour.bias_zupt import BiasZupt
from solepath.papers.pressure_contour.rest import allan_variance, fit_noise, rest_calibration, rest_noise
from solepath.types import Foot, Sample, Site, Vec3
from solepath.types.vector import GRAVITY

RATE = 64.0
ACC, GYRO = 6e-3, 3e-4
"""Standard deviations of the samples of an accelerometer, m/s^2, and of a gyroscope, rad/s."""


@cache
def at_rest(duration: float, site: Site = Site.RIGHT_FOOT, seed: int = 1) -> tuple[Sample, ...]:
    count, rng = round(duration * RATE) + 1, np.random.default_rng(seed)
    acc = ACC * rng.standard_normal((count, 3)) + (0.3, -0.2, GRAVITY)
    gyro = GYRO * rng.standard_normal((count, 3)) + (0.01, 0.0, -0.02)
    rows = zip(acc.tolist(), gyro.tolist(), strict=True)
    return tuple([Sample(k / RATE, site, tuple(a), tuple(g)) for k, (a, g) in enumerate(rows)])


def test_the_allan_variance_of_a_ramp_and_of_a_zigzag_by_hand() -> None:
    # means over n samples of a ramp of a in each sample differ by n a: the variance is (n a)^2 / 2
    ramp = np.outer(np.arange(72.0), (0.1, 0.1, 0.1)) + 5.0
    tau, variance = allan_variance(ramp, 0.02)
    assert tau == pytest.approx([0.02, 0.04, 0.08, 0.16]), "up to a ninth of 72 samples"
    assert variance == pytest.approx([0.005, 0.02, 0.08, 0.32])
    assert len(allan_variance(ramp[:71], 0.02)[0]) == 3
    # neighbours of a zigzag of 1 and -1 differ by 2, and means of two by nothing; one axis of three zigzags
    zigzag = np.outer((-1.0) ** np.arange(36), (1.0, 0.0, 0.0))
    assert allan_variance(zigzag, 1.0)[1] == pytest.approx([2.0 / 3.0, 0.0, 0.0])


def test_the_density_is_that_of_the_shortest_time_and_the_walk_what_it_leaves_of_the_longest() -> None:
    tau = 0.02 * 2.0 ** np.arange(10)
    white, flicker, walk = 4e-6, 3e-9, 2e-8
    density, wander = fit_noise(tau, white / tau + flicker + walk * tau)
    assert density == pytest.approx(sqrt(2.0 * white), rel=1e-4)
    assert wander == pytest.approx(sqrt(3.0 * (walk + flicker / tau[-1])), rel=1e-4)
    assert fit_noise(tau, white / tau) == pytest.approx((sqrt(2.0 * white), 0.0), abs=1e-9)
    assert fit_noise(tau, tau**-1.5)[1] == 0.0, "no variance is negative"
    with pytest.raises(CalibrationError, match="reads the same all the time"):
        fit_noise(tau, 0.0 * tau)


def test_each_foot_has_the_noise_of_its_sensor() -> None:
    samples = [*at_rest(120.0, Site.LEFT_FOOT, 2), *at_rest(130.0)]
    left, right = rest_noise(samples)
    assert (left.foot, right.foot, left.duration, right.duration) == (Foot.LEFT, Foot.RIGHT, 120.0, 130.0)
    assert rest_noise(samples, Foot.RIGHT) == (right,)
    assert rest_calibration([left, right]).rest == {Foot.LEFT: left.noise, Foot.RIGHT: right.noise}
    assert right.noise.rate == pytest.approx(RATE)
    assert right.noise.acc_density == pytest.approx(ACC * sqrt(2.0 / RATE), rel=0.03)
    assert right.noise.gyro_density == pytest.approx(GYRO * sqrt(2.0 / RATE), rel=0.03)
    for found, name in ((right.acc_instability, "acc"), (right.gyro_instability, "gyro")):
        tau, variance = allan_variance(np.array([getattr(one, name) for one in at_rest(130.0)]), 1.0 / RATE)
        assert found == pytest.approx(sqrt(variance.min()))
        density, wander = fit_noise(tau, variance)
        assert getattr(right.noise, f"{name}_density") == pytest.approx(density)
        assert getattr(right.noise, f"{name}_wander") == pytest.approx(wander)


def test_the_longest_rest_without_a_gap_counts_and_three_intervals_are_no_gap() -> None:
    samples = [one for one in at_rest(150.0) if not 10.0 < one.t < 10.5 and not 70.0 < one.t < 70.04]
    (fit,) = rest_noise(samples)
    assert fit.duration == pytest.approx(139.5)
    with pytest.raises(CalibrationError, match="the right foot has 80 s without a gap; 120 s of rest"):
        rest_noise([one for one in samples if not 70.0 < one.t < 70.05])
    with pytest.raises(CalibrationError, match="120 s without a gap; 120 s of rest"):
        rest_noise(at_rest(119.98))
    with pytest.raises(CalibrationError, match="no foot's accelerations"):
        rest_noise([Sample(0.0, Site.RIGHT_FOOT, pressure=(1.0,))])
    with pytest.raises(CalibrationError, match="the right foot has too few samples"):
        rest_noise(at_rest(120.0)[:1])


def moved(acc: Vec3, gyro: Vec3, start: float, end: float) -> list[Sample]:
    """Return two minutes at rest, in which so much is added from `start` to `end`, s."""
    made = []
    for one in at_rest(120.0):
        if start <= one.t < end and one.acc is not None and one.gyro is not None:
            (x, y, z), (p, q, r) = one.acc, one.gyro
            added = (x + acc[0], y + acc[1], z + acc[2]), (p + gyro[0], q + gyro[1], r + gyro[2])
            one = evolve(one, acc=added[0], gyro=added[1])
        made.append(one)
    return made


@pytest.mark.parametrize(
    ("still", "moves", "during", "reason"),
    [
        (((0.0, 0.0, 0.0), (0.0, 0.095, 0.0)), ((0.0, 0.0, 0.0), (0.0, -0.105, 0.0)), (90.0, 93.0), "moved 90 s after"),
        (((0.19, 0.0, 0.0), (0.0, 0.0, 0.0)), ((0.0, -0.21, 0.0), (0.0, 0.0, 0.0)), (50.0, 51.0), "moved 50 s after"),
        (((0.0, 0.0, 0.9), (0.0, 0.0, 0.0)), ((0.0, 0.0, 1.1), (0.0, 0.0, 0.0)), (0.0, 150.0), "reads 10.9 m/s"),
        (((0.0, 0.0, -0.9), (0.0, 0.0, 0.0)), ((0.0, 0.0, -1.1), (0.0, 0.0, 0.0)), (0.0, 150.0), "reads 8.7 m/s"),
        (
            ((0.0, 0.0, 0.0), (0.0, 0.49, 0.0)),
            ((0.0, 0.0, 0.0), (0.0, -0.51, 0.0)),
            (0.0, 150.0),
            "turns by up to 0.51 rad/s on average",
        ),
    ],
)
def test_a_sensor_that_turns_or_falls_is_not_at_rest(
    still: tuple[Vec3, Vec3], moves: tuple[Vec3, Vec3], during: tuple[float, float], reason: str
) -> None:
    assert len(rest_noise(moved(*still, *during))) == 1
    with pytest.raises(CalibrationError, match=reason):
        rest_noise(moved(*moves, *during))


def test_the_filter_trusts_a_standing_foot_by_the_noise_of_its_sensor_at_rest() -> None:
    known = Calibration(rest={Foot.LEFT: RestNoise(0.01, 1e-3, 1e-4, 1e-5, 100.0)})
    noise = BiasZupt().calibrated(Foot.LEFT, known).bias.settings
    assert (noise.sample_noise, noise.wander) == (pytest.approx(0.01 * sqrt(50.0)), 1e-3)
    assert BiasZupt().calibrated(Foot.RIGHT, known).bias.settings == BiasZupt().bias.settings
