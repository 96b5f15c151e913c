"""Stance evidence of every detector, and the height of the sensor above the sole."""

from __future__ import annotations

from math import cos, inf, pi, sin, sqrt
from typing import Any

import numpy as np
import pytest
from attrs import evolve
from hypothesis import given
from hypothesis import strategies as st

from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.insoles import layout
from solepath.emulate.wearers.walker import Walker
from solepath.foot.settings import CycleSettings, StanceThreshold
from solepath.foot.stance.classic import AngularRate, Graph, MovingVariance
from solepath.foot.stance.cycle import Cycle
from solepath.foot.stance.pressure import MaximumPressure, TwoArea
from solepath.foot.stance.sensor_height import HIGHEST_HEIGHT, INITIAL_HEIGHT, LOWEST_HEIGHT, SensorHeight
from solepath.foot.stance.shoe import ShoeDetector
from solepath.foot.stance.stance import Load, Stance, soften
from solepath.types import Foot, Phase, Vec3
from solepath.types.vector import GRAVITY, IDENTITY, conjugate, normalise, rotate

SIGMA_ACC, SIGMA_GYRO = 0.01, 0.1 * pi / 180.0
"""Noise levels that scale the statistics, m/s^2 and rad/s (Skog et al.)."""

Rows = list[tuple[float, float, float]]


def shoe(acc: Rows, gyro: Rows) -> float:
    """T = 1/W sum(|a - g m/|m||^2 / s_a^2 + |w|^2 / s_w^2), m the mean of a."""
    a, w = np.array(acc), np.array(gyro)
    mean = a.mean(axis=0)
    residual = ((a - GRAVITY * mean / np.linalg.norm(mean)) ** 2).sum() / SIGMA_ACC**2
    return float((residual + (w**2).sum() / SIGMA_GYRO**2) / len(a))


def are(acc: Rows, gyro: Rows) -> float:
    """T = 1/W sum |w|^2 / s_w^2."""
    return float((np.array(gyro) ** 2).sum() / SIGMA_GYRO**2 / len(gyro))


def mv(acc: Rows, gyro: Rows) -> float:
    """T = 1/W sum |a - m|^2 / s_a^2."""
    a = np.array(acc)
    return float(((a - a.mean(axis=0)) ** 2).sum() / SIGMA_ACC**2 / len(a))


def mbgtd(acc: Rows, gyro: Rows) -> float:
    """T = max over cuts a < b of sum over i <= a, j >= b of |a_i - a_j| / ((b - a) (W - b + 1)), counted from 0."""
    v, w = np.array(acc), len(acc)
    distances = np.linalg.norm(v[:, None] - v[None, :], axis=2)
    return max(
        float(distances[: a + 1, b:].sum() / ((b - a) * (w - b + 1))) for a in range(w - 1) for b in range(a + 1, w)
    )


ACC: Rows = [(0.0, 0.0, 9.80665), (0.3, 0.0, 9.80665), (0.0, -0.4, 9.50665), (0.1, 0.2, 10.30665)]
GYRO: Rows = [(0.0, 0.0, 0.0), (0.0, 0.02, 0.0), (0.01, 0.0, -0.03), (0.1, 0.2, 0.2)]


def run(detector: Any, acc: Rows, gyro: Rows, dt: float = 0.01) -> list[Stance]:
    return [detector.update(k * dt, dt, a, w, None) for k, (a, w) in enumerate(zip(acc, gyro, strict=True))]


@pytest.mark.parametrize(
    ("detector", "formula", "length"),
    [
        (ShoeDetector(evolve(ShoeDetector().settings, window=0.035)), shoe, 4),
        (ShoeDetector(evolve(ShoeDetector().settings, window=0.025)), shoe, 3),
        (AngularRate(evolve(AngularRate().settings, window=0.035)), are, 4),
        (AngularRate(evolve(AngularRate().settings, window=0.025)), are, 3),
        (MovingVariance(evolve(MovingVariance().settings, window=0.035)), mv, 4),
        (MovingVariance(evolve(MovingVariance().settings, window=0.025)), mv, 3),
        (Graph(evolve(Graph().settings, count=4)), mbgtd, 4),
        (Graph(evolve(Graph().settings, count=3)), mbgtd, 3),
        (Cycle(), shoe, 3),
    ],
    ids=lambda value: type(value).__name__ if hasattr(value, "update") else None,
)
def test_the_statistic_follows_its_formula(detector: Any, formula: Any, length: int) -> None:
    evidences = run(detector, ACC, GYRO)[-1].statistic
    assert evidences == pytest.approx(formula(ACC[-length:], GYRO[-length:]), rel=1e-9)


@pytest.mark.parametrize(
    ("detector", "formula", "length"),
    [
        (ShoeDetector(), shoe, 3),
        (AngularRate(), are, 3),
        (MovingVariance(), mv, 5),
        (Graph(), mbgtd, 5),
        (Cycle(), shoe, 3),
    ],
    ids=lambda value: type(value).__name__ if hasattr(value, "update") else None,
)
def test_running_sums_are_the_direct_computation_after_ten_thousand_samples(
    detector: Any, formula: Any, length: int
) -> None:
    rng = np.random.default_rng(5)
    # ten thousand samples of strong motion, then rest: rounding errors of the sums must not show at rest
    in_motion = rng.normal(0.0, 1.0, (10_000, 3)) * rng.choice([1.0, 300.0], (10_000, 1))
    acc = [tuple(row) for row in (in_motion + [0.0, 0.0, GRAVITY]).tolist()]
    gyro = [tuple(row) for row in (in_motion * 0.1).tolist()]
    at_rest = rng.normal(0.0, 0.01, (20, 6))
    acc += [tuple(row) for row in (at_rest[:, :3] + [0.0, 0.0, GRAVITY]).tolist()]
    gyro += [tuple(row) for row in at_rest[:, 3:].tolist()]
    evidences = [stance.statistic for stance in run(detector, acc, gyro)]
    for k in [*range(100, 10_000, 501), *range(10_006, 10_020)]:
        exact = formula(acc[k - length + 1 : k + 1], gyro[k - length + 1 : k + 1])
        assert evidences[k] == pytest.approx(exact, rel=1e-6, abs=1.0 if length != 5 or formula is mv else 1e-9)


def test_a_window_is_so_many_seconds_whatever_the_rate() -> None:
    for rate, held in ((50.0, 2), (100.0, 3), (200.0, 5), (400.0, 10)):
        detector = ShoeDetector()
        run(detector, [(0.0, 0.0, GRAVITY)] * 50, [(0.0, 0.0, 0.0)] * 50, 1.0 / rate)
        assert len(detector.entries) == held


@pytest.mark.parametrize("detector", [ShoeDetector(), AngularRate(), MovingVariance(), Graph(), Cycle()], ids=type)
def test_a_standing_foot_is_certainly_still(detector: Any) -> None:
    last = run(detector, [(0.0, 0.0, GRAVITY)] * 20, [(0.0, 0.0, 0.0)] * 20)[-1]
    assert last.hint is Phase.STATIONARY and last.sigma == pytest.approx(0.01, rel=0.01)
    assert last.v_ref == (0.0, 0.0, 0.0)


TEN_TO_HUNDRED = StanceThreshold(rest_statistic=10.0, motion_statistic=100.0)


def test_evidence_grows_softer_with_the_statistic_and_ends_at_the_gate() -> None:
    assert soften(5.0, TEN_TO_HUNDRED) == Stance((0.0, 0.0, 0.0), 0.01, 5.0, Phase.STATIONARY)
    assert soften(40.0, TEN_TO_HUNDRED) == Stance((0.0, 0.0, 0.0), 0.02, 40.0, None)
    assert soften(100.0, TEN_TO_HUNDRED) == Stance((0.0, 0.0, 0.0), inf, 100.0, None)
    sigmas = [soften(t, TEN_TO_HUNDRED).sigma for t in np.linspace(0.0, 120.0, 50)]
    assert sigmas == sorted(sigmas)


WALKER = Walker(Route().stand(1.0).walk(12.0, 1.3).stop(1.0), seed=2)


def shares(detector: Any) -> tuple[float, float]:
    """Return the shares of samples with evidence of stillness in mid-stance, and in mid-swing."""
    fed = WALKER.samples(Foot.LEFT, 100.0, layout=layout(96, Foot.LEFT))
    truth = WALKER.truth().feet[Foot.LEFT]
    stance = [
        (flat + 0.02, residual - 0.02) for flat, residual in zip(truth.foot_flats, truth.heel_offs[1:], strict=False)
    ]
    swing = [(a + 0.15, b - 0.10) for a, b in zip(truth.toe_offs, truth.heel_strikes, strict=True)]
    from solepath.foot.pressure.insole import InsoleLoads

    insole, evidences = InsoleLoads(), []
    insole.set_layout(layout(96, Foot.LEFT))
    for sample in fed:
        load = insole.update(sample.t, sample.pressure)
        evidence = detector.update(sample.t, 0.01, sample.acc, sample.gyro, load)
        evidences.append((sample.t, evidence.sigma < inf))

    def share(spans: list[tuple[float, float]]) -> float:
        inside = [still for t, still in evidences for a, b in spans[1:] if a <= t <= b]
        assert len(inside) > 30
        return sum(inside) / len(inside)

    return share(stance), share(swing)


@pytest.mark.parametrize(
    "detector",
    [Cycle(), ShoeDetector(), AngularRate(), MovingVariance(), Graph(), TwoArea(), MaximumPressure()],
    ids=type,
)
def test_in_mid_stance_there_is_evidence_and_in_mid_swing_there_is_little(detector: Any) -> None:
    standing, swinging = shares(detector)
    assert standing > 0.6
    assert swinging < 0.1


ACC_REST, GYRO_REST = (0.0, 0.0, GRAVITY), (0.0, 0.0, 0.0)


@pytest.mark.parametrize("detector", [TwoArea(), MaximumPressure()], ids=type)
def test_without_cells_a_pressure_detector_gives_no_evidence(detector: Any) -> None:
    evidence = detector.update(0.0, 0.01, ACC_REST, GYRO_REST, None)
    assert evidence.sigma == inf and evidence.hint is None


def test_airborne_cells_overrule_a_still_sensor() -> None:
    evidence = Cycle().update(0.0, 0.01, ACC_REST, GYRO_REST, Load(0.0, None, None, True))
    assert evidence.sigma == inf and evidence.hint is Phase.SWING


def test_noise_of_the_evidence_grows_with_the_turning_of_the_foot() -> None:
    parts = [Cycle(CycleSettings(noise_per_rate=0.06, noise_per_rate_square=0.5)) for _ in range(2)]
    still, turning = (
        run(part, [ACC_REST] * 9, [(0.0, rate, 0.0)] * 9)[-1] for part, rate in zip(parts, (0.0, 0.15), strict=True)
    )
    assert still.sigma == pytest.approx(0.01)
    noise_per_rate = 0.15 * sqrt(0.06**2 + (0.5 * 0.15) ** 2)
    assert turning.sigma == pytest.approx(sqrt(0.01**2 + noise_per_rate**2), rel=1e-6)


DT = 0.005
SKEWED = normalise((0.3, -0.5, 0.7, 0.4))
"""Attitude, foot to sensor frame."""


def roll(sensor_height: SensorHeight, height: float, tilt: float = 0.0, amount: float = 0.25) -> None:
    """Add one stance of 0.3 s to `sensor_height`.

    The foot rolls forward faster and faster about a point of the ground, with the sensor `height` m above it. The
    estimated attitude is `tilt` rad off."""
    for k in range(60):
        t = k * DT
        pitch, rate, rate_change = amount * (t / 0.3) ** 3, amount * 3 * t**2 / 0.3**3, amount * 6 * t / 0.3**3
        attitude = (cos(pitch / 2), 0.0, sin(pitch / 2), 0.0)
        acc_world: Vec3 = (height * rate_change, 0.0, GRAVITY)
        sensor = rotate(SKEWED, rotate(conjugate(attitude), acc_world))
        gyro = rotate(SKEWED, (0.0, rate, 0.0))
        residual = (cos((pitch + tilt) / 2), 0.0, sin((pitch + tilt) / 2), 0.0)
        w, x, y, z = residual
        a, b, c, d = conjugate(SKEWED)
        estimated = (
            w * a - x * b - y * c - z * d, w * b + x * a + y * d - z * c,
            w * c - x * d + y * a + z * b, w * d + x * c - y * b + z * a,
        )  # fmt: skip
        sensor_height.roll(DT, sensor, gyro, estimated)
    sensor_height.end_stance()


@pytest.mark.parametrize("height", [0.0, 0.02, 0.08, 0.12])
@pytest.mark.parametrize("tilt", [0.0, 0.02])
def test_the_sensor_height_is_known_after_a_few_stances(height: float, tilt: float) -> None:
    sensor_height = SensorHeight()
    for _ in range(5):
        roll(sensor_height, height, tilt)
    assert sensor_height.height == pytest.approx(height, abs=0.006)


def test_a_foot_that_only_stands_leaves_the_height_as_it_was() -> None:
    sensor_height = SensorHeight()
    for k in range(1000):
        sensor_height.roll(0.01, (0.01 * (k % 3), 0.0, GRAVITY), (1e-4 * (k % 2), 0.0, 0.0), IDENTITY)
    sensor_height.end_stance()
    assert sensor_height.height == pytest.approx(INITIAL_HEIGHT, abs=1e-3)


def test_a_sensor_that_is_moved_is_followed() -> None:
    sensor_height = SensorHeight()
    for _ in range(30):
        roll(sensor_height, 0.09)
    for _ in range(60):
        roll(sensor_height, 0.02)
    assert sensor_height.height == pytest.approx(0.02, abs=0.006)


def test_the_evidence_of_a_rolling_foot_moves_forward() -> None:
    cycle = Cycle()
    still = cycle.update(0.0, 0.0, (0.0, 0.0, GRAVITY), (0.0, 0.0, 0.0), None)
    rolling = cycle.update(0.03, 0.03, (0.0, 0.0, GRAVITY), (0.0, 0.1, 0.0), None)
    assert still.v_ref == (0.0, 0.0, 0.0)
    assert rolling.v_ref == pytest.approx((0.1 * cycle.sensor_height.height, 0.0, 0.0))
    not_rolling = Cycle(CycleSettings(rolls=False))
    assert not_rolling.update(0.0, 0.0, (0.0, 0.0, GRAVITY), (0.0, 0.1, 0.0), None).v_ref == (0.0, 0.0, 0.0)


numbers = st.floats(-20.0, 20.0)


@given(st.lists(st.tuples(st.floats(0.0, 0.25), *[numbers] * 6), min_size=1, max_size=60))
def test_whatever_is_measured_the_height_stays_that_of_a_sensor_on_a_foot(rows: list[tuple[float, ...]]) -> None:
    sensor_height = SensorHeight()
    for dt, ax, ay, az, wx, wy, wz in rows:
        sensor_height.roll(dt, (ax, ay, az), (wx, wy, wz), IDENTITY)
    sensor_height.end_stance()
    assert LOWEST_HEIGHT <= sensor_height.height <= HIGHEST_HEIGHT
