"""Emulated sensors have the errors of their data sheets."""

from math import pi, radians, sqrt

import numpy as np
import pytest
from attrs import evolve

from solepath.emulate.sensors.parts import (
    BMP280,
    CRE_CC02,
    LSM6DSOX,
    MPU9250,
    RESISTIVE,
    T5400,
    AttitudeErrors,
    BarometerErrors,
    TriadErrors,
)
from solepath.emulate.sensors.sensors import (
    add_errors,
    air_pressure,
    instants,
    low_pass,
    measure,
    read_attitudes,
    read_barometer,
    read_cells,
    take_samples,
    to_counts,
)
from solepath.emulate.sensors.sensortags import T5400_CALIBRATION, raw_barometer_values
from solepath.emulate.wearers.turning import multiply_quaternions
from solepath.types.vector import from_rotation_vector, multiply
from solepath_lab.emulated.boot import INERTIACUBE3, TILTED_INERTIACUBE3


@pytest.mark.parametrize("part", [LSM6DSOX.acc, LSM6DSOX.gyro, MPU9250.acc, MPU9250.gyro])
def test_the_white_noise_is_that_of_the_data_sheet(part: TriadErrors) -> None:
    """Allan deviation of white noise of density d (per sqrt(Hz), one-sided) at tau is d / sqrt(2 tau)."""
    sampling = instants(0.0, 0.01, 20000)
    still = np.zeros((len(sampling.fine_times), 3))
    noisy = low_pass(add_errors(still, sampling, part, np.random.default_rng(1)), sampling.rate, 50.0)
    means = take_samples(noisy, sampling).reshape(-1, 20, 3).mean(axis=1)  # of tau = 0.2 s
    deviation = np.sqrt(0.5 * np.mean(np.diff(means, axis=0) ** 2, axis=0))
    assert deviation == pytest.approx(np.full(3, part.density / sqrt(0.4)), rel=0.12)


def test_the_noise_per_sample_is_the_0_1_degrees_a_second_that_the_sheet_gives_at_92_hz() -> None:
    sampling = instants(0.0, 1.0 / 400.0, 20000)
    still = np.zeros((len(sampling.fine_times), 3))
    noisy = add_errors(still, sampling, evolve(MPU9250.gyro, drift=0.0), np.random.default_rng(2))
    passed = take_samples(low_pass(noisy, sampling.rate, 92.0), sampling)[100:]
    assert passed.std(axis=0) == pytest.approx(np.full(3, radians(0.1)), rel=0.1)


def test_counts_are_rounded_and_stop_at_full_scale() -> None:
    sampling = instants(0.0, 0.01, 5)
    ramp = np.outer(np.ones(len(sampling.fine_times)), [1.26, -50.0, 39.9])
    eight = TriadErrors(density=0.0, bias=0.0, drift=0.0, scale=0.0, cross=0.0, bandwidth=1e9, bits=8)
    full, tenth = (
        to_counts(measure(k * ramp, sampling, eight, np.random.default_rng(1)), eight, 0.25) for k in (1.0, 0.1)
    )
    assert full.counts.tolist() == [[5, -128, 127]] * 5 and full.saturated.all()
    assert not tenth.saturated.any()


def test_a_low_pass_keeps_what_is_slow_and_halves_the_power_at_its_corner() -> None:
    t = np.arange(0.0, 4.0, 1.0 / 800.0)
    for frequency, gain in ((1.0, 1.0), (40.0, sqrt(0.5)), (200.0, 0.04)):
        wave = np.sin(2 * pi * frequency * t)[:, None]
        assert low_pass(wave, 800.0, 40.0)[800:].std() / wave.std() == pytest.approx(gain, abs=0.03)
    sampling = instants(0.0123, 0.031, 50)
    assert take_samples(sampling.fine_times[:, None], sampling)[:, 0] == pytest.approx(sampling.times)


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


@pytest.mark.parametrize("part", [INERTIACUBE3, CRE_CC02])
def test_an_attitude_has_the_slow_errors_of_its_sheet_from_the_start(part: AttitudeErrors) -> None:
    t = np.arange(0.0, 20.0, 0.5)
    true = np.tile((1.0, 0.0, 0.0, 0.0), (len(t), 1))
    read = np.stack([read_attitudes(true, t, part, 0.0, np.random.default_rng(k)) for k in range(300)])
    assert np.linalg.norm(read, axis=2) == pytest.approx(1.0)
    for moment in (0, -1):
        tilt, heading = 2.0 * read[:, moment, 1:3].std(), 2.0 * read[:, moment, 3].std()
        assert tilt == pytest.approx(part.tilt, rel=0.1) and heading == pytest.approx(part.heading, rel=0.1)


def test_a_steady_tilt_stays_about_the_same_direction_of_the_world_whichever_way_the_sensor_points() -> None:
    t = np.arange(0.0, 20_000.0, 100.0)
    yaw = 0.3 * t
    true = np.stack([np.cos(0.5 * yaw), 0.0 * t, 0.0 * t, np.sin(0.5 * yaw)], axis=1)
    means = []
    for k in range(40):
        read = read_attitudes(true, t, TILTED_INERTIACUBE3, 0.0, np.random.default_rng(k))
        # the part of the read attitude that remains when the true turn is undone, on the world's side
        error = multiply_quaternions(read, true * (1.0, -1.0, -1.0, -1.0))
        means.append(2.0 * error[:, 1:].mean(axis=0))
    tilt, heading = np.std([mean[:2] for mean in means]), np.std([mean[2] for mean in means])
    assert tilt == pytest.approx(TILTED_INERTIACUBE3.steady_tilt, rel=0.2)
    assert heading < 0.3 * TILTED_INERTIACUBE3.heading


def test_a_device_with_another_north_turns_the_world_about_the_vertical() -> None:
    part = AttitudeErrors("ideal", tilt=0.0, heading=0.0)
    read = read_attitudes(np.array([[0.8, 0.6, 0.0, 0.0]]), np.zeros(1), part, 0.5, np.random.default_rng(1))[0]
    turned = multiply(from_rotation_vector((0.0, 0.0, -0.5)), (0.8, 0.6, 0.0, 0.0))
    assert tuple(read.tolist()) == pytest.approx(turned)


@pytest.mark.parametrize("part", [BMP280, T5400])
def test_three_metres_change_a_barometer_by_36_pascal(part: BarometerErrors) -> None:
    assert air_pressure(np.array([0.0]))[0] == 101325.0
    t = np.arange(0.0, 60.0, 1.0)
    low, high = (read_barometer(np.full(60, h), t, part, np.random.default_rng(4)) for h in (0.0, 3.0))
    assert (low - high).mean() == pytest.approx(36.0, abs=0.5)
    assert np.diff(low).std() / sqrt(2) == pytest.approx(part.noise, rel=0.35)


def test_the_raw_air_of_a_t5400_gives_the_pressure_back() -> None:
    for height in (-20.0, 0.0, 3.0, 400.0):
        pascal = float(air_pressure(np.array([height]))[0])
        raw = raw_barometer_values(pascal)
        assert T5400_CALIBRATION.pascal(**raw) == pytest.approx(pascal, abs=2.0)
        celsius = T5400_CALIBRATION.c1 * raw["temperature"] / 2**24 + T5400_CALIBRATION.c2 / 2**10  # protocol/cc2541.md
        assert celsius == pytest.approx(24.0, abs=0.1)
