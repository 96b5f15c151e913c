"""How the recipes of pressure do on recorded insoles: the figures that docs/recipes.md quotes, with their bounds."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from solepath.lab.evaluate.report import Result

Evaluated = Callable[[str, str], Result]


def f1(result: Result, kind: str) -> float:
    value = result.summaries[0].together[f"{kind}_f1"]
    assert value is not None
    return value


def rms(result: Result) -> float:
    """Of the positions against the truth, m, the mean of all recordings."""
    value = result.summaries[0].mean["armse_2d"]
    assert value is not None
    return value


@pytest.mark.soak
@pytest.mark.parametrize("recipe", ["kupt-dfpc", "zupt", "pressure-contour"])
def test_contacts_of_eight_force_sensors_alone_are_found(evaluated: Evaluated, recipe: str) -> None:
    result = evaluated("gaitpdb_vgrf", recipe)
    assert min(f1(result, "heel_strike"), f1(result, "toe_off")) >= 0.97


def test_contacts_of_heel_and_toe_switches_are_found(evaluated: Evaluated) -> None:
    """Of the toe-offs that are missed most are toes that a standing wearer lifts."""
    result = evaluated("marpino_pressed", "kupt-dfpc")
    assert f1(result, "heel_strike") >= 0.95
    assert f1(result, "toe_off") >= 0.93


def test_a_known_velocity_is_no_worse_than_a_zero_velocity_on_recorded_insoles(evaluated: Evaluated) -> None:
    kupt, zupt = (rms(evaluated("smart_insole_35", recipe)) for recipe in ("kupt-dfpc", "zupt"))
    assert kupt <= zupt


def test_the_contour_of_heel_pressure_tells_zero_velocity_on_recorded_insoles(evaluated: Evaluated) -> None:
    assert rms(evaluated("smart_insole_35", "pressure-contour")) <= 0.20
