"""Walking modes: the regions of fig. 13, the rules of table 2 and the values of table 1 of Gong et al. 2023."""

from __future__ import annotations

import pytest
from attrs import evolve
from hypothesis import given
from hypothesis import strategies as st

from solepath.emulate.sensors.insoles import layout
from solepath.papers.walking_modes.compensation import TABLE_1
from solepath.papers.walking_modes.mode import (
    MODE_THRESHOLD,
    REFERENCE_SPEED,
    REGION_POINTS,
    STRAIGHT_SHARES,
    Contact,
    at_reference_speed,
    decide,
    regions,
)
from solepath.papers.walking_modes.recognition import Recognition
from solepath.papers.walking_modes.settings import ModesSettings
from solepath.papers.walking_modes.touchdown import FootState
from solepath.types import Cell, Foot, Layout, WalkingMode

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
    assert decide(foot, 1.0, shares_of(**{region: 1.1 * MODE_THRESHOLD}), 0.0, MODE_THRESHOLD) is mode
    assert decide(foot, 1.0, shares_of(**{region: 0.9 * MODE_THRESHOLD}), 0.0, MODE_THRESHOLD) is None


def test_a_tight_bend_goes_before_a_wide_one() -> None:
    assert (
        decide(LEFT, 1.0, shares_of(R1=3.0 * MODE_THRESHOLD, R2=1.1 * MODE_THRESHOLD), 0.0, MODE_THRESHOLD)
        is WalkingMode.LEFT_TIGHT
    )


def test_of_two_edges_the_one_that_bears_more_counts() -> None:
    assert (
        decide(LEFT, 1.0, shares_of(R1=1.2 * MODE_THRESHOLD, L2=1.1 * MODE_THRESHOLD), 0.0, MODE_THRESHOLD)
        is WalkingMode.LEFT_WIDE
    )
    assert (
        decide(LEFT, 1.0, shares_of(R1=1.1 * MODE_THRESHOLD, L3=1.2 * MODE_THRESHOLD), 0.0, MODE_THRESHOLD)
        is WalkingMode.RIGHT_WIDE
    )


def test_straight_on_is_a_long_step_over_the_front_of_the_foot_with_nothing_else() -> None:
    assert decide(LEFT, 0.16, NO_LOAD, 1.1 * MODE_THRESHOLD, MODE_THRESHOLD) is WalkingMode.STRAIGHT
    assert decide(LEFT, 0.14, NO_LOAD, 1.1 * MODE_THRESHOLD, MODE_THRESHOLD) is None
    assert decide(LEFT, 0.16, NO_LOAD, 0.9 * MODE_THRESHOLD, MODE_THRESHOLD) is None


def test_whoever_drags_a_foot_round_is_in_no_bend() -> None:
    assert decide(LEFT, 0.14, shares_of(R2=3.0 * MODE_THRESHOLD), 0.0, MODE_THRESHOLD) is None


def test_the_same_edge_of_both_feet_bears_the_same_turn() -> None:
    """R is the inner and L the outer edge: in a left turn the load is on the right edge of either foot."""
    for region, mirrored in (("R1", "L2"), ("R2", "L1")):
        shown = {pressed_mode(LEFT, region), pressed_mode(RIGHT, mirrored)}
        assert len(shown) == 1


def pressed_mode(foot: Foot, region: str) -> WalkingMode | None:
    return decide(foot, 1.0, shares_of(**{region: 2.0 * MODE_THRESHOLD}), 0.0, MODE_THRESHOLD)


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


@pytest.mark.parametrize("cells", [96, 99])
@pytest.mark.parametrize("foot", list(Foot))
def test_seven_regions_of_two_points_each_are_on_any_fine_insole(cells: int, foot: Foot) -> None:
    insole = layout(cells, foot)
    found = regions(insole)
    assert {name: len(where) for name, where in found.items()} == dict.fromkeys(REGION_POINTS, 2)
    outward = 1.0 if foot is LEFT else -1.0
    for name, where in found.items():
        across = [outward * insole.cells[k].y for k in where]
        if name.startswith("L"):
            assert min(across) > 0.02
        elif name.startswith("R"):
            assert max(across) < -0.02


def test_the_regions_of_both_feet_are_mirror_images() -> None:
    for name in REGION_POINTS:
        (left, right) = (
            sorted([(insole.cells[k].x, abs(insole.cells[k].y)) for k in regions(insole)[name]])
            for insole in (layout(99, LEFT), layout(99, RIGHT))
        )
        assert [x for cell in left for x in cell] == pytest.approx([x for cell in right for x in cell])


def test_coarse_insoles_have_every_region_though_some_share_cells() -> None:
    assert all(regions(layout(cells, LEFT))[name] for cells in (8, 24, 35) for name in REGION_POINTS)


def test_a_contact_gives_each_region_as_a_multiple_of_the_mean_cell() -> None:
    insole, contact = layout(99, LEFT), Contact()
    contact.set_layout(insole)
    contact.start(0.0)
    cells = [1.0] * 99
    for k in regions(insole)["R1"]:
        cells[k] = 3.0
    for _ in range(2):
        contact.add(tuple(cells), sum(cells))
    shares = contact.shares()
    assert shares is not None
    assert shares["R1"] == pytest.approx(3.0 / (sum(cells) / 99))
    assert shares["L1"] == pytest.approx(1.0 / (sum(cells) / 99))


def test_at_its_own_pace_a_share_is_what_it_is_and_a_straight_way_is_straight_at_any() -> None:
    shares = shares_of(R1=2.5, R2=1.0, F1=2.0)
    assert at_reference_speed(shares, REFERENCE_SPEED) == pytest.approx(shares)
    for speed in (0.0, 0.8, 1.4, 9.0):
        assert at_reference_speed({**STRAIGHT_SHARES, "F1": 1.0, "F2": 0.0}, speed) == pytest.approx(
            {**STRAIGHT_SHARES, "F1": 1.0, "F2": 0.0}
        )


def test_a_slow_bend_leaves_less_of_a_mark_and_counts_for_more() -> None:
    assert at_reference_speed(shares_of(R1=2.0), 0.8)["R1"] > 2.0 > at_reference_speed(shares_of(R1=2.0), 1.4)["R1"]


@given(st.lists(st.lists(st.floats(-1e3, 1e5), min_size=99, max_size=99), max_size=4), st.floats(0.0, 5.0))
def test_whatever_the_cells_bear_a_contact_ends_in_a_mode_or_in_none(rows: list[list[float]], step: float) -> None:
    contact = Contact()
    contact.set_layout(layout(99, LEFT))
    contact.start(0.0)
    for row in rows:
        contact.add(tuple(row), sum(row))
    shares = contact.shares()
    if shares is not None:
        paced = at_reference_speed(shares, contact.speed(step))
        assert all(0.0 <= share < float("inf") for share in paced.values())
        assert decide(LEFT, step, paced, shares["F1"] - shares["F2"], MODE_THRESHOLD) in (None, *WalkingMode)


def reorder(insole: Layout) -> Layout:
    """Return the layout with its cells in another order."""
    return evolve(insole, cells=insole.cells[50:] + insole.cells[:50])


UNUSABLE_LAYOUTS = {
    "guessed": evolve(layout(96, LEFT), cells=tuple(Cell(cell.x, 0.0) for cell in layout(96, LEFT).cells)),
    "few": evolve(layout(96, LEFT), cells=layout(96, LEFT).cells[:6]),
    "none": evolve(layout(96, LEFT), cells=()),
    "no length": evolve(layout(96, LEFT), length=0.0),
    "no insole's length": evolve(layout(96, LEFT), length=1e308),
    "far away": evolve(layout(96, LEFT), cells=tuple(Cell(1e308, -1e308) for _ in range(96))),
}


@pytest.mark.parametrize("how", UNUSABLE_LAYOUTS)
def test_cells_that_do_not_separate_left_from_right_have_no_regions_and_no_mode(how: str) -> None:
    assert regions(UNUSABLE_LAYOUTS[how]) == {}
    contact = Contact()
    contact.set_layout(UNUSABLE_LAYOUTS[how])
    contact.start(0.0)
    cells = (1.0,) * len(UNUSABLE_LAYOUTS[how].cells)
    contact.add(cells, sum(cells))
    assert contact.shares() is None


def test_another_layout_of_as_many_cells_has_regions_of_its_own() -> None:
    contact = Contact()
    contact.set_layout(layout(96, LEFT))
    before = contact.region_cells
    contact.set_layout(reorder(layout(96, LEFT)))
    assert contact.region_cells == regions(reorder(layout(96, LEFT))) != before


def test_a_share_that_no_insole_can_have_is_bounded() -> None:
    assert at_reference_speed({"L1": 1e200}, 0.5)["L1"] < 1e9
