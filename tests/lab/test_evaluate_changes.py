"""Compares figures with those of an earlier evaluation."""

import copy
import json

import pytest

from solepath.recording import RecordingError
from solepath_lab.emulated.heading import CHECKED_TIMES
from solepath_lab.evaluate.changes import comparison_tables, read_scores, verdict
from solepath_lab.tables.columns import FIGURES

NEITHER = {
    "share_standing", "share_unknown",
    "nees_return", "held_return",
    *(f"{figure}_{t}" for figure in ("nees", "held", "heading_nees") for t in CHECKED_TIMES),
    "nees_end", "held_end", "path", "authors", "most_frequent", "strides_true", "rides_true", "heel_strike_true",
    "heel_strike_found", "toe_off_true", "toe_off_found", "stride_longest",
}  # fmt: skip

OLD = {
    "default": {
        "loops": {
            "recordings": {"a": {"end_error": 1.0, "path": 60.0}, "b": {"end_error": 2.0, "path": 60.0}},
            "summary": {
                "all": {
                    "count": 2, "mean": {"end_error": 1.5, "path": 60.0}, "median": {"end_error": 1.5},
                    "together": {"heel_strike_bias": -0.02, "heel_strike_f1": 0.9}, "confusion": None,
                }
            },
            "failures": [],
        },
        "walks": {"recordings": {}, "summary": {}, "failures": []},
    }
}  # fmt: skip


def test_every_figure_of_the_tables_is_better_one_way_or_neither():
    assert {name for name, figure in FIGURES.items() if not figure.better} == NEITHER


def test_a_bias_is_better_nearer_to_zero_on_either_side():
    assert verdict("heel_strike_bias", -0.02, 0.01) == "better"
    assert verdict("heel_strike_bias", -0.02, 0.02) == "the same"
    assert verdict("heel_strike_bias", 0.01, -0.02) == "worse"


def test_recordings_and_data_sets_on_one_side_only_are_listed():
    present = copy.deepcopy(OLD)
    loops = present["default"]["loops"]
    loops["recordings"]["c"] = loops["recordings"].pop("b")
    loops["recordings"]["a"]["end_error"] = 0.5
    loops["summary"]["all"]["together"]["heel_strike_bias"] = 0.03
    present["default"]["climbs"] = present["default"].pop("walks")
    tables = comparison_tables(OLD, present)
    assert "loops, default, compared: 1 better, 1 worse, 5 the same" in tables
    rows = [line.split() for line in tables.splitlines()]
    assert ["end_error", "(a)", "1", "0.5", "better"] in rows and not any(row[:2] == ["path", "(a)"] for row in rows)
    assert ["heel_strike_bias", "(pooled)", "-0.02", "0.03", "worse"] in rows
    assert "scored then and not now: b\nnot scored then: c" in tables
    assert "evaluated then and not now: default: walks" in tables and "not evaluated then: default: climbs" in tables


@pytest.mark.parametrize(
    "text",
    [
        "",
        "[1, 2]",
        '{"default": {"loops": {"recordings": {"a": 1}}}}',
        "[" * 100_000,
        json.dumps(OLD).replace("60.0", "1" + "0" * 400),
    ],  # fmt: skip
    ids=range(5),
)
def test_a_file_without_scores_is_rejected_in_one_sentence(text, tmp_path):
    file = tmp_path / "old.json"
    file.write_text(text)
    with pytest.raises(RecordingError, match=r"old\.json: (is not JSON|does not hold the scores of an evaluation)"):
        read_scores(file)
    with pytest.raises(RecordingError, match="No such file"):
        read_scores(tmp_path / "none.json")
