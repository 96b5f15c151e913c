"""Accuracy of recipes on recorded data: the figures of docs/accuracy.md and docs/recipes.md, with their bounds.

docs/accuracy.md quotes the default recipe, docs/recipes.md the recipes for pressure.

python -m pytest -m "soak or not soak" tests/lab/test_accuracy.py      # with the slowest tests: two minutes
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from quoted import below, nearly_the_same

from solepath.lab.evaluate.jobs import find_data_sets
from solepath.lab.evaluate.report import Result
from solepath.lab.measures.score import Scored, Summary
from solepath.lab.tables.markdown import accuracy_table

Evaluated = Callable[[str, str], Result]


def scores(evaluated: Evaluated, data_set: str) -> tuple[dict[str, Scored], Summary]:
    """Return the scores of each recording by its name, and the summary of all."""
    result = evaluated(data_set, "default")
    assert not result.failures
    return {score.recording: score for score in result.scores}, result.summaries[0]


@pytest.mark.soak
def test_vicon_tracks_of_28_trials_with_one_causal_configuration(evaluated: Evaluated) -> None:
    """Thresholds tuned on the truth of each trial have a mean of 0.056 m."""
    trials, summary = scores(evaluated, "pyshoe_vicon")
    assert len(trials) == 28
    assert summary.mean["armse_2d"] <= 0.13
    assert summary.median["armse_2d"] <= 0.08


@pytest.mark.soak
def test_vicon_tracks_of_ordinary_walking(evaluated: Evaluated) -> None:
    result = evaluated("pyshoe_vicon", "default")
    (bipedal,) = (summary for summary in result.summaries if summary.group == "bipedal")
    assert bipedal.mean["armse_2d"] <= 0.08


def test_the_surveyed_footprints_are_nearer_than_their_authors_own_system_had_them(evaluated: Evaluated) -> None:
    walks, _ = scores(evaluated, "gumushane_surveyed")
    known = [walk.figures for walk in walks.values() if walk.figures["authors"] is not None]
    assert sum(walk["authors_beaten"] for walk in known) >= 5 and len(known) == 6
    assert sum(walk["position_mean"] for walk in known) / len(known) < 1.27


def test_every_surveyed_stride_is_found_and_its_length_known(evaluated: Evaluated) -> None:
    walks, summary = scores(evaluated, "gumushane_surveyed")
    assert summary.together["strides_found"] >= 0.95 * summary.together["strides_true"]
    assert summary.together["stride_error"] <= 0.025
    for name in ("exp31", "exp33", "exp37"):
        strides = walks[name].strides
        assert (strides.n_found, strides.n_invented) == (strides.n_true, 0), name


def test_a_closed_loop_of_60_m_ends_near_its_start(evaluated: Evaluated) -> None:
    walks, _ = scores(evaluated, "xio_closed_walks")
    assert walks["long_walk"].figures["end_error"] <= 0.42


def test_no_stance_of_a_brisk_figure_of_eight_is_lost(evaluated: Evaluated) -> None:
    """The strides were counted by eye. Two that are merged would be longer than any step of these wearers."""
    walks, summary = scores(evaluated, "openshoe_loops")
    assert len(walks) == 7
    for name, walk in walks.items():
        assert walk.strides is not None and walk.strides.longest is not None
        assert (walk.strides.n_found, walk.strides.n_invented) == (walk.strides.n_true, 0), name
        assert walk.strides.longest <= 2.2, name
    assert summary.mean["end_error"] <= 0.6


@pytest.mark.parametrize("data_set", ["moticon_opengo", "moticon_pressed"])
def test_contacts_and_strides_are_those_of_the_vendor_of_the_insoles(evaluated: Evaluated, data_set: str) -> None:
    _, summary = scores(evaluated, data_set)
    found = summary.together
    assert min(found["heel_strike_f1"], found["toe_off_f1"]) >= 0.97
    assert max(found["heel_strike_mad"], found["toe_off_mad"]) <= 0.015
    assert found["strides_found"] == found["strides_true"] and found["strides_invented"] == 0
    assert found["stride_error"] <= 0.04
    assert found["stride_time_error_median"] <= 0.02


@pytest.mark.soak
def test_contacts_of_both_feet_are_found_in_spite_of_radio_losses(evaluated: Evaluated) -> None:
    _, summary = scores(evaluated, "ipol_10m_uturn")
    for kind in ("heel_strike", "toe_off"):
        assert summary.together[f"{kind}_f1"] >= 0.97
        assert abs(summary.together[f"{kind}_bias"]) <= 0.03


@pytest.mark.soak  # half a minute of two processors
def test_ten_metres_and_back_are_ten_metres(evaluated: Evaluated) -> None:
    _, summary = scores(evaluated, "ipol_10m_uturn")
    assert summary.together["leg_error_median"] <= 0.03
    assert summary.together["body_leg_error_median"] <= 0.03


def test_initial_contacts_are_those_of_motion_capture(evaluated: Evaluated) -> None:
    walks, summary = scores(evaluated, "gaitmap_examples")
    assert summary.together["heel_strike_f1"] >= 0.97
    assert abs(walks["walk_4x10m_ic"].events["heel_strike"].bias) <= 0.015


@pytest.mark.soak
def test_the_accuracy_that_is_quoted_is_what_evaluate_prints(evaluated: Evaluated, data_dir: Path) -> None:
    """solepath evaluate DIR --recipe default --markdown prints it, before the data that need training in folds."""
    results = [evaluated(found.name, "default") for found in find_data_sets(data_dir) if not found.folds]
    nearly_the_same(below("accuracy"), accuracy_table(results).splitlines())


def f1(result: Result, kind: str) -> float:
    value = result.summaries[0].together[f"{kind}_f1"]
    assert value is not None
    return value


def rms(result: Result) -> float:
    """Return the mean ARMSE2d of all recordings, m."""
    value = result.summaries[0].mean["armse_2d"]
    assert value is not None
    return value


@pytest.mark.soak
@pytest.mark.parametrize("recipe", ["kupt-dfpc", "zupt", "pressure-contour"])
def test_contacts_of_eight_force_sensors_alone_are_found(evaluated: Evaluated, recipe: str) -> None:
    result = evaluated("gaitpdb_vgrf", recipe)
    assert min(f1(result, "heel_strike"), f1(result, "toe_off")) >= 0.97


def test_contacts_of_heel_and_toe_switches_are_found(evaluated: Evaluated) -> None:
    result = evaluated("marpino_pressed", "kupt-dfpc")
    assert f1(result, "heel_strike") >= 0.95
    assert f1(result, "toe_off") >= 0.95


def test_a_known_velocity_is_no_worse_than_a_zero_velocity_on_recorded_insoles(evaluated: Evaluated) -> None:
    kupt, zupt = (rms(evaluated("smart_insole_35", recipe)) for recipe in ("kupt-dfpc", "zupt"))
    assert kupt <= zupt


def test_the_contour_of_heel_pressure_detects_zero_velocity_on_recorded_insoles(evaluated: Evaluated) -> None:
    assert rms(evaluated("smart_insole_35", "pressure-contour")) <= 0.20
