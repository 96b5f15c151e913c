"""Step width and step length of emulated walks: by ranges between the feet, and unknown without them."""

from __future__ import annotations

from functools import cache

import pytest

from solepath.emulate.sensors.ranging import ULTRA_WIDEBAND, ULTRASOUND, RangeErrors
from solepath.lab.emulated.steps import (
    StepScore,
    covered,
    guess_error,
    main,
    mean_error,
    score_steps,
    walk_of,
    width_of,
)

SEED, WALKS = 301, 6


@cache
def scores(errors: RangeErrors | None) -> list[StepScore]:
    """Return the scores of walks whose widths are spread from 5 to 18 cm."""
    return [score_steps(walk_of(SEED + k, width_of(k, WALKS)), errors) for k in range(WALKS)]


@pytest.mark.parametrize("errors", [ULTRASOUND, ULTRA_WIDEBAND], ids=lambda errors: errors.name)
def test_ranges_show_the_width_to_2_cm_and_twice_as_well_as_any_constant_guess(errors: RangeErrors) -> None:
    found = scores(errors)
    error = mean_error(found)
    assert error is not None
    assert error <= 0.02
    assert error <= 0.5 * guess_error(found)
    assert all(len(score.errors) > 0.8 * score.cycles for score in found)


@pytest.mark.parametrize("errors", [ULTRASOUND, ULTRA_WIDEBAND], ids=lambda errors: errors.name)
@pytest.mark.parametrize("name", ["width", "length"])
def test_standard_deviations_are_not_too_small(errors: RangeErrors, name: str) -> None:
    found = scores(errors)
    assert covered(found, 1.0, name) >= 0.6
    assert covered(found, 2.0, name) >= 0.93


def test_without_ranges_nothing_is_reported() -> None:
    found = scores(None)
    assert all(score.width is None and not score.errors and score.cycles > 40 for score in found)
    assert mean_error(found) is None


def test_the_command_prints_a_row_for_each_sensor(capsys: pytest.CaptureFixture[str]) -> None:
    main(["--walks", "1", "--seed", "305", "--bias", "0.02"])
    lines = capsys.readouterr().out.splitlines()
    assert [line.split(" | ")[0].strip("| ") for line in lines[2:]] == [
        "constant guess",
        "no range",
        "ultrasound",
        "ultra-wideband",
    ]
    assert all(line.count("|") == lines[0].count("|") for line in lines)
