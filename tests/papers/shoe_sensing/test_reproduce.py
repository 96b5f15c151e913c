"""`solepath reproduce shoe-sensing`: how steps are judged, the paper's figures, a short run of it."""

from __future__ import annotations

from functools import cache

import pytest
from attrs import evolve
from strides import stride

from solepath.emulate.wearers.truth import TrueStride, Truth
from solepath.events import StrideTaken
from solepath.lab.reproduce import shoe_sensing
from solepath.lab.reproduce.published import SHOE_SENSING as PAPER
from solepath.lab.reproduce.published import TABLE_2_DIVISOR
from solepath.lab.reproduce.runner import Runner
from solepath.lab.reproduce.shoe import walks
from solepath.lab.reproduce.shoe.figures import extraction_curves, posture_curves, window_curves
from solepath.lab.reproduce.shoe.scores import matched, relative_error, score_legs, score_strides, states_of
from solepath.lab.reproduce.shoe.variants import FOOT, LESS, OURS, PRINTED, RECIPES, SETUPS, STATES, TABLE
from solepath.lab.reproduce.shoe.walks import ROUTES, ramps_route, sample_walk, tour_route
from solepath.lab.reproduce.walks import final_strides, run_session


def stride_of(t: float) -> StrideTaken:
    return stride(FOOT, t)


def true(t: float) -> TrueStride:
    return TrueStride(FOOT, 1, t - 1.0, t, t - 0.9, t - 0.7, t - 0.2, (1.2, 0.0, 0.0), 1.2, 0.0)


@cache
def walked(name: str, rounds: int = 1) -> tuple[list[StrideTaken], Truth]:
    """Return the strides of ours on a walk, and the truth."""
    route = ROUTES[name](TABLE) if name not in STATES[:2] else ROUTES[name](TABLE, rounds)
    samples, truth = sample_walk(route, 1)
    return final_strides(run_session(RECIPES[OURS], samples), FOOT), truth


def test_steps_are_matched_one_to_one_and_in_order() -> None:
    found, so = [stride_of(1.1), stride_of(1.9), stride_of(2.05), stride_of(4.0)], [true(1.0), true(2.0), true(3.0)]
    assert [(one.t, other.t_end) for one, other in matched(found, so)] == [(1.1, 1.0), (2.05, 2.0)]


def test_the_nearest_is_matched_though_an_earlier_one_is_near_too() -> None:
    assert [one.t for one, _ in matched([stride_of(1.75), stride_of(2.2)], [true(2.0)])] == [2.2]


def test_two_steps_found_as_one_are_a_merged_one_that_is_off_by_a_whole_step() -> None:
    steps, truth = walked("walking")
    first, second = steps[4:6]
    both = evolve(second, t_start=first.t_start, length=first.length + second.length)
    whole = score_strides(steps, truth, FOOT)["walking"]
    merged = score_strides([*steps[:4], both, *steps[6:]], truth, FOOT)["walking"]
    assert (whole.merged, merged.merged, merged.split) == (0, 1, 0)
    assert len(merged.whole) == len(merged.lengths) - 1
    assert merged.not_found == whole.not_found + 1
    assert max(error for error, _ in merged.lengths) == pytest.approx(first.length, abs=0.15)


def test_table_2_is_the_mean_error_over_the_length_divided_by_22_5() -> None:
    for row, off, length in (
        ("walking, table 2, ours %", "walking, length, ours m", 1.20),
        ("jogging, table 2, ours %", "jogging, length, ours m", 1.60),
        ("upstairs, table 2, ours %", "upstairs, height, ours m", 0.32),
        ("downstairs, table 2, ours %", "downstairs, length, ours m", 0.60),
    ):
        error, printed = PAPER[off].mean, PAPER[row].mean
        assert error is not None and printed is not None
        assert 100.0 * error / length / TABLE_2_DIVISOR == pytest.approx(printed, abs=0.011)
    assert relative_error([(-0.1, 1.0), (0.3, 3.0)]) == pytest.approx(0.1)


def test_strides_are_about_as_long_as_the_papers_in_every_state() -> None:
    _, truth = walked("short")
    strides, states = truth.strides(FOOT), states_of(truth, FOOT)
    for state, length in zip(STATES, (1.20, 1.60, 0.60, 0.60), strict=True):
        lengths = sorted([one.length for one, of in zip(strides, states, strict=True) if of == state])
        assert lengths[len(lengths) // 2] == pytest.approx(length, rel=0.08)
    assert None in states  # turns on the spot


def test_a_round_is_two_legs_of_19_2_m_with_a_turn_between() -> None:
    steps, truth = walked("walking")
    legs = score_legs(steps, truth, FOOT)
    # half of the turn's displacement belongs to a foot, not to the middle of the body
    assert [leg.length[1] for leg in legs] == pytest.approx([19.2, 19.2], abs=0.2)
    assert all(abs(leg.length[0]) < 0.06 * 19.2 and len(leg.courses) > 12 for leg in legs)
    assert legs[0].heading == 0.0 and abs(legs[1].heading) < 15.0
    # a track that turns by a degree in each stride has that course
    turned = [
        evolve(one, displacement=(one.displacement[0], one.displacement[1] + 0.1, 0.0)) if k == 9 else one
        for k, one in enumerate(steps)
    ]
    before, after = (max(map(abs, score_legs(of, truth, FOOT)[0].courses)) for of in (steps, turned))
    assert after > before + 3.0


def test_five_minutes_are_five_minutes() -> None:
    assert 240.0 < sample_walk(tour_route(), 1)[1].duration < 360.0


def test_on_the_stairs_those_strides_count_that_climb_two_risers() -> None:
    steps, truth = walked("short")
    scores = score_strides(steps, truth, FOOT)
    for state, low, high in (("upstairs", 80.0, 130.0), ("downstairs", -130.0, -80.0)):
        climbed = [one for one in truth.strides(FOOT) if one.displacement[2] * low > 0.25 * abs(low)]
        assert scores[state].found + scores[state].not_found == len(climbed)
        assert scores[state].right == (True,) * scores[state].found
        assert all(low < angle < high for angle in scores[state].angles)


def test_ramps_and_kerbs_rise_as_they_should_in_the_truth() -> None:
    _, truth = sample_walk(ramps_route(), 1)
    exact = [
        stride(FOOT, one.t_end, position=(0.0, 0.0, float(truth.pose(FOOT, one.t_end).position[0, 2])))
        for one in truth.strides(FOOT)
    ]
    rises = walks._rises(exact, truth)
    assert [rise for _, rise in rises] == pytest.approx([0.4, -0.4, 1.0, -1.0, 0.1, -0.1])
    assert [error for error, _ in rises] == pytest.approx([0.0] * 6, abs=0.02)


def test_every_addition_of_ours_is_left_out_once_and_every_setup_changes_one_thing() -> None:
    assert all(recipe != RECIPES[OURS] for recipe in LESS.values())
    assert len({str((one.detector, one.corrector.settings)) for one in LESS.values()}) == len(LESS)  # type: ignore[attr-defined]
    for setup in SETUPS[1:]:
        changed = evolve(setup, name=TABLE.name)
        fields = ("contact", "chip", "rate", "mounting", "standing")
        assert sum(getattr(changed, name) != getattr(TABLE, name) for name in fields) == 1


def test_a_row_stands_for_every_figure_of_the_paper(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(walks, "ROUNDS", 1)
    monkeypatch.setattr(walks, "MANY_ROUNDS", 1)
    monkeypatch.setattr(walks, "LAPS", 0)
    monkeypatch.setattr(shoe_sensing, "SETUPS", SETUPS[1:2])
    done = shoe_sensing.reproduce(1, 1, Runner())
    assert set(PAPER) <= set(done.table)
    assert all(len(row.values) for row in done.rows)
    assert done.table["walking, height of 100 steps after, printed m"].mean == pytest.approx(0.0, abs=1e-9)
    for method in ("printed", "ours, level by angle"):
        # a ramp is level to the angle per metre
        assert done.table[f"slope 5 %, height off, {method} m"].mean == pytest.approx(1.0, abs=0.05)
    by_height = done.table["slope 5 %, height off, ours m"].mean
    assert by_height is not None and by_height < 0.6
    ours, alone = (done.table[f"short: {name}, jogging, steps %"].mean for name in (OURS, "ours, energy alone"))
    assert ours is not None and alone is not None and ours > alone + 20.0
    titles = [panel.title for panel in done.panels]
    for figure in ("fig. 3", "fig. 7", "fig. 20", "fig. 25a", "fig. 25b", "fig. 28", "fig. 35"):
        assert any(figure in title for title in titles)
    notes = " ".join(done.notes)
    for claim in ("by construction", "flights reported exactly in", "With 40 Hz: printed "):
        assert claim in notes


def test_the_tilt_error_of_figure_7_converges() -> None:
    samples, truth = sample_walk(ROUTES["short"](TABLE), 1)
    drawn = (window_curves(samples, truth), posture_curves(samples), *extraction_curves(samples, truth))
    curves = {curve.title: curve for curve in drawn}
    points = curves["first attitude (fig. 7)"].curves[0].points
    assert points[-1][0] == pytest.approx(5.0, abs=0.05) and points[-1][1] < 1.0
    energies = curves["energy by window (fig. 3)"].curves
    assert [len(curve.points) > 100 for curve in energies[:-1]] == [True] * 5
    # a longer window has more energy at every time
    assert all(a[1] <= b[1] + 1e-9 for a, b in zip(energies[0].points, energies[4].points, strict=True))
    stands = curves["walking, stands (fig. 20)"].curves
    assert {curve.name for curve in stands} == {"energy", "magnitude", "true"}
    assert PRINTED not in {curve.name for curve in stands}
