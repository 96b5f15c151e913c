"""Emulated sensors have the errors of their data sheets."""

from math import pi, radians, sqrt

import numpy as np
import pytest
from attrs import evolve

from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.parts import (
    BMP280,
    CRE_CC02,
    INERTIACUBE3,
    KXTJ9_IMU3000,
    LSM6DSOX,
    MOVELLA_DOT,
    MPU9250,
    RESISTIVE,
    T5400,
    TILTED_INERTIACUBE3,
    AttitudeErrors,
    BarometerErrors,
    Imu,
    TriadErrors,
)
from solepath.emulate.sensors.sensors import (
    add_errors,
    air_pressure,
    instants,
    low_pass,
    measure,
    random_drift,
    read_attitudes,
    read_barometer,
    read_cells,
    take_samples,
    to_counts,
)
from solepath.emulate.wearers.turning import multiply_quaternions
from solepath.emulate.wearers.walker import Walker
from solepath.types import Foot
from solepath.types.vector import GRAVITY, from_rotation_vector, multiply


def allan_deviation(values: np.ndarray, rate: float, tau: float) -> np.ndarray:
    """Return the two-sample deviation of averages over `tau` s, for each axis."""
    size = int(tau * rate)
    means = values[: len(values) // size * size].reshape(-1, size, values.shape[1]).mean(axis=1)
    return np.sqrt(0.5 * np.mean(np.diff(means, axis=0) ** 2, axis=0))


@pytest.mark.parametrize("part", [LSM6DSOX.acc, LSM6DSOX.gyro, MPU9250.acc, MPU9250.gyro])
def test_the_white_noise_is_that_of_the_data_sheet(part: TriadErrors) -> None:
    """Allan deviation of white noise of density d (per sqrt(Hz), one-sided) at tau is d / sqrt(2 tau)."""
    sampling = instants(0.0, 0.01, 30000)
    still = np.zeros((len(sampling.fine_times), 3))
    noisy = take_samples(
        low_pass(add_errors(still, sampling, part, np.random.default_rng(1)), sampling.rate, 50.0), sampling
    )
    for tau in (0.2, 0.5):
        assert allan_deviation(noisy, 100.0, tau) == pytest.approx(np.full(3, part.density / sqrt(2 * tau)), rel=0.12)


def test_the_noise_per_sample_fits_the_bandwidth() -> None:
    """A second-order Butterworth passes the noise of 1.11 times its corner frequency."""
    part = MPU9250.gyro
    sampling = instants(0.0, 1.0 / 400.0, 40000)
    steady = evolve(part, drift=0.0)
    noisy = low_pass(
        add_errors(np.zeros((len(sampling.fine_times), 3)), sampling, steady, np.random.default_rng(2)),
        sampling.rate,
        92.0,
    )
    passed = take_samples(noisy, sampling)[100:]
    assert passed.std(axis=0) == pytest.approx(np.full(3, part.density * sqrt(1.11 * 92.0)), rel=0.05)
    # The sheet's own total is 0.1 degrees/s rms at 92 Hz.
    assert passed.std(axis=0) == pytest.approx(np.full(3, radians(0.1)), rel=0.1)


def test_a_bias_wanders_slowly_and_stays_bounded() -> None:
    path = random_drift(np.arange(0.0, 20000.0, 1.0), 300.0, 4, np.random.default_rng(3))
    assert path[0] == pytest.approx(0.0)
    assert path.std() == pytest.approx(1.0, rel=0.2)
    assert np.diff(path[::30], axis=0).std() == pytest.approx(sqrt(2.0 * 30.0 / 300.0), rel=0.1)
    assert np.abs(np.diff(path, axis=0)).max() < 0.1


def test_counts_are_rounded_and_stop_at_full_scale() -> None:
    sampling = instants(0.0, 0.01, 5)
    ramp = np.outer(np.ones(len(sampling.fine_times)), [1.26, -50.0, 39.9])
    eight = TriadErrors(density=0.0, bias=0.0, drift=0.0, scale=0.0, cross=0.0, bandwidth=1e9, bits=8)
    found = to_counts(measure(ramp, sampling, eight, np.random.default_rng(1)), eight, 0.25)
    assert found.counts.tolist() == [[5, -128, 127]] * 5
    assert found.saturated.all()
    unsaturated = to_counts(measure(0.1 * ramp, sampling, eight, np.random.default_rng(1)), eight, 0.25)
    assert not unsaturated.saturated.any()


def test_a_low_pass_keeps_what_is_slow_and_halves_the_power_at_its_corner() -> None:
    t = np.arange(0.0, 4.0, 1.0 / 800.0)
    for frequency, gain in ((1.0, 1.0), (40.0, sqrt(0.5)), (200.0, 0.04)):
        wave = np.sin(2 * pi * frequency * t)[:, None]
        passed = low_pass(wave, 800.0, 40.0)[800:]
        assert passed.std() / wave.std() == pytest.approx(gain, abs=0.03)


def test_samples_are_taken_at_the_times_of_the_clock() -> None:
    sampling = instants(0.0123, 0.031, 50)
    assert take_samples(sampling.fine_times[:, None], sampling)[:, 0] == pytest.approx(sampling.times)
    assert sampling.rate >= 800.0


@pytest.mark.parametrize("part", [LSM6DSOX, MPU9250, KXTJ9_IMU3000])
def test_imperfect_samples_stay_near_the_exact_ones_at_rest(part: Imu) -> None:
    walker = Walker(Route().stand(3.0))
    exact, found = walker.samples(Foot.LEFT, 100.0), walker.samples(Foot.LEFT, 100.0, part)
    assert [s.t for s in exact] == pytest.approx([s.t for s in found])
    off = np.array([s.acc for s in found]) - np.array([s.acc for s in exact])
    turn = np.array([s.gyro for s in found])
    assert np.abs(off.mean(axis=0)).max() < 4 * (part.acc.bias + 2 * part.acc.scale * GRAVITY)
    assert np.abs(turn.mean(axis=0)).max() < 4 * part.gyro.bias + part.gyro.g_effect * 10
    assert np.abs(off).max() > 0.0


def test_cells_have_gain_preload_noise_and_an_end() -> None:
    t = np.arange(0.0, 20.0, 0.01)
    loads = np.zeros((len(t), 50))
    loads[1000:] = 100.0
    found = read_cells(loads, t, RESISTIVE, 0.05, np.random.default_rng(1)).counts * 0.05
    rest, pressed = found[:1000].mean(axis=0), found[1100:].mean(axis=0)
    assert rest.mean() == pytest.approx(RESISTIVE.preload, rel=0.35)
    assert ((pressed - rest) / 100.0 - 1.0).std() == pytest.approx(RESISTIVE.gain, rel=0.3)
    assert found[1100:].std(axis=0).mean() == pytest.approx(RESISTIVE.noise, rel=0.1)
    crushed = read_cells(loads * 10.0, t, RESISTIVE, 0.05, np.random.default_rng(1))
    assert crushed.counts.max() == 4095 and crushed.saturated[1100:].all() and not crushed.saturated[:999].any()


@pytest.mark.parametrize("part", [INERTIACUBE3, CRE_CC02, MOVELLA_DOT])
def test_an_attitude_has_the_slow_errors_of_its_sheet_from_the_start(part: AttitudeErrors) -> None:
    t = np.arange(0.0, 20.0, 0.1)
    true = np.tile((1.0, 0.0, 0.0, 0.0), (len(t), 1))
    read = np.stack([read_attitudes(true, t, part, 0.0, np.random.default_rng(k)) for k in range(300)])
    assert np.linalg.norm(read, axis=2) == pytest.approx(1.0)
    for moment in (0, -1):
        tilt, heading = 2.0 * read[:, moment, 1:3].std(), 2.0 * read[:, moment, 3].std()
        assert tilt == pytest.approx(part.tilt, rel=0.1) and heading == pytest.approx(part.heading, rel=0.1)
    assert np.abs(np.diff(2.0 * read[:, :, 1:], axis=1)).max() < 0.1 * max(part.tilt, part.heading)


def test_a_steady_tilt_stays_about_the_same_direction_of_the_world_whichever_way_the_sensor_points() -> None:
    t = np.arange(0.0, 20_000.0, 10.0)
    yaw = 0.3 * t
    true = np.stack([np.cos(0.5 * yaw), 0.0 * t, 0.0 * t, np.sin(0.5 * yaw)], axis=1)
    means = []
    for k in range(60):
        read = read_attitudes(true, t, TILTED_INERTIACUBE3, 0.0, np.random.default_rng(k))
        # the part of the read attitude that remains when the true turn is undone, on the world's side
        error = multiply_quaternions(read, true * (1.0, -1.0, -1.0, -1.0))
        means.append(2.0 * error[:, 1:].mean(axis=0))
    tilt, heading = np.std([mean[:2] for mean in means]), np.std([mean[2] for mean in means])
    # five hours are 670 times the correlation time of what varies
    assert tilt == pytest.approx(TILTED_INERTIACUBE3.steady_tilt, rel=0.2)
    assert heading < 0.3 * TILTED_INERTIACUBE3.heading


def test_a_device_with_another_north_turns_the_world_about_the_vertical() -> None:
    part = AttitudeErrors("ideal", tilt=0.0, heading=0.0)
    true = np.array([[0.8, 0.6, 0.0, 0.0]])
    w, x, y, z = read_attitudes(true, np.zeros(1), part, 0.5, np.random.default_rng(1))[0].tolist()
    assert (w, x, y, z) == pytest.approx(multiply(from_rotation_vector((0.0, 0.0, -0.5)), (0.8, 0.6, 0.0, 0.0)))


@pytest.mark.parametrize("part", [BMP280, T5400])
def test_three_metres_change_a_barometer_by_36_pascal(part: BarometerErrors) -> None:
    assert air_pressure(np.array([0.0]))[0] == 101325.0
    t = np.arange(0.0, 60.0, 1.0)
    low, high = (read_barometer(np.full(60, h), t, part, np.random.default_rng(4)) for h in (0.0, 3.0))
    assert (low - high).mean() == pytest.approx(36.0, abs=0.5)
    assert np.diff(low).std() / sqrt(2) == pytest.approx(part.noise, rel=0.35)
