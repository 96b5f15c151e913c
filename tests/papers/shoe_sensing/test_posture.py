"""Posture by the vector product of gravity, Runge and Kutta's quaternion: Sensors 16, 1809, 2016, section 3.2."""

from __future__ import annotations

from math import atan, cos, exp, sin, tan

import pytest
from hypothesis import strategies as st

from solepath.foot.stance.stance import Stance
from solepath.papers.shoe_sensing.posture import INITIAL_GAIN, INITIAL_TIME, gravity_error, turn
from solepath.papers.shoe_sensing.printed import GatedTilt
from solepath.types import Phase, Quat, Vec3
from solepath.types.vector import GRAVITY, IDENTITY, ZERO, from_rotation_vector, levelling, multiply, normalise, rotate

STILL = Stance(ZERO, 0.01, 0.0, Phase.STATIONARY)
PITCH = 0.4
"""Angle about y, rad."""


def up_of(q: Quat) -> Vec3:
    """Return the specific force at rest of a sensor with this attitude, m/s^2."""
    return rotate((q[0], -q[1], -q[2], -q[3]), (0.0, 0.0, GRAVITY))


def test_the_vector_product_is_the_axis_and_the_sine_of_the_error() -> None:
    # the sensor is pitched, Q does not know it: gb = z, g'R = (-sin, 0, cos), gb x g'R = (0, -sin, 0)
    force = up_of(from_rotation_vector((0.0, PITCH, 0.0)))
    assert gravity_error(IDENTITY, force) == pytest.approx((0.0, -sin(PITCH), 0.0))
    assert gravity_error(IDENTITY, (0.0, 0.0, 0.0)) == (0.0, 0.0, 0.0)


def test_feedback_with_the_papers_sign_turns_towards_gravity() -> None:
    force = up_of(from_rotation_vector((0.0, PITCH, 0.0)))
    ex, ey, ez = gravity_error(IDENTITY, force)
    rate = (-ex, -ey, -ez)  # gyro' = gyro - Kp e, of a gyroscope that reads nothing, Kp = 1
    after = gravity_error(turn(IDENTITY, rate, rate, 0.1), force)
    assert abs(after[1]) < abs(ey)


def first_attitude(force: Vec3, seconds: float = INITIAL_TIME) -> Quat:
    """Return the attitude of the printed corrector after so many seconds of samples at rest."""
    one = GatedTilt()
    one.start(levelling(force), 0.02)
    for _ in range(round(seconds / 0.01)):
        one.predict(0.01, force, (0.0, 0.0, 0.0))
        one.correct(0.0, STILL)
    return one.attitude


def test_the_error_falls_as_its_half_tangent_does() -> None:
    # a' = -Kp sin a has tan(a / 2) = tan(a0 / 2) exp(-Kp t)
    force = up_of(from_rotation_vector((1.0, 0.0, 0.0)))
    left = gravity_error(first_attitude(force, 1.0), force)[0]
    assert abs(left) == pytest.approx(sin(2.0 * atan(tan(0.5) * exp(-INITIAL_GAIN))), rel=0.03)


directions = st.tuples(st.floats(-1.0, 1.0), st.floats(-1.0, 1.0), st.floats(-1.0, 1.0)).filter(
    lambda v: sum(x * x for x in v) > 1e-3
)


def test_one_step_of_a_constant_rate_has_four_terms_of_the_series() -> None:
    # half of 0.2 rad: k1 + 2 k2 + 2 k3 + k4 makes 1 - a^2/2 + a^4/24 and a - a^3/6
    a = 0.1
    expected = normalise((1.0 - a**2 / 2 + a**4 / 24, 0.0, 0.0, a - a**3 / 6))
    assert turn(IDENTITY, (0.0, 0.0, 2.0), (0.0, 0.0, 2.0), 0.1) == pytest.approx(expected, abs=1e-15)


def test_a_rate_that_grows_counts_with_its_mean() -> None:
    q = turn(IDENTITY, (0.0, 0.0, 0.0), (0.0, 2.0, 0.0), 0.1)
    assert q == pytest.approx((cos(0.05), 0.0, sin(0.05), 0.0), abs=1e-6)


def test_slow_samples_of_a_fast_turn_are_turned_exactly() -> None:
    start = normalise((0.9, 0.1, 0.3, -0.2))
    expected = multiply(start, from_rotation_vector((0.0, 2.0, 0.0)))
    assert turn(start, (0.0, 20.0, 0.0), (0.0, 20.0, 0.0), 0.1) == pytest.approx(expected)
