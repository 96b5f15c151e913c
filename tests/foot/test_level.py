"""Level walks stay level, and slopes, kerbs and stairs keep their height."""

from __future__ import annotations

from functools import cache
from math import pi, radians

import numpy as np
import pytest
from attrs import evolve
from ramp import Ramp
from walks import of

from solepath import Foot, Sample, Session, StrideTaken
from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.parts import LSM6DSOX, MPU6050, Imu
from solepath.emulate.wearers.motion import Kinematics
from solepath.emulate.wearers.shoe import IN_SOLE, ON_INSTEP, Mounting
from solepath.emulate.wearers.walker import Walker
from solepath.foot.navigate.error_state import ErrorStateFilter
from solepath.foot.settings import ErrorStateSettings
from solepath.recipes import DEFAULT, Recipe
from solepath.types.vector import from_rotation_vector

UNCORRECTED = evolve(DEFAULT, corrector=ErrorStateFilter(ErrorStateSettings(level=False)))


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


@pytest.mark.parametrize("grade", [-0.06, 0.1])
def test_a_ramp_that_is_walked_keeps_its_height(grade: float) -> None:
    strides = strides_of(walk_ramp(grade, ON_INSTEP, LSM6DSOX))
    assert strides[-1].position[2] == pytest.approx(10.0 * grade, rel=0.15)


@pytest.mark.soak
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
