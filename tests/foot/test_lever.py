"""The height of a sensor above what its foot rolls on, from the stances of a wearer nobody has measured."""

from __future__ import annotations

from math import cos, sin

import pytest
from attrs import evolve
from hypothesis import given
from hypothesis import strategies as st

from solepath.foot.stance.cycle import Cycle
from solepath.foot.stance.sensor_height import Lever
from solepath.types import Vec3
from solepath.types.vector import GRAVITY, IDENTITY, conjugate, normalise, rotate

DT = 0.005
ASKEW = normalise((0.3, -0.5, 0.7, 0.4))
"""Foot to sensor."""


def roll(lever: Lever, height: float, tilt: float = 0.0, amount: float = 0.25) -> None:
    """One stance of 0.3 s: the foot rolls forward faster and faster about a point of the ground, the sensor `height` m
    above it; the attitude is believed `tilt` rad off."""
    for k in range(60):
        t = k * DT
        pitch, rate, faster = amount * (t / 0.3) ** 3, amount * 3 * t**2 / 0.3**3, amount * 6 * t / 0.3**3
        attitude = (cos(pitch / 2), 0.0, sin(pitch / 2), 0.0)
        acc_world: Vec3 = (height * faster, 0.0, GRAVITY)
        sensor = rotate(ASKEW, rotate(conjugate(attitude), acc_world))
        gyro = rotate(ASKEW, (0.0, rate, 0.0))
        off = (cos((pitch + tilt) / 2), 0.0, sin((pitch + tilt) / 2), 0.0)
        w, x, y, z = off
        a, b, c, d = conjugate(ASKEW)
        believed = (
            w * a - x * b - y * c - z * d, w * b + x * a + y * d - z * c,
            w * c - x * d + y * a + z * b, w * d + x * c - y * b + z * a,
        )  # fmt: skip
        lever.roll(DT, sensor, gyro, believed)
    lever.lift()


@pytest.mark.parametrize("height", [0.0, 0.02, 0.08, 0.12])
@pytest.mark.parametrize("tilt", [0.0, 0.02])
def test_a_few_stances_tell_how_high_the_sensor_is(height: float, tilt: float) -> None:
    lever = Lever()
    for _ in range(5):
        roll(lever, height, tilt)
    assert lever.height == pytest.approx(height, abs=0.006)


def test_a_foot_that_only_stands_leaves_the_height_as_it_was() -> None:
    lever = Lever()
    for k in range(1000):
        lever.roll(0.01, (0.01 * (k % 3), 0.0, GRAVITY), (1e-4 * (k % 2), 0.0, 0.0), IDENTITY)
    lever.lift()
    assert lever.height == pytest.approx(lever.guess, abs=1e-3)


def test_a_sensor_that_is_moved_is_followed() -> None:
    lever = Lever()
    for _ in range(30):
        roll(lever, 0.09)
    for _ in range(60):
        roll(lever, 0.02)
    assert lever.height == pytest.approx(0.02, abs=0.006)


def test_a_rolling_foot_moves_forward_and_the_evidence_says_so() -> None:
    cycle = Cycle()
    still = cycle.update(0.0, 0.0, (0.0, 0.0, GRAVITY), (0.0, 0.0, 0.0), None)
    rolling = cycle.update(0.03, 0.03, (0.0, 0.0, GRAVITY), (0.0, 0.1, 0.0), None)
    assert still.v_ref == (0.0, 0.0, 0.0)
    assert rolling.v_ref == pytest.approx((0.1 * cycle.lever.height, 0.0, 0.0))
    without = evolve(Cycle(), rolls=False)
    assert without.update(0.0, 0.0, (0.0, 0.0, GRAVITY), (0.0, 0.1, 0.0), None).v_ref == (0.0, 0.0, 0.0)


numbers = st.floats(-20.0, 20.0)


@given(st.lists(st.tuples(st.floats(0.0, 0.25), *[numbers] * 6), min_size=1, max_size=60))
def test_whatever_is_measured_the_height_stays_that_of_a_sensor_on_a_foot(rows: list[tuple[float, ...]]) -> None:
    lever = Lever()
    for dt, ax, ay, az, wx, wy, wz in rows:
        lever.roll(dt, (ax, ay, az), (wx, wy, wz), IDENTITY)
    lever.lift()
    assert lever.lowest <= lever.height <= lever.highest
