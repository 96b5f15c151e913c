"""A sensor in an emulated hand: its calibration is as near the truth as it claims, or says what is missing."""

from __future__ import annotations

from math import cos, radians, sin

import numpy as np
import pytest
from attrs import evolve
from soak import soaked

from solepath import CalibrationError, Foot, Sample
from solepath.cli.calibrate.by_hand.sensor import fit_sensors, sensor_calibration
from solepath.emulate.sensors.parts import LSM6DSOX
from solepath_lab.emulated.by_hand import HandJob, hand_errors, handled, specimen
from solepath_lab.emulated.handling import CLUMSY, STEADY, Handling

APART = ~np.eye(3, dtype=np.bool_)


@pytest.fixture(scope="module")
def samples() -> list[Sample]:
    return handled(specimen(LSM6DSOX, 71), CLUMSY, 71, Foot.RIGHT)


def changed(
    samples: list[Sample], acc: float = 1.0, gyro: tuple[float, float, float] = (1.0, 1.0, 1.0)
) -> list[Sample]:
    """Return the samples with the specific force times `acc` and each axis of the rate times one of `gyro`."""
    result = []
    for sample in samples:
        force, rate = np.array(sample.acc) * acc, np.array(sample.gyro) * gyro
        result.append(evolve(sample, acc=tuple(force.tolist()), gyro=tuple(rate.tolist())))
    return result


@pytest.mark.parametrize("chip", ["LSM6DSOX", *soaked("MPU-9250")])
@pytest.mark.soak
def test_a_clumsy_hand_finds_scale_to_a_fifth_of_a_percent_and_axes_to_a_fifth_of_a_degree(chip: str) -> None:
    one = hand_errors(HandJob(chip, "clumsy", 72))
    assert one.gyro is not None and one.gyro_sigma is not None
    assert one.acc is not None and one.acc_sigma is not None
    assert np.abs(np.diag(one.gyro)).max() < 0.002
    assert np.abs(np.degrees(one.gyro[APART])).max() < 0.2
    assert np.abs(one.acc[:3]).max() < 0.005 and np.abs(np.degrees(one.acc[3:])).max() < 0.2
    # what it is worth: no error beyond four standard deviations, and none of these useless
    assert np.abs(one.gyro / one.gyro_sigma).max() < 4.0 and np.abs(one.acc / one.acc_sigma).max() < 4.0
    assert np.diag(one.gyro_sigma).max() < 0.002


@pytest.mark.soak
def test_gravity_and_ways_fit_better_with_the_calibration_than_without(samples: list[Sample]) -> None:
    (found,) = fit_sensors(samples)
    assert found.foot is Foot.RIGHT and found.pauses >= 12 and found.turned == (5, 5) and not found.notes
    assert found.gravity[1] < 0.1 * found.gravity[0] and found.closure[1] < 0.1 * found.closure[0]
    assert sensor_calibration([found]).sensors == {Foot.RIGHT: found.calibration}


@pytest.mark.soak
def test_a_rest_that_is_missing_is_named() -> None:
    """All rests with z within 25 degrees of up, and turns that keep it there."""
    tilts = [radians(25.0) * k / 12 for k in range(1, 13)]
    ups = np.array([[sin(a) * cos(2.4 * k), sin(a) * sin(2.4 * k), cos(a)] for k, a in enumerate(tilts)])
    hand = evolve(CLUMSY, off_face=radians(1.0), creep=radians(0.05))
    walked = handled_with(Handling(74, hand, turns=0.0, orientations=ups))
    with pytest.raises(CalibrationError, match=r"the accelerometer is not known.*axis down.* is missing"):
        fit_sensors(walked)


def handled_with(hand: Handling) -> list[Sample]:
    """Return the samples of a hand's motion, without errors of a chip."""
    return hand.samples(Foot.LEFT, 50.0, LSM6DSOX)


def test_too_few_times_at_rest_are_counted() -> None:
    with pytest.raises(CalibrationError, match="the left foot has 4 rests .* 9 are the least"):
        fit_sensors(handled_with(Handling(75, STEADY, pauses=4, turns=0.0)))


@pytest.mark.parametrize(
    ("acc", "gyro", "message"),
    [
        pytest.param(1.0 / 9.80665, (1.0, 1.0, 1.0), "its unit is not m/s\\^2", marks=pytest.mark.soak),
        (1.0, (1.0, 1.0, -1.0), "are axes mirrored or exchanged"),
    ],
)
def test_a_wrong_unit_and_a_mirrored_axis_are_named(
    samples: list[Sample], acc: float, gyro: tuple[float, float, float], message: str
) -> None:
    with pytest.raises(CalibrationError, match=message):
        fit_sensors(changed(samples, acc, gyro))
