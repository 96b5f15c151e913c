"""Level walks stay level, and slopes, kerbs and stairs keep their height."""

from __future__ import annotations

from functools import cache
from math import pi, radians

import numpy as np
import pytest
from attrs import evolve
from hypothesis import given, settings
from hypothesis import strategies as st
from ramp import Ramp
from walks import of

from solepath import Foot, Sample, Session, StrideTaken
from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.parts import LSM6DSOX, MPU6050, Imu
from solepath.emulate.wearers.motion import Kinematics
from solepath.emulate.wearers.shoe import IN_SOLE, ON_INSTEP, Mounting
from solepath.emulate.wearers.walker import Walker
from solepath.foot.navigate.error_state import ErrorStateFilter
from solepath.foot.navigate.level import LevelGround
from solepath.foot.settings import ErrorStateSettings
from solepath.recipes import DEFAULT, Recipe
from solepath.saving import codec
from solepath.types import Quat
from solepath.types.vector import IDENTITY, from_rotation_vector, multiply, normalise

UNCORRECTED = evolve(DEFAULT, corrector=ErrorStateFilter(ErrorStateSettings(level=False)))
STRIDE_LENGTH = 1.35
"""Length of a stride, m."""
HEIGHT_SIGMA = 0.02
"""Standard deviation of a stride's height in the filter, m."""


def pitched(angle: float, heading: float = 0.0, mounted: Quat = IDENTITY) -> Quat:
    """Return the attitude of a foot with this heading, toe up by `angle`; rad."""
    ahead = from_rotation_vector((0.0, -angle, 0.0))
    return normalise(multiply(from_rotation_vector((0.0, 0.0, heading)), multiply(ahead, mounted)))


def judge_heights(
    level: LevelGround,
    heights: list[float],
    grade: float = 0.0,
    rise_bias: float = 0.01,
    length: float = STRIDE_LENGTH,
    seed: int = 0,
) -> list[float]:
    """Return the heights that `level` estimates for strides that rise by `heights`, m.

    The ground slopes by `grade`; the sensor adds `rise_bias` for each metre and errs by a centimetre."""
    rng = np.random.default_rng(seed)
    estimated = []
    for height in heights:
        z = height + rise_bias * length + 0.01 * rng.standard_normal()
        attitude = pitched(grade + 0.01 * rng.standard_normal())
        estimated.append(level.judge((length, 0.0, z), 0.0, HEIGHT_SIGMA * HEIGHT_SIGMA, attitude)[0])
    return estimated


@pytest.mark.parametrize("rise_bias", [-0.03, -0.01, 0.0, 0.02, 0.03])
def test_level_strides_are_level_for_any_rise_bias(rise_bias: float) -> None:
    assert abs(sum(judge_heights(LevelGround(), [0.0] * 60, rise_bias=rise_bias))) < 0.12


@pytest.mark.parametrize("grade", [0.05, -0.05, 0.08, -0.12])
def test_a_ramp_after_level_strides_keeps_nine_tenths_of_its_height(grade: float) -> None:
    level = LevelGround()
    judge_heights(level, [0.0] * 8)
    on_ramp = judge_heights(level, [grade * STRIDE_LENGTH] * 12, grade=grade, seed=1)
    after = judge_heights(level, [0.0] * 12, seed=2)
    assert sum(on_ramp) == pytest.approx(12 * grade * STRIDE_LENGTH, rel=0.1)
    assert abs(sum(after)) < 0.1


@pytest.mark.parametrize("kerb", [0.10, -0.10, 0.15])
def test_a_single_kerb_keeps_its_height(kerb: float) -> None:
    level = LevelGround()
    judge_heights(level, [0.0] * 10)
    heights = judge_heights(level, [kerb, 0.0, 0.0, -kerb, 0.0, 0.0], seed=3)
    assert heights[0] == pytest.approx(kerb, abs=0.04)
    assert heights[3] == pytest.approx(-kerb, abs=0.04)
    assert max(abs(heights[k]) for k in (1, 2, 4, 5)) < 0.02


@pytest.mark.parametrize("riser", [0.10, 0.16, 0.20, -0.10, -0.17])
def test_stairs_keep_their_height_and_the_landing_between_them_is_level(riser: float) -> None:
    level = LevelGround()
    judge_heights(level, [0.0] * 6)
    first = judge_heights(level, [riser] + [2.0 * riser] * 5, rise_bias=0.0, length=0.6, seed=4)
    landing = judge_heights(level, [0.0] * 3, length=0.9, seed=5)
    assert sum(first) == pytest.approx(11 * riser, rel=0.06)
    assert max(abs(height) for height in landing) < 0.03


def test_a_stride_of_which_the_filter_is_unsure_must_rise_by_more_to_be_no_level_one() -> None:
    sure, unsure = LevelGround(), LevelGround()
    assert sure.judge((STRIDE_LENGTH, 0.0, 0.13), 0.0, 0.02**2, IDENTITY)[0] > 0.1
    assert unsure.judge((STRIDE_LENGTH, 0.0, 0.13), 0.0, 0.2**2, IDENTITY)[0] < 0.03


def test_a_walk_that_starts_on_a_ramp_is_level_again_some_strides_after_it() -> None:
    level = LevelGround()
    judge_heights(level, [0.05 * STRIDE_LENGTH] * 9, grade=0.05, rise_bias=0.0)
    judge_heights(level, [0.0] * 6, rise_bias=0.0, seed=1)
    assert abs(sum(judge_heights(level, [0.0] * 20, rise_bias=0.0, seed=2))) < 0.08


def test_a_ladder_and_a_foot_that_is_put_up_keep_their_height() -> None:
    """They rise without a horizontal displacement, which no level stride does."""
    level = LevelGround()
    judge_heights(level, [0.0] * 5)
    assert sum(judge_heights(level, [0.3] * 6, rise_bias=0.0, length=0.05)) == pytest.approx(1.8, rel=0.05)


@given(
    st.lists(st.tuples(*[st.floats(allow_nan=True, allow_infinity=True)] * 5), min_size=1, max_size=8),
    st.floats(-pi, pi),
)
@settings(max_examples=60)
def test_whatever_is_judged_the_state_stays_finite(rows: list[tuple[float, ...]], tilt: float) -> None:
    level = LevelGround()
    for x, y, z, turn, variance in rows:
        level.judge((x, y, z), turn, variance, pitched(tilt))
    assert codec.load(LevelGround, codec.save(level)) == level
    assert abs(judge_heights(level, [0.0])[0]) < 1.0


TILTED = Mounting(position=ON_INSTEP.position, attitude=from_rotation_vector((0.5, -0.4, 2.0)))


class OnRamp(Walker):
    """A walk over a ramp."""

    ramp = Ramp(7.0, 10.0, 0.0)

    def kinematics(self, foot: Foot, t: np.ndarray, mounting: Mounting = IN_SOLE) -> Kinematics:
        return self.ramp.under(super().kinematics(foot, t, mounting))


@cache
def walk_ramp(grade: float, mounting: Mounting, part: Imu, seed: int = 101) -> tuple[Sample, ...]:
    walker = OnRamp(Route().stand(2.0).walk(22.0, 1.3).stop(1.0), seed=seed)
    walker.ramp = evolve(OnRamp.ramp, grade=grade)
    return tuple(walker.samples(Foot.RIGHT, 100.0, part, mounting=mounting))


def strides_of(samples: tuple[Sample, ...], recipe: Recipe = DEFAULT) -> list[StrideTaken]:
    session = Session(recipe)
    return of(StrideTaken, session.feed(list(samples)) + session.finish())


@pytest.mark.parametrize("part", [LSM6DSOX, MPU6050], ids=lambda part: part.name)
@pytest.mark.parametrize("mounting", [IN_SOLE, TILTED], ids=["in the sole", "askew on the instep"])
def test_a_level_walk_ends_at_the_height_of_its_start(part: Imu, mounting: Mounting) -> None:
    samples = walk_ramp(0.0, mounting, part)
    assert abs(strides_of(samples)[-1].position[2]) < 0.05
    assert strides_of(samples)[-1].features.rise is not None


def test_the_uncorrected_height_is_reported_beside_the_corrected_one() -> None:
    samples = walk_ramp(0.0, IN_SOLE, MPU6050)
    for gated, ungated in zip(strides_of(samples), strides_of(samples, UNCORRECTED), strict=True):
        assert ungated.features.rise == ungated.height_change
        assert gated.features.rise == pytest.approx(ungated.height_change, abs=0.02)
        assert gated.displacement[:2] == pytest.approx(ungated.displacement[:2], abs=1e-6)


@pytest.mark.parametrize("grade", [0.06, -0.06, 0.1])
def test_a_ramp_that_is_walked_keeps_its_height(grade: float) -> None:
    strides = strides_of(walk_ramp(grade, ON_INSTEP, LSM6DSOX))
    assert strides[-1].position[2] == pytest.approx(10.0 * grade, rel=0.15)


def test_a_sensor_on_a_ramp_measures_what_it_does() -> None:
    ramp, t = Ramp(1.0, 2.0, 0.1), np.linspace(1.0, 6.0, 20001)
    walker = Walker(Route().stand(1.0).walk(5.0).stop(1.0), seed=101)
    level = walker.kinematics(Foot.LEFT, t, ON_INSTEP)
    on_ramp = ramp.under(level)
    np.testing.assert_allclose(np.gradient(on_ramp.position, t, axis=0)[5:-5], on_ramp.velocity[5:-5], atol=2e-3)
    angle = np.arctan(ramp.ground(level.position[:, 0])[1])
    turned = np.gradient(angle, t)
    assert float(np.max(angle)) == pytest.approx(0.0997, abs=1e-3)
    # the rates differ by the turn toe up, about y of the world
    assert np.linalg.norm(on_ramp.rate - level.rate, axis=1)[5:-5] == pytest.approx(np.abs(turned)[5:-5], abs=2e-2)
    assert ramp.ground(np.array([-50.0, 50.0]))[0] == pytest.approx([0.0, ramp.height], abs=1e-9)


def test_four_floors_of_stairs_up_and_down_end_at_the_height_of_their_start() -> None:
    route = Route().stand(2.0).walk(6.0)
    for up in (True, False):
        for _ in range(4):
            route = route.stairs(10, up).turn(radians(180), 0.7).stairs(10, up).turn(radians(180), 0.7)
        route = route.walk(3.0).turn(pi, 0.8)
    walker = Walker(route.stop(1.0), seed=101)
    strides = strides_of(tuple(walker.samples(Foot.RIGHT, 100.0, LSM6DSOX)))
    assert max(stride.position[2] for stride in strides) == pytest.approx(12.8, abs=0.3)
    assert abs(strides[-1].position[2]) < 0.3
