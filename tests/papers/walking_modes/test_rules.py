"""Walking modes: the regions of fig. 13, the rules of table 2 and the values of table 1 of Gong et al. 2023."""

from __future__ import annotations

import pytest

from solepath.emulate.sensors.insoles import layout
from solepath.papers.walking_modes.compensation import TABLE_1
from solepath.papers.walking_modes.mode import MODE_THRESHOLD, REGION_POINTS, decide, regions
from solepath.papers.walking_modes.recognition import Recognition, SoleContact
from solepath.papers.walking_modes.settings import ModesSettings
from solepath.papers.walking_modes.touchdown import FootState
from solepath.types import Foot, WalkingMode

LEFT, RIGHT = Foot.LEFT, Foot.RIGHT
NO_LOAD = dict.fromkeys(REGION_POINTS, 0.0)


def shares_of(**shares: float) -> dict[str, float]:
    """Return shares that are zero on all regions but these."""
    return {**NO_LOAD, **shares}


TABLE_2 = [
    (LEFT, "R1", WalkingMode.LEFT_WIDE),
    (LEFT, "R2", WalkingMode.LEFT_TIGHT),
    (LEFT, "L2", WalkingMode.RIGHT_WIDE),
    (LEFT, "L3", WalkingMode.RIGHT_WIDE),
    (LEFT, "L1", WalkingMode.RIGHT_TIGHT),
    (RIGHT, "L2", WalkingMode.LEFT_WIDE),
    (RIGHT, "L3", WalkingMode.LEFT_WIDE),
    (RIGHT, "L1", WalkingMode.LEFT_TIGHT),
    (RIGHT, "R1", WalkingMode.RIGHT_WIDE),
    (RIGHT, "R2", WalkingMode.RIGHT_TIGHT),
]


@pytest.mark.parametrize(("foot", "region", "mode"), TABLE_2)
def test_a_region_beyond_the_threshold_is_the_bend_of_table_2(foot: Foot, region: str, mode: WalkingMode) -> None:
    assert decide(foot, 1.0, shares_of(**{region: 1.1 * MODE_THRESHOLD}), 0.0) is mode
    assert decide(foot, 1.0, shares_of(**{region: 0.9 * MODE_THRESHOLD}), 0.0) is None


def test_a_tight_bend_goes_before_a_wide_one() -> None:
    assert decide(LEFT, 1.0, shares_of(R1=3.0 * MODE_THRESHOLD, R2=1.1 * MODE_THRESHOLD), 0.0) is WalkingMode.LEFT_TIGHT


def test_of_two_edges_the_one_that_bears_more_counts() -> None:
    assert decide(LEFT, 1.0, shares_of(R1=1.2 * MODE_THRESHOLD, L2=1.1 * MODE_THRESHOLD), 0.0) is WalkingMode.LEFT_WIDE
    assert decide(LEFT, 1.0, shares_of(R1=1.1 * MODE_THRESHOLD, L3=1.2 * MODE_THRESHOLD), 0.0) is WalkingMode.RIGHT_WIDE


def test_straight_on_is_a_long_step_over_the_front_of_the_foot_with_nothing_else() -> None:
    assert decide(LEFT, 0.16, NO_LOAD, 1.1 * MODE_THRESHOLD) is WalkingMode.STRAIGHT
    assert decide(LEFT, 0.14, NO_LOAD, 1.1 * MODE_THRESHOLD) is None
    assert decide(LEFT, 0.16, NO_LOAD, 0.9 * MODE_THRESHOLD) is None


def test_whoever_drags_a_foot_round_is_in_no_bend() -> None:
    assert decide(LEFT, 0.14, shares_of(R2=3.0 * MODE_THRESHOLD), 0.0) is None


def test_table_1_is_taken_in_centimetres_with_x_to_the_right_and_y_ahead() -> None:
    # (forward, left) in mm is 10 (y, -x) in cm; the right wide turn of the left foot is the example of the text
    in_millimetres = {
        (LEFT, WalkingMode.LEFT_WIDE): (2.7, -1.9),
        (LEFT, WalkingMode.LEFT_TIGHT): (9.7, -3.5),
        (LEFT, WalkingMode.STRAIGHT): (5.5, -3.4),
        (LEFT, WalkingMode.RIGHT_WIDE): (-5.2, 9.4),
        (LEFT, WalkingMode.RIGHT_TIGHT): (-17.3, 12.8),
        (RIGHT, WalkingMode.LEFT_WIDE): (-4.8, -9.7),
        (RIGHT, WalkingMode.LEFT_TIGHT): (-18.0, -12.5),
        (RIGHT, WalkingMode.STRAIGHT): (6.2, 2.3),
        (RIGHT, WalkingMode.RIGHT_WIDE): (2.4, 1.6),
        (RIGHT, WalkingMode.RIGHT_TIGHT): (10.2, 3.4),
    }
    found = {(foot, mode): pair for foot, modes in TABLE_1.items() for mode, pair in modes.items()}
    assert set(found) == set(in_millimetres)
    for key, (forward, left) in in_millimetres.items():
        assert found[key] == pytest.approx((0.001 * forward, 0.001 * left))


@pytest.mark.parametrize(("newtons", "stands"), [(489.0, False), (491.0, True)])
def test_standing_is_more_than_seven_tenths_of_the_bodys_weight_on_both_feet(newtons: float, stands: bool) -> None:
    """The wearer weighs 700 N, the feet bear a half of `newtons` each, and neither takes a step for two seconds."""
    recognition = Recognition(ModesSettings(weight=700.0))
    cells = (newtons / 198.0,) * 99
    seen = set()
    for k in range(100):
        for foot in Foot:
            seen.add(recognition.add_pressure(foot, FootState(pressure=9.0), cells, layout(99, foot), 0.02 * k, True))
    assert seen == ({None, WalkingMode.STANDING} if stands else {None})


def test_a_contact_gives_each_region_as_a_multiple_of_the_mean_cell() -> None:
    insole, contact = layout(99, LEFT), SoleContact()
    contact.set_layout(insole)
    contact.start_contact(0.0)
    cells = [1.0] * 99
    for k in regions(insole)["R1"]:
        cells[k] = 3.0
    for _ in range(2):
        contact.add(tuple(cells), sum(cells))
    shares = contact.shares()
    assert shares is not None
    assert shares["R1"] == pytest.approx(3.0 / (sum(cells) / 99))
    assert shares["L1"] == pytest.approx(1.0 / (sum(cells) / 99))
