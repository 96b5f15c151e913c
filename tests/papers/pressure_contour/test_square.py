"""Drift from laps of a square: a known slope is found, and one that the laps disagree on is not."""

from __future__ import annotations

from functools import cache
from math import hypot
from pathlib import Path

import pytest
from attrs import evolve
from walks import of, run_session

from solepath import StrideTaken
from solepath.calibration import Calibration, CalibrationError
from solepath.emulate.routes.laps import square
from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.insole_device import Insole
from solepath.emulate.sensors.parts import AttitudeErrors
from solepath.emulate.walk import EmulatedWalk, emulate
from solepath.papers.pressure_contour.bias_zupt import BiasZupt, BiasZuptSettings
from solepath.papers.pressure_contour.recipe import GYROSCOPE
from solepath.papers.pressure_contour.square import CornerMark, check_laps, fit_drift, read_marks, square_drift
from solepath.recipes import DEFAULT, Recipe
from solepath.recording.decoded import decode_recording
from solepath.types import Foot, Packet, Sample, Site, Vec3

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


def test_a_known_slope_comes_out_in_the_frame_of_the_device() -> None:
    without = square_drift(samples(), steps_per_lap=MARKS_PER_LAP, recipe=GYROSCOPE)
    with_it = square_drift(samples(), steps_per_lap=MARKS_PER_LAP, recipe=drifting_recipe(0.03, -0.02))
    assert with_it.slope[0] - without.slope[0] == pytest.approx(0.03, abs=2e-4)
    assert with_it.slope[1] - without.slope[1] == pytest.approx(-0.02, abs=2e-4)
    assert with_it.marks == MARKS_PER_LAP and with_it.foot is LEFT


def test_a_drift_that_all_laps_agree_on_is_kept_and_then_taken_off() -> None:
    fast = (0.04, -0.025)
    found = square_drift(samples(), steps_per_lap=MARKS_PER_LAP, recipe=drifting_recipe(*fast))
    assert found.agreed and found.kept == found.slope

    def end(recipe: Recipe, calibration: Calibration) -> StrideTaken:
        last: StrideTaken = of(StrideTaken, run_session(samples(), recipe, calibration=calibration))[-1]
        return last

    # what the recipe adds, the calibration takes off again, but for the stands, in which nothing is taken off
    plain, corrected = end(GYROSCOPE, Calibration()), end(GYROSCOPE, Calibration(drift={LEFT: fast}))
    apart = hypot(*(a - b for a, b in zip(plain.position[:2], corrected.position[:2], strict=True)))
    assert apart == pytest.approx(hypot(*fast) * plain.t, rel=0.1)


def test_a_drift_that_laps_disagree_on_is_removed_only_on_request() -> None:
    found = square_drift(samples(), steps_per_lap=MARKS_PER_LAP, recipe=GYROSCOPE)
    assert not found.agreed and found.kept == (0.0, 0.0)


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


def test_the_slope_is_the_mean_of_the_marks_lines() -> None:
    # by least squares: (0, 0), (1, 1), (2, 5) has the slope 2.5, and (0, 0), (1, 3), (2, 3) has 1.5
    first = [(0.0, (0.0, 0.0, 0.0)), (1.0, (1.0, 0.0, 0.0)), (2.0, (5.0, 0.0, 0.0))]
    second = [(0.0, (0.0, 0.0, 0.0)), (1.0, (3.0, 0.0, 0.0)), (2.0, (3.0, 0.0, 0.0))]
    found = fit_drift(LEFT, {"A": first, "B": second}, 0.0)
    assert found.slope == pytest.approx((2.0, 0.0)) and (found.marks, found.visits) == (2, 6)


def test_marks_by_time_give_the_same_as_counted_steps() -> None:
    steps = of(StrideTaken, run_session(samples(), GYROSCOPE))
    marks = [CornerMark(str(k % MARKS_PER_LAP), step.t + 0.1) for k, step in enumerate(steps)]
    counted = square_drift(samples(), steps_per_lap=MARKS_PER_LAP, recipe=GYROSCOPE)
    assert square_drift(samples(), marks=marks, recipe=GYROSCOPE) == counted


def test_a_drift_known_before_is_not_taken_off_while_calibrating() -> None:
    known = Calibration(drift=(0.5, 0.5))
    assert square_drift(samples(), steps_per_lap=MARKS_PER_LAP, recipe=GYROSCOPE, calibration=known) == square_drift(
        samples(), steps_per_lap=MARKS_PER_LAP, recipe=GYROSCOPE
    )


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


def test_laps_that_do_not_close_are_rejected_though_their_slope_is_small() -> None:
    skewed = laps_of_four(0.0, turn=9.0)
    with pytest.raises(CalibrationError, match="laps do not close: a mark lies 9.0 m from where it lay a lap before"):
        check_laps(fit_drift(LEFT, skewed, 0.0), skewed)


def test_a_straight_walk_is_no_laps() -> None:
    straight = visits_at(*[(1.1 * k, 1.3 * k, 0.0) for k in range(20)])
    with pytest.raises(CalibrationError, match="laps do not close: a mark lies 5.2 m from"):
        check_laps(fit_drift(LEFT, straight, 0.0), straight)
    walk = emulate(Route().stand(2.0).walk(25.0, 1.2).stop(1.0), devices={Site.LEFT_FOOT: Insole(rate=50.0)}, seed=3)
    assert "the laps do not close" in failure_of(items=walk.packets, steps_per_lap=4)


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
    assert failure_of(marks=[CornerMark("a", 1e4)]) == "no stride ends at mark a near 10000.00 s"
    assert failure_of(marks=[CornerMark("a", 5.0)]) == "no mark was stood on 3 times"
    assert failure_of(steps_per_lap=0) == "0 marks are no square"


def test_marks_are_read_from_a_table(tmp_path: Path) -> None:
    file = tmp_path / "marks.csv"
    file.write_text("mark,t\nA1,3.5\nA2,4.75\n")
    assert read_marks(file) == (CornerMark("A1", 3.5), CornerMark("A2", 4.75))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("mark,t\nA1,soon\n", "line 2: t is 'soon', not a number"),
        ("mark,t\nA1,1.0\n,2.0\n", "line 3: nothing in column mark"),
        ("mark,t\nA1,nan\n", "line 2: t is 'nan', not a finite number"),
        ("a,b\n1,2\n", "line 1: needs one column mark and one column t"),
        ("mark,t\n", "no visits of marks"),
        ("", "line 1: needs one column mark"),
    ],
)
def test_a_table_of_something_else_is_named(tmp_path: Path, text: str, message: str) -> None:
    file = tmp_path / "marks.csv"
    file.write_text(text)
    with pytest.raises(CalibrationError, match=message):
        read_marks(file)


def test_no_file_and_no_text_are_named(tmp_path: Path) -> None:
    with pytest.raises(CalibrationError, match="No such file"):
        read_marks(tmp_path / "none.csv")
    (tmp_path / "bytes.csv").write_bytes(b"\xff\xfe\x00mark")
    with pytest.raises(CalibrationError, match="is not a csv file"):
        read_marks(tmp_path / "bytes.csv")
