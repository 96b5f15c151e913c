"""Drift from laps of a square: a known slope is found, and one that the laps disagree on is not."""

from __future__ import annotations

from functools import cache
from math import pi, sqrt

import pytest
from attrs import evolve

from solepath.calibration import Calibration, CalibrationError
from solepath.emulate.sensors.insole_device import Insole
from solepath.emulate.sensors.parts import AttitudeErrors
from solepath.emulate.walk import EmulatedWalk, emulate
from solepath.papers.pressure_contour.bias_zupt import BiasZupt, BiasZuptSettings
from solepath.papers.pressure_contour.recipe import GYROSCOPE
from solepath.papers.pressure_contour.square import SquareDrift, check_laps, fit_drift, square_drift
from solepath.recipes import DEFAULT, Recipe
from solepath.recording.decoded import decode_recording
from solepath.types import Foot, Packet, Sample, Site, Vec3
from solepath_lab.emulated.laps import square

LEFT = Foot.LEFT
EXACT_ATTITUDE = AttitudeErrors("exact", tilt=0.0, heading=0.0)
MARKS_PER_LAP = 8


@cache
def walk_laps() -> EmulatedWalk:
    """Four rounds of a small square, each foot on eight marks, in a device that knows its attitude."""
    spacing_of_40 = square(4, edge=11.7 * MARKS_PER_LAP / 40.0, corner=0.5)
    route = evolve(
        spacing_of_40,
        actions=tuple(
            evolve(action, spacing=action.spacing * 40.0 / MARKS_PER_LAP)
            if getattr(action, "spacing", None)
            else action
            for action in spacing_of_40.actions
        ),
    )
    device = Insole(rate=50.0, quaternion=True, attitude=EXACT_ATTITUDE, north=0.7)
    return emulate(route, devices={Site.LEFT_FOOT: device}, seed=109)


@cache
def samples() -> tuple[Packet | Sample, ...]:
    """Return the samples without their pressures, for the gyroscope alone."""
    return tuple(evolve(sample, pressure=None) for sample in decode_recording(walk_laps().packets).samples)


def drifting_recipe(x: float, y: float) -> Recipe:
    """Return a recipe whose positions drift by (x, y) m/s in the device's own world."""
    return evolve(GYROSCOPE, corrector=BiasZupt(BiasZuptSettings(drift=(-x, -y))))


@cache
def measured(*drift: float) -> SquareDrift:
    recipe = drifting_recipe(*drift) if drift else GYROSCOPE
    return square_drift(samples(), steps_per_lap=MARKS_PER_LAP, recipe=recipe)


def test_a_known_slope_comes_out_in_the_frame_of_the_device_and_is_kept_if_all_laps_agree_on_it() -> None:
    without, with_it = measured(), measured(0.04, -0.025)
    assert with_it.slope[0] - without.slope[0] == pytest.approx(0.04, abs=2e-4)
    assert with_it.slope[1] - without.slope[1] == pytest.approx(-0.025, abs=2e-4)
    assert with_it.marks == MARKS_PER_LAP and with_it.foot is LEFT
    assert with_it.agreed and with_it.kept == with_it.slope
    assert not without.agreed and without.kept == (0.0, 0.0)


def test_laps_agree_when_a_wandering_foot_would_do_so_once_in_a_hundred_times() -> None:
    # four laps, three movements, k = 2: slope^2 / (2 s^2) > 2 (100^(1/2) - 1) = 18
    def visits(first: float, second: float, third: float) -> list[tuple[float, Vec3]]:
        x = (0.0, first, first + second, first + second + third)
        return [(60.0 * k, (at, 0.0, 0.0)) for k, at in enumerate(x)]

    def agreed(spread: float) -> bool:
        # movements of 1 - spread, 1 and 1 + spread m a minute: variance spread^2 along x, none along y
        return fit_drift(LEFT, {"A": visits(1.0 - spread, 1.0, 1.0 + spread)}, 0.0).agreed

    # s^2 = spread^2 / 2 / 3, slope 1: 3 / spread^2 > 18
    assert agreed(0.40) and not agreed(0.42)


def test_a_drift_that_was_known_before_changes_nothing() -> None:
    known = Calibration(drift={LEFT: (0.5, 0.5)})
    assert square_drift(samples(), steps_per_lap=MARKS_PER_LAP, recipe=GYROSCOPE, calibration=known) == measured()


def test_slope_and_scatter_of_two_marks_in_four_laps_by_hand() -> None:
    # the mark A moves by 1, 3 and 2 m and then by 1, 3 and 5 a lap of 10 s along x and y, B by 0.2 m/s along x:
    # laps move by the means (0.15, 0.05), (0.25, 0.15), (0.2, 0.25) m/s; variances 0.0025 and 0.01
    first = [(10.0 * k, (x, y, 9.0 * k)) for k, (x, y) in enumerate(((0.0, 0.0), (1.0, 1.0), (4.0, 4.0), (6.0, 9.0)))]
    second = [(10.0 * k + 5.0, (2.0 * k, 7.0, 0.0)) for k in range(4)]
    twice = [(10.0 * k, (100.0 * k, 0.0, 0.0)) for k in range(2)]
    back = [(10.0 * (k % 3), (100.0 * k, 0.0, 0.0)) for k in range(4)]
    found = fit_drift(LEFT, {"A": first, "B": second, "twice": twice, "back": back}, 0.0)
    # A by least squares over -15, -5, 5, 15 s: (90 - 5 + 20) / 500 = 0.21 and (135 - 5 + 20) / 500 = 0.3
    assert found.slope == pytest.approx((0.5 * (0.21 + 0.2), 0.15))
    assert found.scatter == pytest.approx(sqrt(0.5 * (0.0025 + 0.01) / 3.0))
    assert (found.marks, found.visits, found.foot) == (2, 8, LEFT)
    turned = fit_drift(LEFT, {"A": first, "B": second}, 0.5 * pi)
    assert turned.slope == pytest.approx((-0.15, 0.5 * (0.21 + 0.2)))


def visits_at(*places: tuple[float, float, float]) -> dict[str, list[tuple[float, Vec3]]]:
    """Return visits of four marks, from rows of t (s), x and y (m)."""
    visits: dict[str, list[tuple[float, Vec3]]] = {}
    for number, (t, x, y) in enumerate(places):
        visits.setdefault(str(number % 4), []).append((t, (x, y, 0.0)))
    return visits


def laps_of_four(drift: float, turn: float = 0.0) -> dict[str, list[tuple[float, Vec3]]]:
    """Four laps of a square of 12 m, a corner every 15 s, that moves by `drift` m/s along y, and by `turn` m along x
    after two laps."""
    corners = ((0.0, 0.0), (12.0, 0.0), (12.0, 12.0), (0.0, 12.0))
    return visits_at(
        *[
            (15.0 * k, corners[k % 4][0] + (turn if k >= 8 else 0.0), corners[k % 4][1] + drift * 15.0 * k)
            for k in range(16)
        ]
    )


def test_laps_that_drift_by_some_centimetres_a_second_are_taken() -> None:
    check_laps(fit_drift(LEFT, laps_of_four(0.045), 0.0), laps_of_four(0.045))


def test_a_faster_drift_is_no_drift() -> None:
    with pytest.raises(CalibrationError, match="a drift of 6.0 cm/s: more than 5 cm/s are no drift"):
        check_laps(fit_drift(LEFT, laps_of_four(0.06), 0.0), laps_of_four(0.06))


def test_a_straight_walk_is_no_laps() -> None:
    straight = visits_at(*[(1.1 * k, 1.3 * k, 0.0) for k in range(20)])
    with pytest.raises(CalibrationError, match="laps do not close: a mark lies 5.2 m from"):
        check_laps(fit_drift(LEFT, straight, 0.0), straight)


@pytest.mark.parametrize(("turn", "closes"), [(6.6, True), (7.8, False)])
def test_laps_close_within_a_quarter_of_the_diagonal_and_the_largest_drift(turn: float, closes: bool) -> None:
    """The middles of the marks of 12 by 12 m lie 17.0 m apart: 4.24 m and 60 s times 0.05 m/s are 7.24 m."""
    laps = laps_of_four(0.0, turn)
    drift = evolve(fit_drift(LEFT, laps, 0.0), slope=(0.0, 0.0))
    if closes:
        check_laps(drift, laps)
    else:
        with pytest.raises(CalibrationError, match="laps do not close: a mark lies 7.8 m from where it lay a lap"):
            check_laps(drift, laps)


def failure_of(**changes: object) -> str:
    with pytest.raises(CalibrationError) as error:
        square_drift(**{"items": samples(), "recipe": GYROSCOPE, "steps_per_lap": MARKS_PER_LAP, **changes})  # type: ignore[arg-type]
    assert "\n" not in str(error.value)
    return str(error.value)


def test_an_unusable_walk_is_reported_in_one_line() -> None:
    assert "less than 3 laps of 40 marks" in failure_of(steps_per_lap=40)
    assert failure_of(items=()) == "no stride of the left foot in the recording"
    assert failure_of(foot=Foot.RIGHT) == "no stride of the right foot in the recording"
    assert failure_of(recipe=DEFAULT) == "recipe default takes no drift off"
    assert failure_of(steps_per_lap=3) == "3 marks are no square"
