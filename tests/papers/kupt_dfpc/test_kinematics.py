"""The rolling shoe: equations (4) to (7) with expected values by hand, and mountings of the sensor."""

from __future__ import annotations

from collections.abc import Callable
from math import cos, pi, sin

import pytest

from solepath.calibration import ShoeGeometry
from solepath.emulate.wearers.shoe import Shoe
from solepath.papers.kupt_dfpc.kinematics import Sagittal, forefoot_position, heel_position, mean_velocity
from solepath.types import Quat, Vec3
from solepath.types.vector import IDENTITY, conjugate, from_rotation_vector, from_yaw, multiply, normalise, rotate

LINEAR_SHOE = ShoeGeometry(forefoot_radius=(0.070, 0.025), pivot_to_toe=(0.090, -0.025), steepest=1.2)
"""Shoe whose curves are straight lines, so that expected values are easy to compute."""
CROOKED: Quat = normalise((0.6, -0.3, 0.5, 0.55))
"""Mountings of a sensor: sensor to foot."""


def attitude_of(toe_up: float, yaw: float = 0.0) -> Quat:
    """Return the attitude, foot to world frame, of a foot whose pitch is `toe_up` rad."""
    return multiply(from_yaw(yaw), from_rotation_vector((0.0, -toe_up, 0.0)))


def taught(mounting: Quat = IDENTITY) -> Sagittal:
    """Return the state after a stance and one push-off; `mounting` is sensor to foot."""
    sagittal = Sagittal()
    sagittal.add_flat_sample(0.01, mounting)
    for heel_up in (0.1, 0.3, 0.6, 0.9):
        sagittal.add_lift_sample(multiply(attitude_of(-heel_up), mounting))
    sagittal.end_lift()
    return sagittal


def test_on_its_heel_the_sensor_is_where_equation_4_has_it() -> None:
    # 30 degrees: P_h = 0.125 x 0.8660254 - 0.029 x 0.5 = 0.1082532 - 0.0145
    #             P_z = 0.125 x 0.5 + 0.029 x 0.8660254 = 0.0625 + 0.0251147
    assert heel_position(LINEAR_SHOE, pi / 6) == pytest.approx((0.0937532, 0.0876147), abs=1e-7)
    assert heel_position(LINEAR_SHOE, 0.0) == pytest.approx((0.125, 0.029))


def test_on_its_forefoot_the_sensor_is_where_equation_6_has_it() -> None:
    # 0.4 rad: L_r = 0.070 + 0.025 x 0.4 = 0.080, L_p2t = 0.090 - 0.010 = 0.080
    # P_h = 0.080 x 0.9210610 - 0.029 x 0.3894183 = 0.0736849 - 0.0112931 = 0.0623918, and 0.080 more to the toe
    # P_z = 0.080 x 0.3894183 + 0.029 x 0.9210610 = 0.0311535 + 0.0267108
    assert forefoot_position(LINEAR_SHOE, 0.4) == pytest.approx((0.1423918, 0.0578643), abs=1e-7)


def rolling_velocity(
    place: Callable[[Sagittal, ShoeGeometry], Vec3], *pitches: float, dt: float, yaw: float = 0.0
) -> Vec3:
    """Return the velocity, m/s, of a sensor whose foot goes from one pitch to the next within `dt` s."""
    sagittal, places = taught(), []
    for pitch in pitches:
        sagittal.update(attitude_of(pitch, yaw))
        places.append(place(sagittal, LINEAR_SHOE))
    return mean_velocity(*places, dt)


def test_on_its_heel_it_moves_as_equation_5_has_it() -> None:
    # 20 degrees: P_h = 0.125 x 0.9396926 - 0.029 x 0.3420201 = 0.1075430; P_z = 0.0427525 + 0.0272511 = 0.0700036
    # in 0.02 s: (0.1075430 - 0.0937532) / 0.02 = 0.689 ahead, (0.0700036 - 0.0876147) / 0.02 = -0.881 down
    found = rolling_velocity(Sagittal.heel_position, pi / 6, pi / 9, dt=0.02)
    assert found == pytest.approx((0.68949, 0.0, -0.88056), abs=1e-4)


def test_on_its_forefoot_it_moves_as_equation_7_has_it_where_the_foot_points() -> None:
    # 0.5 rad: L_r = 0.0825, L_p2t = 0.0775; P_h = 0.0724006 - 0.0139033 = 0.0584973; P_z = 0.0395526 + 0.0254499
    # in 0.01 s: -(0.1359973 - 0.1423918) / 0.01 = 0.639 ahead, (0.0650025 - 0.0578643) / 0.01 = 0.714 up
    ahead, aside = (rolling_velocity(Sagittal.forefoot_position, -0.4, -0.5, dt=0.01, yaw=yaw) for yaw in (0.0, pi / 2))
    assert ahead == pytest.approx((0.63945, 0.0, 0.71382), abs=1e-4)
    assert aside == pytest.approx((0.0, 0.63945, 0.71382), abs=1e-4)


def test_beyond_the_steepest_posture_the_curves_stay_as_they_are() -> None:
    # at 1.4 rad the curves are those of 1.2 rad: L_r = 0.100, L_p2t = 0.060
    behind, above = forefoot_position(LINEAR_SHOE, 1.4)
    assert behind == pytest.approx(0.100 * cos(1.4) - 0.029 * sin(1.4) + 0.060)
    assert above == pytest.approx(0.100 * sin(1.4) + 0.029 * cos(1.4))


@pytest.mark.parametrize("heel_up", [0.0, 0.2, 0.5, 0.8, 1.0, 1.2])
def test_the_default_shoe_rolls_like_the_round_sole_that_it_is_made_of(heel_up: float) -> None:
    """Where the sensor of the emulated shoe is while that rolls without slip, worked out from its arc."""
    arc, (x, _, z) = Shoe().forefoot, (0.125, 0.0, 0.029)
    # the arc's centre moves ahead by radius times angle; the sensor turns about it
    dx, dz = x - arc.x, z - arc.radius
    ahead = arc.x + arc.radius * heel_up + dx * cos(heel_up) + dz * sin(heel_up)
    above = arc.radius + dz * cos(heel_up) - dx * sin(heel_up)
    behind_toe, up = forefoot_position(ShoeGeometry(), heel_up)
    assert (Shoe().length - behind_toe, up) == pytest.approx((ahead, above), abs=2e-4)


@pytest.mark.parametrize("mounting", [IDENTITY, CROOKED, from_rotation_vector((pi, 0.0, 0.0))])
def test_a_push_off_teaches_where_the_toes_are_however_the_sensor_is_mounted(mounting: Quat) -> None:
    toe = taught(mounting).toe
    assert toe is not None
    assert toe == pytest.approx(rotate(conjugate(mounting), (1.0, 0.0, 0.0)), abs=1e-9)


@pytest.mark.parametrize("mounting", [IDENTITY, CROOKED])
@pytest.mark.parametrize("toe_up", [0.35, 0.0, -0.9])
def test_toes_up_is_a_positive_pitch_and_heel_up_a_negative_one(mounting: Quat, toe_up: float) -> None:
    sagittal = taught(mounting)
    sagittal.update(multiply(attitude_of(toe_up, yaw=2.0), mounting))
    assert sagittal.pitch == pytest.approx(toe_up, abs=1e-9)
    assert sagittal.forward == pytest.approx((cos(2.0), sin(2.0)), abs=1e-9)
