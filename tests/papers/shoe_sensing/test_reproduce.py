"""`solepath reproduce shoe-sensing`: how steps are judged, the paper's figures, a short run of it."""

from __future__ import annotations

import pytest
from attrs import evolve
from strides import stride

from solepath.emulate.wearers.truth import TrueStride
from solepath.events import StrideTaken
from solepath.lab.reproduce import shoe_sensing, shoe_walks
from solepath.lab.reproduce.published import SHOE_SENSING as PAPER
from solepath.lab.reproduce.published import TABLE_2_DIVISOR
from solepath.lab.reproduce.runner import Runner
from solepath.lab.reproduce.shoe_walks import FOOT, STATES, matched, route_of, sample_walk, score_strides, tour_route
from solepath.lab.reproduce.walks import run_session
from solepath.papers.shoe_sensing.recipe import SHOE_SENSING


def stride_of(t: float) -> StrideTaken:
    return stride(FOOT, t)


def true(t: float) -> TrueStride:
    return TrueStride(FOOT, 1, t - 1.0, t, t - 0.9, t - 0.7, t - 0.2, (1.2, 0.0, 0.0), 1.2, 0.0)


def test_steps_are_matched_one_to_one_and_in_order() -> None:
    found, so = [stride_of(1.1), stride_of(1.9), stride_of(2.05), stride_of(4.0)], [true(1.0), true(2.0), true(3.0)]
    assert [(one.t, other.t_end) for one, other in matched(found, so)] == [(1.1, 1.0), (2.05, 2.0)]


def test_the_nearest_is_matched_though_an_earlier_one_is_near_too() -> None:
    assert [one.t for one, _ in matched([stride_of(1.75), stride_of(2.2)], [true(2.0)])] == [2.2]


def test_two_steps_found_as_one_are_a_merged_one_that_is_off_by_a_whole_step(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(shoe_walks, "STRIDES", 10)
    samples, truth = sample_walk(route_of("walking"), 1)
    steps = [event for event in run_session(SHOE_SENSING, samples) if isinstance(event, StrideTaken)]
    first, second = steps[4:6]
    both = evolve(second, t_start=first.t_start, length=first.length + second.length)
    whole = score_strides(steps, truth, "walking")
    merged = score_strides([*steps[:4], both, *steps[6:]], truth, "walking")
    assert (whole.merged, merged.merged, merged.split) == (0, 1, 0)
    assert len(merged.whole) == len(merged.lengths) - 1
    assert merged.not_found == whole.not_found + 1
    assert max(error for error, _ in merged.lengths) == pytest.approx(first.length, abs=0.15)


def test_table_2_is_the_mean_error_over_the_length_divided_by_22_5() -> None:
    for row, off, length in (
        ("walking, table 2 %", "walking, length m", 1.20),
        ("jogging, table 2 %", "jogging, length m", 1.60),
        ("upstairs, table 2 %", "upstairs, height m", 0.32),
        ("downstairs, table 2 %", "downstairs, length m", 0.60),
    ):
        error, printed = PAPER[off].mean, PAPER[row].mean
        assert error is not None and printed is not None
        assert 100.0 * error / length / TABLE_2_DIVISOR == pytest.approx(printed, abs=0.011)


def test_strides_are_about_as_long_as_the_papers() -> None:
    for state, length in (("walking", 1.20), ("jogging", 1.60), ("upstairs", 0.60), ("downstairs", 0.60)):
        _, truth = sample_walk(route_of(state), 1)
        lengths = [one.length for one in truth.strides(FOOT) if state in STATES[:2] or abs(one.displacement[2]) > 0.25]
        assert sorted(lengths)[len(lengths) // 2] == pytest.approx(length, rel=0.08)


def test_five_minutes_are_five_minutes() -> None:
    assert 240.0 < sample_walk(tour_route(), 1)[1].duration < 360.0


def test_on_the_stairs_those_strides_count_that_climb_two_risers() -> None:
    samples, truth = sample_walk(route_of("upstairs"), 1)
    steps = score_strides(run_session(SHOE_SENSING, samples), truth, "upstairs")
    climbed = [one for one in truth.strides(FOOT) if one.displacement[2] > 0.25]
    assert steps.found + steps.not_found == len(climbed)
    assert steps.right == (True,) * steps.found
    assert all(80.0 < angle < 130.0 for angle in steps.angles)


def test_a_row_stands_for_every_figure_of_the_paper(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(shoe_walks, "STRIDES", 10)
    monkeypatch.setattr(shoe_walks, "LAPS", 0)
    done = shoe_sensing.reproduce(1, 1, Runner())
    assert set(PAPER) <= set(done.table)
    assert all(len(row.values) for row in done.rows)
    assert done.table["walking, height of 100 steps after m"].mean == pytest.approx(0.0, abs=0.1)
    assert len(done.panels) == 2
    notes = " ".join(done.notes)
    for claim in ("by construction", " of 1 tracks end exactly", "the end is off by", "in the method corrects it"):
        assert claim in notes
