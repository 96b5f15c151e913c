"""The corrector of shoe sensing: linear removal of velocity and height errors (Sensors 16, 1809, 2016, sections
3.2 to 3.4), and what ours adds for joggers and landings."""

from __future__ import annotations

from collections.abc import Sequence
from math import inf, sin

import pytest
from hypothesis import strategies as st

from solepath.foot.stance.stance import Stance
from solepath.papers.shoe_sensing.additions import ShoeSensing
from solepath.types import Phase, Vec3
from solepath.types.vector import GRAVITY, IDENTITY, ZERO, from_rotation_vector, multiply

STILL = Stance(ZERO, 0.01, 0.0, Phase.STATIONARY)
MOVING = Stance(ZERO, inf, 9.0, None)
UNCERTAIN = Stance(ZERO, 0.03, 9.0, None)
DT = 0.01


class PlainCorrector(ShoeSensing):
    """Corrector that sees the end of a stance at once and leaves the tilt alone."""

    detector_delay = tilt_share = 0.0


def standing_corrector() -> ShoeSensing:
    """Return the corrector of a foot that has stood for a while."""
    one = PlainCorrector()
    one.start(IDENTITY, 0.02)
    feed_accelerations(one, [ZERO] * 20, STILL)
    return one


def feed_accelerations(one: ShoeSensing, accelerations: Sequence[Vec3], stance: Stance, t: float = 0.0) -> bool:
    """Feed samples with these accelerations without gravity, m/s^2, and with the same evidence."""
    corrected = False
    for k, (x, y, z) in enumerate(accelerations):
        one.predict(DT, (x, y, z + GRAVITY), ZERO)
        corrected = one.correct(t + k * DT, stance)
    return corrected


def feed_stride(one: ShoeSensing, length: float, height: float, drift: Vec3 = ZERO, seconds: float = 0.8) -> None:
    """Move the foot by `length` and `height` m with a sine of acceleration, plus a bias `drift`."""
    n = round(seconds / DT)
    # the second integral over T of a sin(2 pi t / T) is a T^2 / 2 pi
    a, u = (2.0 * 3.141592653589793 * way / (n * DT) ** 2 for way in (length, height))
    wave = [sin(2.0 * 3.141592653589793 * (k + 0.5) / n) for k in range(n)]
    dx, dy, dz = drift
    feed_accelerations(one, [(a * w + dx, dy, u * w + dz) for w in wave], MOVING)
    feed_accelerations(one, [ZERO] * 20, STILL)


def feed_flat_stride(one: ShoeSensing, length: float, height: float, turn: float = 0.0, pitch: float = 0.0) -> None:
    """Feed a stride and the foot-flat that ends it; `turn` is of the heading and `pitch` of the foot, rad, toe up."""
    start = one.position
    feed_stride(one, length, height)
    attitude, one.attitude = one.attitude, multiply(one.attitude, from_rotation_vector((0.0, -pitch, 0.0)))
    one.flat(start, turn)
    one.attitude = attitude


def test_a_constant_error_of_the_acceleration_leaves_the_foot_where_it_stood() -> None:
    # e~ = b: V = b t - e~ t = 0, so S = 0; without the removal 0.3 m/s^2 over 0.8 s makes 0.096 m
    one = standing_corrector()
    feed_accelerations(one, [(0.3, -0.2, 0.1)] * 80, MOVING)
    assert one.velocity[0] == pytest.approx(0.24, rel=0.01)
    assert one.position[0] == pytest.approx(0.096, rel=0.02)
    assert feed_accelerations(one, [(0.3, -0.2, 0.1)], STILL)
    assert one.velocity == ZERO
    assert one.position == pytest.approx((0.0, 0.0, 0.0), abs=1e-3)


def test_a_stride_with_a_linear_drift_of_velocity_is_as_long_as_it_was() -> None:
    one = standing_corrector()
    feed_stride(one, 1.2, 0.32, (0.3, 0.2, -0.2))
    assert one.position == pytest.approx((1.2, 0.0, 0.32), abs=5e-3)


def test_the_height_of_a_level_step_is_taken_out_and_that_of_a_stair_is_kept() -> None:
    for length, height, kept in ((1.2, 0.03, 0.0), (0.6, 0.32, 0.32), (0.6, -0.32, -0.32), (1.1, 0.16, 0.16)):
        one = standing_corrector()
        feed_flat_stride(one, length, height)
        assert one.position == pytest.approx((length, 0.0, kept), abs=0.015)
        assert one.stance_position == one.position


def test_what_level_steps_have_in_common_is_taken_off_the_stairs_that_follow() -> None:
    one = standing_corrector()
    for _ in range(20):
        feed_flat_stride(one, 1.2, 0.03)
    assert one.position[2] == pytest.approx(0.0, abs=0.01)
    assert one.level.rise_bias == pytest.approx(0.025, rel=0.1)
    feed_flat_stride(one, 0.6, 0.32 + 0.025 * 0.6)
    assert one.position[2] == pytest.approx(0.32, abs=0.015)


def test_an_uncertain_landing_is_corrected_by_the_certain_one_that_follows() -> None:
    sure, hasty = standing_corrector(), standing_corrector()
    n = 80
    wave = [9.0 * sin(2.0 * 3.141592653589793 * (k + 0.5) / n) for k in range(n)]
    swing: list[Vec3] = [(w, 0.0, 0.0) for w in wave]
    feed_accelerations(sure, swing, MOVING)
    feed_accelerations(sure, [ZERO] * 10, STILL)
    feed_accelerations(hasty, swing[:-5], MOVING)
    assert not feed_accelerations(hasty, swing[-5:-4], UNCERTAIN)  # nor is it reported: the last stance was certain
    assert hasty.standing
    assert abs(hasty.position[0] - sure.position[0]) > 0.02
    feed_accelerations(hasty, swing[-4:], UNCERTAIN)
    feed_accelerations(hasty, [ZERO] * 10, STILL)
    assert hasty.position == pytest.approx(sure.position, abs=2e-3)


numbers = st.floats(-500.0, 500.0)
evidence = st.sampled_from(
    (STILL, MOVING, UNCERTAIN, Stance(ZERO, 0.06, 1.0, None), Stance(ZERO, inf, 1.0, Phase.SWING))
)
