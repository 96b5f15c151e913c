"""Calibrations of walking modes against what is known exactly: a gauge, marks on the floor, a standing pose."""

from __future__ import annotations

from functools import cache
from math import cos, hypot, pi, sin, sqrt
from pathlib import Path

import pytest
from attrs import evolve
from cases import sole
from corpus import given

from solepath.calibration import Calibration, CalibrationError, Limbs, Newtons
from solepath.events import TouchedDown
from solepath.foot.pressure.insole import in_newtons
from solepath.papers.walking_modes.calibrate import (
    ModeMark,
    StepError,
    fit_modes,
    mean_errors,
    read_marks,
    step_errors,
    touchdowns,
)
from solepath.papers.walking_modes.limbs.limbs import SEGMENTS
from solepath.papers.walking_modes.limbs.standing import check_standing, limbs_of
from solepath.papers.walking_modes.newton import fit_gauge
from solepath.recording.decoded import DecodedRecording
from solepath.types import Foot, Sample, Site, WalkingMode
from solepath.types.vector import GRAVITY, from_rotation_vector

LEFT, RIGHT = Foot.LEFT, Foot.RIGHT
STRAIGHT, WIDE = WalkingMode.STRAIGHT, WalkingMode.LEFT_WIDE


# --- a gauge ----------------------------------------------------------------------------------------------------------


def force_of(counts: float) -> float:
    """Return the force on a cell, N: a cubic with 1 N at 0 and 201 N at 16000 counts."""
    u = counts / 16000.0
    return 1.0 + 60.0 * u + 40.0 * u**2 + 100.0 * u**3


def write_gauge(path: Path, rows: list[tuple[float, float]], *lines: str) -> Path:
    path.write_text("\n".join(["counts,newtons", *[f"{counts},{force}" for counts, force in rows], *lines]) + "\n")
    return path


def test_the_cubic_of_a_gauge_is_found_and_what_lies_beside_it_is_its_residual(tmp_path: Path) -> None:
    # -1, 5, -10, 10, -5, 1 is orthogonal to every cubic over six equal steps: root mean square sqrt(252 / 6)
    aside = (-0.2, 1.0, -2.0, 2.0, -1.0, 0.2)
    rows = [(3000.0 * k, force_of(3000.0 * k) + aside[k]) for k in range(6)]
    found = fit_gauge(write_gauge(tmp_path / "g.csv", rows))
    coefficients = (1.0, 60.0 / 16000.0, 40.0 / 16000.0**2, 100.0 / 16000.0**3)
    assert found.newtons == Newtons(pytest.approx(coefficients, rel=1e-9), 5.0, rows[-1][1])  # type: ignore[arg-type]
    assert found.residual == pytest.approx(0.2 * sqrt(42.0)) and found.worst == pytest.approx(2.0)
    assert found.points == 6


@pytest.mark.parametrize(
    ("rows", "line", "message"),
    [
        ([(0.0, 0.0)] * 3, "hello,5", "line 5: counts is 'hello', not a number"),
        ([(0.0, 0.0)] * 3, "7,5000.5", "line 5: newtons is 5000.5, which is not between 0 and 5000 N"),
        ([(k % 4, 20.0 * k) for k in range(8)], "3,200", "4 different counts, and a cubic needs 5 or more"),
        ([(k, 200.0 - 20.0 * k) for k in range(9)], "", "does not rise"),
        ([(k, k) for k in range(5)], "", "does not rise"),  # 4 N at most: the insole feels none of it
    ],
)
def test_a_gauge_that_shows_no_cubic_is_rejected(
    tmp_path: Path, rows: list[tuple[float, float]], line: str, message: str
) -> None:
    with pytest.raises(CalibrationError, match=message):
        fit_gauge(write_gauge(tmp_path / "g.csv", rows, line))


def test_forces_are_cut_at_the_largest_of_the_gauge_and_not_before(tmp_path: Path) -> None:
    for largest in (60.0, 800.0):
        newtons = fit_gauge(write_gauge(tmp_path / "g.csv", [(k, 0.1 * largest * k) for k in range(11)])).newtons
        assert newtons.most == largest
        assert in_newtons(newtons, (5.0, 10.0, 12.0)) == pytest.approx((0.5 * largest, largest, largest))


def test_five_counts_are_enough_and_forces_below_5_newtons_need_not_rise(tmp_path: Path) -> None:
    rows = [(k, max(200.0 * (k - 1.0) ** 3 / 27.0, 0.0)) for k in range(5)]
    assert fit_gauge(write_gauge(tmp_path / "g.csv", rows)).points == 5


# --- marks on the floor -----------------------------------------------------------------------------------------------

ERRORS = {
    (LEFT, STRAIGHT): (0.02, -0.01), (RIGHT, STRAIGHT): (-0.015, 0.004),
    (LEFT, WIDE): (0.03, 0.012), (RIGHT, WIDE): (0.01, -0.02),
}  # fmt: skip
"""How far, m, forward and to the left, the steps of a foot in a mode are measured short of their marks."""


def walk_on_marks(turned: float = 0.0) -> tuple[list[ModeMark], list[TouchedDown]]:
    """Return the marks of a circle of 3 m to the left in steps of 0.2 rad, and the touchdowns in a frame that is turned
    by `turned` against theirs. Chords of a circle are parallel to its tangent in the middle between their ends."""
    marked_points, downs = list[ModeMark](), list[TouchedDown]()
    x = y = 0.0
    for k in range(16):
        foot, mode = (LEFT, RIGHT)[k % 2], STRAIGHT if k < 9 else WIDE
        radius = 2.9 if foot is LEFT else 3.1
        mark = ModeMark(f"line {k}", foot, radius * sin(0.2 * k), 3.0 - radius * cos(0.2 * k), mode, t=float(k))
        if marked_points:
            before, along = marked_points[-1], 0.2 * (k - 0.5)
            forward, left = ERRORS[foot, mode]
            x += mark.x - before.x - cos(along) * forward + sin(along) * left
            y += mark.y - before.y - sin(along) * forward - cos(along) * left
        place = (cos(turned) * x + sin(turned) * y, cos(turned) * y - sin(turned) * x, 0.0)
        marked_points.append(mark)
        t = k + 0.29
        none = (0.0, 0.0, 0.0)
        downs.append(TouchedDown(t=t, known_at=t, foot=foot, position=place, mode=mode, compensation=none))
    return marked_points, downs


@pytest.mark.parametrize("turned", [0.0, 0.7])
def test_every_step_has_the_error_with_which_it_was_measured(turned: float) -> None:
    errors = step_errors(*walk_on_marks(turned), turn=turned)
    assert [(one.foot, one.mode) for one in errors] == [((LEFT, RIGHT)[k % 2], STRAIGHT if k < 9 else WIDE)
                                                        for k in range(3, 16)]  # fmt: skip
    for one in errors:
        assert (one.forward, one.left) == pytest.approx(ERRORS[one.foot, one.mode], abs=1e-12)


@pytest.mark.parametrize("turned", [0.0, 2.0])
def test_where_no_heading_is_given_the_turn_that_fits_all_steps_best_is_taken_out(turned: float) -> None:
    errors, about = step_errors(*walk_on_marks(turned)), step_errors(*walk_on_marks(turned + 0.01))
    assert [(one.forward, one.left) for one in errors] == [
        pytest.approx((one.forward, one.left), abs=1e-12) for one in about
    ]
    for one in errors:
        assert (one.forward, one.left) == pytest.approx(ERRORS[one.foot, one.mode], abs=0.01)
    exact = [evolve(one, position=(cos(turned) * mark.x + sin(turned) * mark.y,
                                   cos(turned) * mark.y - sin(turned) * mark.x, 0.0))
             for mark, one in zip(*walk_on_marks(), strict=True)]  # fmt: skip
    for one in step_errors(walk_on_marks()[0], exact):
        assert (one.forward, one.left) == pytest.approx((0.0, 0.0), abs=1e-12)


def test_steps_that_do_not_alternate_have_no_error() -> None:
    marked_points, downs = walk_on_marks()
    twice = [evolve(one, foot=RIGHT) if k == 8 else one for k, one in enumerate(downs)]
    marks_so = [evolve(one, foot=RIGHT) if k == 8 else one for k, one in enumerate(marked_points)]
    found = step_errors(marks_so, twice, turn=0.0)
    assert len(found) == 13 - 4, "four steps have the one that did not alternate among their four"
    # a touchdown without a mark likewise
    assert len(step_errors([*marked_points[:8], *marked_points[9:]], downs, turn=0.0)) == 13 - 4


def test_the_compensation_is_the_mean_error_by_foot_and_mode() -> None:
    errors = [
        StepError(LEFT, STRAIGHT, 0.01, -0.03),
        StepError(LEFT, STRAIGHT, 0.03, -0.01),
        StepError(RIGHT, STRAIGHT, 0.05, 0.03),
        StepError(RIGHT, WIDE, 0.0, 0.04),
    ]
    known = {LEFT: {STRAIGHT: (0.02, -0.02)}, RIGHT: {STRAIGHT: (0.05, 0.03), WIDE: (0.0, 0.04)}}
    found = mean_errors(errors)
    assert {foot: set(row) for foot, row in found.items()} == {foot: set(row) for foot, row in known.items()}
    assert all(found[foot][mode] == pytest.approx(pair) for foot, row in known.items() for mode, pair in row.items())


def test_a_mark_is_of_the_touchdown_nearest_to_its_time_or_of_its_number() -> None:
    marked_points, downs = walk_on_marks()
    numbered = [evolve(one, t=None, step=k // 2 + 1) for k, one in enumerate(marked_points)]
    assert step_errors(numbered, downs) == step_errors(marked_points, downs)
    # a second touchdown at 5.1 s is nearer to the mark's 5 s; the one at 5.29 s, which follows, has no mark then
    found = step_errors(marked_points, [*downs[:5], evolve(downs[5], t=5.1), *downs[5:]])
    assert [one.foot for one in found[:4]] == [RIGHT, LEFT, RIGHT, RIGHT] and len(found) == 14 - 4
    with pytest.raises(CalibrationError, match="line 6: the left foot did not come down at 6 s"):
        step_errors(marked_points, [evolve(one, t=one.t + 0.02) if k == 6 else one for k, one in enumerate(downs)])
    with pytest.raises(CalibrationError, match="line 0: the same touchdown as at line 0"):
        step_errors([*marked_points, marked_points[0]], downs)
    with pytest.raises(CalibrationError, match="line 9: the left foot came down 8 times only"):
        step_errors([ModeMark("line 9", LEFT, 0.0, 0.0, STRAIGHT, step=9)], downs)


def test_marks_are_read_from_a_table(tmp_path: Path) -> None:
    path = tmp_path / "marks.csv"
    path.write_text("foot,t,step,x,y,mode\nleft,,1,1.5,0.1,LEFT_WIDE\nright,2.5,7,-1.5,0.2,STRAIGHT\n")
    left, right = read_marks(path)
    assert left == ModeMark(f"{path}, line 2", LEFT, 1.5, 0.1, WIDE, step=1)
    assert right == ModeMark(f"{path}, line 3", RIGHT, -1.5, 0.2, STRAIGHT, t=2.5)


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("middle,1,,0,0,STRAIGHT", "line 2: foot is 'middle', not one of left, right"),
        ("left,1,,0,0,STANDING", "line 2: mode is 'STANDING', not one of STRAIGHT"),
        ("left,,,0,0,STRAIGHT", "line 2: neither t nor step"),
        ("left,,0,0,0,STRAIGHT", "line 2: step is 0, not a whole number from 1"),
        ("left,,2.5,0,0,STRAIGHT", "line 2: step is 2.5, not a whole number from 1"),
        ("", "no marks"),
    ],
)
def test_a_bad_mark_is_named(tmp_path: Path, line: str, message: str) -> None:
    path = tmp_path / "marks.csv"
    path.write_text(f"foot,t,step,x,y,mode\n{line}\n")
    with pytest.raises(CalibrationError, match=message):
        read_marks(path)


@cache
def suit() -> DecodedRecording:
    """Return a quarter of a minute of seven sensors, from the kept inputs of the golden corpus."""
    return DecodedRecording(tuple([item for item in given("suit") if item.t < 15.0]), {LEFT: sole(24, LEFT)})


@cache
def downs_of_suit(heading: float | None) -> list[TouchedDown]:
    return touchdowns(suit(), Calibration(), heading)


@pytest.mark.parametrize("heading", [0.4, None])
def test_a_walk_on_its_own_touchdowns_has_no_error_and_marks_elsewhere_teach_just_that(
    tmp_path: Path, heading: float | None
) -> None:
    path, downs = tmp_path / "marks.csv", downs_of_suit(heading)

    def fitted(aside: float) -> list[tuple[float, float]]:
        """Return the compensation of both feet where the left one's marks lie `aside` m to the left of the way."""
        lines = ["foot,t,x,y,mode"]
        for k, down in enumerate(downs):
            x, y, _ = down.position
            if down.foot is LEFT:  # the way goes from the touchdown before to the one after
                before, after = downs[max(k - 1, 0)].position, downs[min(k + 1, len(downs) - 1)].position
                size = hypot(after[0] - before[0], after[1] - before[1])
                x, y = x - aside * (after[1] - before[1]) / size, y + aside * (after[0] - before[0]) / size
            lines.append(f"{down.foot.value},{down.t},{x},{y},STRAIGHT")
        path.write_text("\n".join(lines) + "\n")
        modes = fit_modes([(suit(), path)], None, heading).modes
        return [modes[foot][STRAIGHT] for foot in Foot]

    assert fitted(0.0) == [pytest.approx((0.0, 0.0), abs=1e-6)] * 2
    left, right = fitted(0.02)
    assert left == pytest.approx((0.0, 0.02), abs=4e-3) and right == pytest.approx((0.0, -0.02), abs=4e-3)
    path.write_text("\n".join(path.read_text().splitlines()[:4]) + "\n")
    with pytest.raises(CalibrationError, match="no four marks one after the other"):
        fit_modes([(suit(), path)], None, heading)


# --- a standing pose --------------------------------------------------------------------------------------------------

TILTS = {site: 0.1 * k for k, site in enumerate(SEGMENTS)}


def standing(until: float, moves: Site | None = None) -> list[Sample]:
    """Return samples of sensors that are tilted by TILTS from a quarter turn, at 50 Hz up to `until` s, included."""
    found = []
    for k in range(round(until / 0.02) + 1):
        for site, tilt in TILTS.items():
            turn = 0.5 * pi + tilt + (0.05 * k if site is moves else 0.0)
            acc = (-GRAVITY * sin(turn), 0.0, GRAVITY * cos(turn))
            quat = from_rotation_vector((0.0, turn, 0.0))
            found.append(Sample(0.02 * k, site, acc=acc, gyro=(0.0, 0.0, 0.0), quat=quat))
    return found


def test_who_stands_with_seven_sensors_may_walk_on_however_they_sit() -> None:
    tilts = check_standing(standing(1.5))
    assert tuple(tilts) == SEGMENTS
    assert [*tilts.values()] == pytest.approx(list(TILTS.values()), abs=1e-6)


def test_a_standing_pose_is_half_a_second_of_all_seven_sensors() -> None:
    assert len(check_standing(standing(0.5))) == 7
    with pytest.raises(CalibrationError, match=r"never stood still for 0.5 s with all seven sensors: the pelvis, "):
        check_standing(standing(0.48))
    with pytest.raises(CalibrationError, match="with all seven sensors: the left shank moved last"):
        check_standing(standing(1.5, Site.LEFT_SHANK))
    with pytest.raises(CalibrationError, match="no attitude of the pelvis: all seven sensors are needed"):
        check_standing([sample for sample in standing(1.5) if sample.site is not Site.PELVIS])


def test_lengths_follow_the_stature_unless_they_were_measured() -> None:
    usual = Limbs()
    assert limbs_of(1.75) == usual
    assert limbs_of(1.925, thigh=0.5) == Limbs(
        hip_width=pytest.approx(1.1 * usual.hip_width),  # type: ignore[arg-type]
        thigh=0.5,
        shank=pytest.approx(1.1 * usual.shank),  # type: ignore[arg-type]
        foot=pytest.approx(1.1 * usual.foot),  # type: ignore[arg-type]
        ankle_height=pytest.approx(1.1 * usual.ankle_height),  # type: ignore[arg-type]
    )
    measured = limbs_of(1.75, spines=0.25, shank=0.47)
    assert measured == evolve(usual, hip_width=pytest.approx(0.18), shank=0.47)
