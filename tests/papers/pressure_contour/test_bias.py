"""Accelerometer bias and zero-velocity resets: equations (4) to (10) and what is left of them, by hand."""

from __future__ import annotations

from math import cos, inf, pi, sin

import pytest

from solepath.calibration import Calibration
from solepath.foot.stance.stance import Stance
from solepath.papers.pressure_contour.acc_bias import BIAS_SIGMA, BIAS_WANDER, SAMPLE_NOISE, AccelerometerBias
from solepath.papers.pressure_contour.bias_zupt import BiasZupt, BiasZuptSettings
from solepath.types import Foot, Phase, Quat, Vec3
from solepath.types.vector import GRAVITY, IDENTITY, ZERO, from_rotation_vector, from_yaw, rotate

STANDING = Stance(ZERO, 0.01, 0.0, Phase.STATIONARY)
MOVING = Stance(ZERO, inf, 0.0, None)
UP: Vec3 = (0.0, 0.0, GRAVITY)


def start(corrector: BiasZupt, attitude: Quat = IDENTITY) -> BiasZupt:
    corrector.start(attitude, 0.02)
    return corrector


def fed(
    corrector: BiasZupt, stance: Stance, acc: Vec3, count: int, dt: float = 0.01, attitude: Quat | None = None
) -> None:
    for k in range(count):
        if attitude is not None:
            corrector.use_attitude(attitude)
        corrector.predict(dt, acc, ZERO)
        corrector.correct(k * dt, stance)


def test_two_steps_of_the_filter_are_those_of_the_paper() -> None:
    bias, sigma_v = AccelerometerBias(), SAMPLE_NOISE * SAMPLE_NOISE
    bias.variance = sigma_v
    # M = Sigma_v: P = M - M^2 / (M + Sigma_v) = Sigma_v / 2, gain P / Sigma_v = 0.5, y = -a_m
    bias.correct((-0.08, 0.04, 0.0))
    assert bias.bias == pytest.approx((0.04, -0.02, 0.0))
    assert bias.variance == pytest.approx(0.5 * sigma_v)
    # in this time Sigma_w comes to Sigma_v: M = P + Sigma_w = 1.5 Sigma_v
    bias.propagate((SAMPLE_NOISE / BIAS_WANDER) ** 2)
    assert bias.variance == pytest.approx(1.5 * sigma_v)
    # P = (1.5 - 1.5^2 / 2.5) Sigma_v, gain 0.6: 0.04 + 0.6 (0.08 - 0.04) and -0.02 + 0.6 (-0.04 + 0.02)
    bias.correct((-0.08, 0.04, 0.01))
    assert bias.bias == pytest.approx((0.064, -0.032, -0.006))
    assert bias.variance == pytest.approx(0.6 * sigma_v)


def test_before_any_stance_the_bias_is_as_uncertain_as_the_data_sheet_has_it() -> None:
    later, now = AccelerometerBias(), AccelerometerBias()
    later.propagate(1.0)
    assert later.variance == pytest.approx(BIAS_SIGMA**2 + BIAS_WANDER**2, rel=1e-12)
    now.correct((-0.08, 0.04, 0.0))
    assert now.variance == pytest.approx(BIAS_SIGMA**2 * SAMPLE_NOISE**2 / (BIAS_SIGMA**2 + SAMPLE_NOISE**2))


@pytest.mark.parametrize("attitude", [IDENTITY, from_rotation_vector((0.3, -0.2, 1.0))])
def test_the_bias_is_the_reading_beside_gravity_in_the_sensor_frame(attitude: Quat) -> None:
    corrector = start(BiasZupt())
    w, x, y, z = attitude
    gravity = rotate((w, -x, -y, -z), UP)
    off = (0.08, -0.05, 0.03)
    acc = (gravity[0] + off[0], gravity[1] + off[1], gravity[2] + off[2])
    fed(corrector, STANDING, acc, 500, attitude=attitude)
    assert corrector.bias.bias == pytest.approx((-0.08, 0.05, -0.03), rel=0.01)


def test_a_known_bias_no_longer_moves_the_foot_whichever_way_it_turns() -> None:
    # (10) with the sign of (6): as printed, the error of 0.1 m/s^2 would double
    corrector = start(BiasZupt())
    fed(corrector, STANDING, (0.1, 0.0, GRAVITY), 1000, attitude=IDENTITY)
    turned = from_yaw(0.5 * pi)
    fed(corrector, MOVING, (0.1, 0.0, GRAVITY), 1)
    corrector.velocity, corrector.position = ZERO, ZERO
    fed(corrector, MOVING, (0.1, 0.0, GRAVITY), 100, attitude=turned)
    assert abs(corrector.velocity[0]) < 0.003 and abs(corrector.velocity[1]) < 0.003


def test_a_steady_error_of_a_swing_costs_no_way_when_it_is_spread_and_half_a_t_squared_when_not() -> None:
    # an error of 0.2 m/s^2 for a second: a t^2 / 2 = 0.1 m
    for remove_swing_drift, way in ((True, 0.0), (False, 0.1)):
        corrector = start(BiasZupt(BiasZuptSettings(remove_swing_drift=remove_swing_drift)))
        corrector.predict(0.0, UP, ZERO)
        corrector.correct(0.0, STANDING)
        fed(corrector, MOVING, (0.2, 0.0, GRAVITY), 99)
        fed(corrector, STANDING, (0.2, 0.0, GRAVITY), 1)
        assert corrector.position[0] == pytest.approx(way, abs=0.002)


def corrector_with(drift: tuple[float, float] | None) -> BiasZupt:
    part = BiasZupt().calibrated(Foot.LEFT, Calibration(drift={} if drift is None else {Foot.LEFT: drift}))
    return start(part)


def test_a_calibrated_drift_is_taken_off_every_sample() -> None:
    corrector = corrector_with((0.02, -0.01))
    fed(corrector, MOVING, UP, 250)
    assert corrector.position == pytest.approx((-0.05, 0.025, 0.0), abs=1e-9)


def test_a_drift_is_fixed_to_the_world_of_a_device_that_has_one() -> None:
    corrector = corrector_with((0.02, 0.0))
    # the device reports 0.4 where navigation has 0: its x axis lies at -0.4 rad in navigation
    fed(corrector, MOVING, UP, 100, attitude=from_yaw(0.4))
    assert corrector.position == pytest.approx((-0.02 * cos(-0.4), -0.02 * sin(-0.4), 0.0), abs=1e-9)


def test_who_stands_for_long_does_not_drift() -> None:
    corrector = corrector_with((0.02, 0.0))
    fed(corrector, STANDING, UP, 1000)
    assert -0.0205 < corrector.position[0] < -0.0195
