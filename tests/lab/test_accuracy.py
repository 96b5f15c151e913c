"""Accuracy of recipes on recorded data: the figures of docs/accuracy.md and docs/recipes.md, with their bounds.

    python -m pytest -m "long or soak" tests/lab/test_accuracy.py

docs/accuracy.md quotes the default recipe, docs/recipes.md the recipes for pressure."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from quoted import below, nearly_the_same

from solepath_lab.evaluate.jobs import find_data_sets
from solepath_lab.evaluate.report import Result
from solepath_lab.tables.accuracy import accuracy_table

Evaluated = Callable[[str, str], Result]
SOAK, LONG = pytest.mark.soak, pytest.mark.long
VENDOR = {
    "heel_strike_f1": (0.97, 1.0), "toe_off_f1": (0.97, 1.0), "heel_strike_mad": (0.0, 0.015),
    "toe_off_mad": (0.0, 0.015), "strides_invented": (0, 0), "stride_error": (0.0, 0.04),
    "stride_time_error_median": (0.0, 0.02),
}  # fmt: skip
IPOL = {
    "heel_strike_f1": (0.97, 1.0), "toe_off_f1": (0.97, 1.0), "heel_strike_bias": (-0.03, 0.03),
    "toe_off_bias": (-0.03, 0.03), "leg_error_median": (0.0, 0.03), "body_leg_error_median": (0.0, 0.03),
}  # fmt: skip
CONTACTS = {"heel_strike_f1": (0.97, 1.0), "toe_off_f1": (0.97, 1.0)}


@pytest.mark.parametrize(
    ("data_set", "recipe", "count", "bounds"),
    [
        # thresholds tuned on the truth of each trial have a mean of 0.056 m
        pytest.param("pyshoe_vicon", "default", 28, {"armse_2d": (0.0, 0.13)}, marks=LONG),
        pytest.param("gumushane_surveyed", "default", None, {"stride_error": (0.0, 0.025)}, marks=LONG),
        pytest.param("openshoe_loops", "default", 7, {"end_error": (0.0, 0.6), "strides_invented": (0, 0)}, marks=LONG),
        pytest.param("moticon_opengo", "default", None, VENDOR, marks=SOAK),
        pytest.param("moticon_pressed", "default", None, VENDOR, marks=SOAK),
        pytest.param("ipol_10m_uturn", "default", None, IPOL, marks=LONG),
        pytest.param("gaitmap_examples", "default", None, {"heel_strike_f1": (0.97, 1.0)}, marks=LONG),
        pytest.param("gaitpdb_vgrf", "kupt-dfpc", None, CONTACTS, marks=LONG),
        pytest.param("gaitpdb_vgrf", "pressure-contour", None, CONTACTS, marks=LONG),
        pytest.param("smart_insole_35", "pressure-contour", None, {"armse_2d": (0.0, 0.20)}, marks=SOAK),
    ],
)
def test_a_data_set_comes_to_the_figures_that_are_claimed(
    evaluated: Evaluated, data_set: str, recipe: str, count: int | None, bounds: dict[str, tuple[float, float]]
) -> None:
    result = evaluated(data_set, recipe)
    summary = result.summaries[0]
    assert not result.failures and len(result.scores) == (count or len(result.scores))
    for figure, (least, most) in bounds.items():
        found = summary.together[figure] if figure in summary.together else summary.mean[figure]
        assert found is not None and least <= found <= most, figure
    true = summary.together.get("strides_true")
    if true is not None:
        assert summary.together["strides_found"] >= (0.95 if data_set == "gumushane_surveyed" else 1.0) * true


@pytest.mark.long
def test_the_surveyed_footprints_are_nearer_than_their_authors_own_system_had_them(evaluated: Evaluated) -> None:
    figures = [score.figures for score in evaluated("gumushane_surveyed", "default").scores]
    known = [walk for walk in figures if walk["authors"] is not None]
    assert sum(walk["authors_beaten"] for walk in known) >= 5 and len(known) == 6
    assert sum(walk["position_mean"] for walk in known) / len(known) < 1.27


@pytest.mark.soak
def test_a_known_velocity_is_no_worse_than_a_zero_velocity_on_recorded_insoles(evaluated: Evaluated) -> None:
    kupt, zupt = (evaluated("smart_insole_35", name).summaries[0].mean["armse_2d"] for name in ("kupt-dfpc", "zupt"))
    assert kupt is not None and zupt is not None and kupt <= zupt


@pytest.mark.long
def test_the_accuracy_that_is_quoted_is_what_evaluate_prints(evaluated: Evaluated, data_dir: Path) -> None:
    """solepath-lab evaluate DIR --recipe default --markdown prints it, before the data that need training in folds."""
    results = [evaluated(found.name, "default") for found in find_data_sets(data_dir) if not found.folds]
    nearly_the_same(below("accuracy"), accuracy_table(results).splitlines())
