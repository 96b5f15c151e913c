"""A standing pose with seven sensors, and the lengths of the limbs by stature or as measured."""

from __future__ import annotations

from functools import cache

import pytest

from solepath.calibration import CalibrationError, Limbs
from solepath.emulate.routes.laps import straight
from solepath.emulate.sensors.suit import limb_samples
from solepath.emulate.wearers.walker import Walker
from solepath.papers.walking_modes.limbs.limbs import SEGMENTS
from solepath.papers.walking_modes.limbs.standing import check_standing, limbs_of
from solepath.types import Sample, Site
from solepath.types.attrs import evolve


@cache
def samples() -> tuple[Sample, ...]:
    """Return two seconds of standing and some steps."""
    return tuple(limb_samples(Walker(straight(3.0), seed=4), 50.0, seed=4))


def test_who_stands_with_seven_sensors_may_walk_on() -> None:
    stood = check_standing([sample for sample in samples() if sample.t < 1.5])
    assert [sensor.site for sensor in stood] == list(SEGMENTS)
    assert all(sensor.tilt < 0.6 and not sensor.own_world for sensor in stood)


def test_a_sensor_that_is_not_worn_is_named() -> None:
    with pytest.raises(CalibrationError, match="no attitude of the left shank"):
        check_standing([sample for sample in samples() if sample.site is not Site.LEFT_SHANK])


def test_who_only_walks_has_no_standing_pose() -> None:
    with pytest.raises(CalibrationError, match="never stood still for 0.5 s"):
        check_standing([sample for sample in samples() if 2.5 < sample.t < 4.0])


def test_sensors_without_attitudes_stand_by_gravity() -> None:
    bare = [evolve(sample, quat=None) for sample in samples() if sample.t < 1.9]
    assert all(sensor.own_world for sensor in check_standing(bare))


def test_lengths_follow_the_stature_unless_they_were_measured() -> None:
    assert limbs_of(1.75) == Limbs()
    tall = limbs_of(1.925, spines=0.25, shank=0.47)
    assert (tall.hip_width, tall.thigh, tall.shank) == pytest.approx((0.18, 1.1 * Limbs().thigh, 0.47))
