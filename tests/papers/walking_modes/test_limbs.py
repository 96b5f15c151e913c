"""The chain of seven attitudes, equation (7) of Gong et al. 2023, against poses worked out by hand."""

from __future__ import annotations

from math import cos, pi, radians, sin

import numpy as np
import pytest
from hypothesis import strategies as st

from solepath.calibration import Limbs
from solepath.papers.walking_modes.limbs.limbs import SEGMENTS, LowerLimbs, joints
from solepath.papers.walking_modes.settings import ModesSettings
from solepath.types import Foot, Quat, Site, Vec3
from solepath.types.vector import IDENTITY, conjugate, from_rotation_vector, from_yaw, multiply, normalise, rotate

LIMBS = Limbs(hip_width=0.2, thigh=0.4, shank=0.45, foot=0.2, ankle_height=0.1)
SETTINGS = ModesSettings(limbs=LIMBS)
HIP: Vec3 = (0.0, 0.1, 0.0)


def pitch(degrees: float) -> Quat:
    """Return a rotation about the axis to the left, which tilts the upward axis forward."""
    return from_rotation_vector((0.0, radians(degrees), 0.0))


def test_who_stands_straight_has_the_ends_of_the_feet_below_and_before_the_hips() -> None:
    assert joints(IDENTITY, IDENTITY, IDENTITY, IDENTITY, HIP, LIMBS)[3] == pytest.approx((0.2, 0.1, -0.95))


def test_a_thigh_lifted_to_the_front_moves_the_shank_and_the_foot_along() -> None:
    # thigh horizontal, pointing ahead; shank down, foot level
    end = joints(IDENTITY, pitch(-90), IDENTITY, IDENTITY, HIP, LIMBS)[3]
    assert end == pytest.approx((0.4 + 0.2, 0.1, -0.55))


def test_a_leg_swung_back_by_30_degrees_with_the_foot_on_it() -> None:
    end = joints(IDENTITY, pitch(30), pitch(30), pitch(30), HIP, LIMBS)[3]
    c, s = cos(pi / 6), sin(pi / 6)
    assert end == pytest.approx((-0.95 * s + 0.2 * c, 0.1, -0.95 * c - 0.2 * s))


def test_a_pelvis_turned_left_moves_its_left_hip_back() -> None:
    end = joints(from_yaw(pi / 2), IDENTITY, IDENTITY, IDENTITY, HIP, LIMBS)[3]
    assert end == pytest.approx((0.2 - 0.1, 0.0, -0.95))


quaternions = st.tuples(*[st.floats(-1.0, 1.0)] * 4).filter(lambda q: sum(x * x for x in q) > 0.01).map(normalise)


def stood(chain: LowerLimbs, mounted: dict[Site, Quat], segments: dict[Site, Quat] | None = None) -> None:
    """Feed 0.6 s of attitudes at 50 Hz from sensors whose mountings in their segments are `mounted`."""
    for k in range(31):
        for site in SEGMENTS:
            turned = IDENTITY if segments is None else segments.get(site, IDENTITY)
            chain.add_attitude(site, 0.02 * k, multiply(turned, mounted[site]))


MOUNTINGS = {site: normalise((1.0, 0.1 * k, -0.2 * k, 0.3)) for k, site in enumerate(SEGMENTS)}


def swing_left_leg(chain: LowerLimbs, t: float, world: Quat = IDENTITY) -> None:
    """The left leg as one, by 30 degrees, which the chain knows; `world`: how that of the thigh's sensor is turned."""
    for site in (Site.LEFT_THIGH, Site.LEFT_SHANK, Site.LEFT_FOOT):
        attitude = multiply(pitch(30), MOUNTINGS[site])
        chain.add_attitude(site, t, multiply(world, attitude) if site is Site.LEFT_THIGH else attitude)
    end = joints(IDENTITY, pitch(30), pitch(30), pitch(30), HIP, LIMBS)[3]
    assert chain.end(Foot.LEFT, t) == pytest.approx(end)


def test_standing_shows_how_every_sensor_sits_on_its_segment() -> None:
    chain = LowerLimbs(SETTINGS)
    stood(chain, MOUNTINGS)
    assert chain.aligned
    assert chain.end(Foot.LEFT, 0.6) == pytest.approx((0.2, 0.1, -0.95))
    assert chain.end(Foot.RIGHT, 0.6) == pytest.approx((0.2, -0.1, -0.95))
    swing_left_leg(chain, 0.62)
    assert chain.height(Foot.LEFT, 0.62) == pytest.approx(-0.95 * cos(pi / 6))


def test_who_does_not_stand_still_is_not_aligned() -> None:
    chain = LowerLimbs(SETTINGS)
    for k in range(100):
        for site in SEGMENTS:
            chain.add_attitude(site, 0.02 * k, pitch(3.0 * k) if site is Site.LEFT_SHANK else IDENTITY)
    assert not chain.aligned


def test_the_first_step_shows_the_wearers_heading_in_the_world_of_the_sensors() -> None:
    north = 2.0
    chain = LowerLimbs(SETTINGS)
    away = {site: multiply(from_yaw(north), q) for site, q in MOUNTINGS.items()}
    stood(chain, away)
    for site, lean in ((Site.LEFT_THIGH, -20), (Site.LEFT_SHANK, -20), (Site.RIGHT_THIGH, 15), (Site.RIGHT_SHANK, 15)):
        chain.add_attitude(site, 0.62, multiply(multiply(from_yaw(north), pitch(lean)), MOUNTINGS[site]))
    chain.add_first_step(Foot.LEFT, 0.62)
    assert chain.heading == pytest.approx(north)
    step = np.subtract(chain.end(Foot.LEFT, 0.62), chain.end(Foot.RIGHT, 0.62))
    assert step[0] == pytest.approx(0.85 * (sin(radians(20)) + sin(radians(15))))
    assert step[1] == pytest.approx(0.2)


def lean(attitude: Quat, stood: Quat) -> float:
    """Return the angle from the vertical, rad, of an axis that stood upright."""
    _, _, z = rotate(multiply(attitude, conjugate(stood)), (0.0, 0.0, 1.0))
    return float(np.arccos(min(1.0, z)))
