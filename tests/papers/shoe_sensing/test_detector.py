"""Short-time energy, its baseline and the angle per metre: Sensors 16, 1809, 2016, sections 3.1.2 and 3.4.1."""

from __future__ import annotations

from math import atan, degrees, inf, radians

import pytest
from hypothesis import strategies as st

from solepath.foot.stance.stance import Stance
from solepath.papers.shoe_sensing.short_time_energy import EnergySettings, ShortTimeEnergy
from solepath.papers.shoe_sensing.steepness import DOWNSTAIRS_THRESHOLD, UPSTAIRS_THRESHOLD, angle_per_metre, steepness
from solepath.types import Phase
from solepath.types.vector import GRAVITY, ZERO
from solepath_lab.reproduce.shoe.variants import AccelerationMagnitude


def last_evidence(
    detector: ShortTimeEnergy | AccelerationMagnitude, magnitudes: list[float], rate: float = 100.0
) -> Stance:
    """Return the evidence of the last of these |acc|, in g."""
    stance = None
    for k, g in enumerate(magnitudes):
        stance = detector.update(k / rate, 1.0 / rate, (0.0, 0.6 * g * GRAVITY, 0.8 * g * GRAVITY), ZERO, None)
    assert stance is not None
    return stance


def test_fifteen_samples_that_are_off_by_a_twentieth_of_g_have_an_energy_of_0_0375() -> None:
    stance = last_evidence(ShortTimeEnergy(), [1.05] * 40)
    assert stance.statistic == pytest.approx(15 * 0.05**2)
    assert stance == Stance(ZERO, 0.01, stance.statistic, Phase.STATIONARY)


def test_beyond_the_threshold_the_foot_moves_though_it_was_still_for_a_while() -> None:
    # 0.06 g: 15 samples make 0.054; the last 13 of them 0.0468
    stance = last_evidence(ShortTimeEnergy(), [1.06] * 40)
    assert stance.statistic == pytest.approx(0.054)
    assert stance.hint is None
    assert stance.sigma == pytest.approx(0.01 * 15 / 13)


def test_a_jogger_that_is_still_for_five_samples_may_stand() -> None:
    stance = last_evidence(ShortTimeEnergy(), [4.0] * 30 + [1.01] * 5)
    assert stance.hint is None
    assert stance.sigma == pytest.approx(0.03)
    assert last_evidence(ShortTimeEnergy(), [4.0] * 30).sigma == inf


@pytest.mark.parametrize("rate", [20.0, 40.0, 100.0, 200.0, 400.0])
def test_the_energy_of_the_same_motion_is_the_same_at_every_rate(rate: float) -> None:
    stance = last_evidence(ShortTimeEnergy(EnergySettings(window=0.2)), [1.04] * 100, rate)
    assert stance.statistic == pytest.approx(20 * 0.04**2)


def test_the_magnitude_is_that_of_a_foot_at_rest_between_9_and_11() -> None:
    for magnitude, still in ((8.99, False), (9.01, True), (10.99, True), (11.01, False)):
        stance = last_evidence(AccelerationMagnitude(), [magnitude / GRAVITY])
        assert (stance.hint is Phase.STATIONARY) is still
        assert stance.statistic == pytest.approx(magnitude - GRAVITY)


acc = st.floats(-500.0, 500.0)


def test_the_stride_of_figure_28_lies_within_table_1() -> None:
    # two treads of 0.30 m by 0.16 m: atan(0.32 / 0.60) = 28.07 degrees over the 0.30 m of one
    up = degrees(angle_per_metre(0.60, 0.32))
    assert up == pytest.approx(degrees(atan(0.32 / 0.60)) / 0.30) == pytest.approx(93.6, abs=0.05)
    assert abs(up - 107.904) < 36.465
    assert abs(degrees(angle_per_metre(0.60, -0.32)) + 89.464) < 34.907


def test_thresholds_are_half_way_between_the_averages_of_table_1() -> None:
    assert degrees(UPSTAIRS_THRESHOLD) == pytest.approx((3.935 + 107.904) / 2)
    assert degrees(DOWNSTAIRS_THRESHOLD) == pytest.approx((3.935 - 89.464) / 2)


@pytest.mark.parametrize(
    ("ground", "height", "way"),
    [
        (1.2, 0.0, 0),
        (1.2, 0.12, 0),
        (0.60, 0.32, 1),
        (0.60, -0.32, -1),
        (0.30, 0.16, 1),
        (1.0, 0.16, 0),
        (0.02, 0.03, 0),  # a foot that is set down anew: steep, but no stair
        (0.0, 0.0, 0),
        (0.0, 0.2, 1),
    ],
)
def test_strides_are_level_or_up_or_down(ground: float, height: float, way: int) -> None:
    assert steepness(ground, height) == way


def test_the_angle_is_that_of_the_paper_in_radians() -> None:
    assert angle_per_metre(1.2, 1.2) == pytest.approx(radians(45.0) / 0.6)
