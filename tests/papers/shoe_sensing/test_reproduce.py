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
from solepath.lab.reproduce.shoe.scores import matched, relative_error, score_strides
from solepath.lab.reproduce.shoe.variants import FOOT, OURS, RECIPES, SETUPS, STATES, TABLE
from solepath.lab.reproduce.shoe.walks import ROUTES, sample_walk
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
