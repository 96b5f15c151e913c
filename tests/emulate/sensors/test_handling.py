"""The motion of an emulated hand is one motion: rates, forces and attitudes agree, and rests are rests."""

from __future__ import annotations

import numpy as np
import pytest
from attrs import evolve

from solepath import Foot, Site
from solepath.emulate.handling import CLUMSY, STEADY, Handling
from solepath.emulate.sensors.device import device_rng
from solepath.emulate.sensors.insole_device import Insole
from solepath.emulate.sensors.parts import LSM6DSOX
from solepath.emulate.wearers.turning import from_rotation_vectors, matrices, multiply_quaternions

RATE = 400.0


def test_rates_of_a_hand_integrate_to_its_attitude() -> None:
    hand = Handling(5)
    t = np.arange(0.0, 20.0, 1.0 / RATE)
    true = hand.kinematics(Foot.LEFT, t)
    attitude = true.attitude[:1]
    for turn in 0.5 * (true.rate[1:] + true.rate[:-1]) / RATE:
        attitude = multiply_quaternions(attitude, from_rotation_vectors(turn[None, :]))
    assert abs(float(np.sum(attitude * true.attitude[-1]))) == pytest.approx(1.0, abs=1e-6)


def test_force_is_acceleration_and_gravity_and_acceleration_is_the_slope_of_velocity() -> None:
    hand = Handling(6)
    t = np.arange(0.0, 10.0, 1.0 / RATE)
    true = hand.kinematics(Foot.LEFT, t)
    slope = np.gradient(true.velocity, t, axis=0)
    assert np.abs(slope - true.acceleration)[1:-1].max() < 0.5  # of up to 9 m/s^2, by the tremor of 12 Hz
    world = np.einsum("nij,nj->ni", matrices(true.attitude), true.force)
    assert np.allclose(world - true.acceleration, (0.0, 0.0, 9.80665))


def test_five_turns_are_turned_and_a_steady_hand_does_not_move_at_rest() -> None:
    hand = Handling(7, STEADY, pauses=2, axes=((1.0, 0.0, 0.0),))
    t = np.arange(0.0, hand.duration, 1.0 / RATE)
    true = hand.kinematics(Foot.LEFT, t)
    speed = np.linalg.norm(true.rate, axis=1)
    assert (speed < 1e-6).mean() > 0.3
    turned = abs(float(np.trapezoid(true.rate[:, 0], t))) / (2.0 * np.pi)
    assert 4.0 < turned < 6.0


def test_the_same_seed_gives_the_same_hand_and_another_another() -> None:
    t = np.arange(0.0, 5.0, 0.01)
    one, same, other = (Handling(seed).kinematics(Foot.LEFT, t).rate for seed in (8, 8, 9))
    assert np.array_equal(one, same) and not np.array_equal(one, other)


def test_the_hand_goes_to_the_orientations_that_are_given() -> None:
    ups = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, -1.0, 0.0]])
    hand = Handling(10, evolve(CLUMSY, off_face=0.0, wobble=0.0), turns=0.0, orientations=ups)
    for up, move in zip(ups, hand.moves[1::2], strict=True):
        pointing = matrices(move.attitude(np.array([move.start])))[0] @ up
        assert pointing == pytest.approx((0.0, 0.0, 1.0), abs=1e-9)


def test_a_specimen_keeps_what_is_its_own_of_a_bias() -> None:
    """With no change from day to day two days have the same bias; by default they have different ones."""
    means = []
    for change in (0.0, 1.0):
        acc, gyro = (evolve(one, specimen=3, bias_change=change, drift=0.0) for one in (LSM6DSOX.acc, LSM6DSOX.gyro))
        insole = Insole(cells=8, chip=evolve(LSM6DSOX, acc=acc, gyro=gyro))
        days = []
        for day in (1, 2):
            hand = Handling(11, STEADY, pauses=1, turns=0.0)
            samples = insole.samples(hand, Site.LEFT_FOOT, device_rng(day, Site.LEFT_FOOT))
            days.append(np.mean([one.acc for one in samples], axis=0))
        means.append(float(np.abs(days[0] - days[1]).max()))
    assert means[0] < 0.005 < 0.02 < means[1]
