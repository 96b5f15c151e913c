"""How the recipes of pressure do on recorded insoles: the figures that docs/recipes.md quotes, with their bounds."""

from __future__ import annotations

from pathlib import Path

import pytest

from solepath.evaluate.jobs import evaluate
from solepath.evaluate.report import Result

RECIPES = ("kupt-dfpc", "zupt", "pressure-contour")
DATA = ("smart_insole_35", "marpino_pressed", "gaitpdb_vgrf")


@pytest.fixture(scope="module")
def scored(data_dir: Path) -> dict[tuple[str, str], Result]:
    """By recipe and data set."""
    results = evaluate(data_dir, RECIPES, only=DATA, processes=2)
    return {(result.recipe, result.data_set.name): result for result in results}


def f1(result: Result, kind: str) -> float:
    value = result.summaries[0].together[f"{kind}_f1"]
    assert value is not None
    return value


def test_contacts_of_eight_force_sensors_alone_are_found(scored) -> None:
    for recipe in RECIPES:
        result = scored[recipe, "gaitpdb_vgrf"]
        assert min(f1(result, "heel_strike"), f1(result, "toe_off")) >= 0.97, recipe


def test_contacts_of_heel_and_toe_switches_are_found(scored) -> None:
    """Of the toe-offs that are missed most are toes that a standing wearer lifts."""
    result = scored["kupt-dfpc", "marpino_pressed"]
    assert f1(result, "heel_strike") >= 0.95
    assert f1(result, "toe_off") >= 0.93


def test_a_known_velocity_is_no_worse_than_a_zero_velocity_on_recorded_insoles(scored) -> None:
    kupt, zupt = (scored[recipe, "smart_insole_35"].summaries[0].mean["armse_2d"] for recipe in ("kupt-dfpc", "zupt"))
    assert kupt is not None and zupt is not None
    assert kupt <= zupt


def test_the_contour_of_heel_pressure_tells_zero_velocity_on_recorded_insoles(scored) -> None:
    error = scored["pressure-contour", "smart_insole_35"].summaries[0].mean["armse_2d"]
    assert error is not None and error <= 0.20
