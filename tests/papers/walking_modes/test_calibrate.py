"""`solepath calibrate newton` and `modes`: calibration by a gauge and by marked walks."""

from __future__ import annotations

from functools import cache
from math import cos, sin
from pathlib import Path

import pytest

from solepath.calibration import Calibration, CalibrationError
from solepath.emulate.routes.laps import marked, marks, write_marks
from solepath.emulate.sensors.insoles import layout
from solepath.emulate.sensors.suit import limb_samples
from solepath.emulate.wearers.walker import Walker
from solepath.events import TouchedDown
from solepath.foot.pressure.insole import in_newtons
from solepath.papers.walking_modes.calibrate import (
    ModeMark,
    fit_modes,
    mean_errors,
    read_marks,
    remove_heading_error,
    step_errors,
)
from solepath.papers.walking_modes.newton import fit_gauge
from solepath.recording.decoded import DecodedRecording
from solepath.types import SITE_OF_FOOT, Foot, WalkingMode


def force_of(counts: float) -> float:
    """Return the force on a cell of 14 bits, N: a cubic with 0 N at 0 and 200 N at 16000 counts."""
    u = counts / 16000.0
    return 60.0 * u + 40.0 * u**2 + 100.0 * u**3


def write_gauge(path: Path, counts: list[float], lines: tuple[str, ...] = ()) -> Path:
    rows = [f"{count},{force_of(count)}" for count in counts]
    path.write_text("\n".join(["counts,newtons", *rows, *lines]) + "\n")
    return path


def test_a_cubic_is_found_again_below_5_newtons_is_nothing_and_more_than_200_is_200(tmp_path: Path) -> None:
    found = fit_gauge(write_gauge(tmp_path / "g.csv", [1000.0 * k for k in range(17)]))
    assert found.points == 17 and found.residual < 1e-6 and found.worst < 1e-6
    for count in (2500.0, 9000.0, 15500.0):
        assert in_newtons(found.newtons, (count,))[0] == pytest.approx(force_of(count))
    low, high = in_newtons(found.newtons, (1000.0, 20000.0))
    assert force_of(1000.0) < 5.0 and low == 0.0 and high == 200.0


def test_noise_of_the_gauge_is_its_residual(tmp_path: Path) -> None:
    path = tmp_path / "g.csv"
    rows = [f"{500 * k},{force_of(500 * k) + (0.5 if k % 2 else -0.5)}" for k in range(1, 32)]
    path.write_text("\n".join(["counts,newtons", *rows]))
    assert fit_gauge(path).residual == pytest.approx(0.5, rel=0.1)


@pytest.mark.parametrize(
    ("lines", "message"),
    [
        (("hello,5",), "line 19: counts is 'hello', not a number"),
        (("7,nan",), "line 19: newtons is 'nan', not a finite number"),
        (("7",), "line 19: 1 values, and the header has 2"),
        (("7,250",), "line 19: newtons is 250, which is not between 0 and 200 N"),
    ],
)
def test_a_bad_line_is_named(tmp_path: Path, lines: tuple[str, ...], message: str) -> None:
    path = write_gauge(tmp_path / "g.csv", [1000.0 * k for k in range(17)], lines)
    with pytest.raises(CalibrationError, match=message) as error:
        fit_gauge(path)
    assert str(path) in str(error.value)


def test_a_table_that_is_none_is_rejected(tmp_path: Path) -> None:
    empty, short, falling = (tmp_path / name for name in ("empty.csv", "short.csv", "falling.csv"))
    empty.write_text("")
    with pytest.raises(CalibrationError, match="line 1: needs one column counts"):
        fit_gauge(empty)
    with pytest.raises(CalibrationError, match="4 different counts"):
        fit_gauge(write_gauge(short, [0.0, 1000.0, 2000.0, 3000.0]))
    falling.write_text("counts,newtons\n" + "\n".join(f"{k},{200 - 20 * k}" for k in range(9)))
    with pytest.raises(CalibrationError, match="does not rise"):
        fit_gauge(falling)
    with pytest.raises(CalibrationError, match="No such file"):
        fit_gauge(tmp_path / "nowhere.csv")


def touchdown(foot: Foot, t: float, x: float, y: float) -> TouchedDown:
    return TouchedDown(
        t=t, known_at=t, foot=foot, position=(x, y, 0.0), mode=WalkingMode.STRAIGHT, compensation=(0.0, 0.0, 0.0)
    )


def straight_walk(short: float, turned: float = 0.0) -> tuple[list[ModeMark], list[TouchedDown]]:
    """Return marks and touchdowns of nine steps of 0.6 m, measured `short` m short, in a frame turned by `turned`."""
    found, downs = [], []
    for k in range(9):
        foot, y = (Foot.LEFT, 0.1) if k % 2 == 0 else (Foot.RIGHT, -0.1)
        x = 0.6 * k
        c, s = cos(turned), sin(turned)
        found.append(ModeMark(f"line {k}", foot, c * x - s * y, s * x + c * y, WalkingMode.STRAIGHT, t=float(k)))
        downs.append(touchdown(foot, k + 0.02, (0.6 - short) * k, y))
    return found, downs


@pytest.mark.parametrize("turned", [0.0, 2.0])
def test_steps_that_are_measured_too_short_have_that_error_wherever_the_marks_x_points(turned: float) -> None:
    errors = step_errors(*straight_walk(0.02, turned))
    assert len(errors) == 6
    assert [(error.forward, error.left) for error in errors] == [pytest.approx((0.02, 0.0), abs=1e-9)] * 6


def test_a_foot_that_is_measured_too_far_to_the_left_errs_to_the_right() -> None:
    marked_points, downs = straight_walk(0.0)
    moved = [touchdown(one.foot, one.t, one.position[0], 0.1 if one.foot is Foot.LEFT else -0.09) for one in downs]
    means = mean_errors(step_errors(marked_points, moved, turn=0.0), known_heading=True)
    # marked steps go 0.2 m to the side, measured ones 0.19 m
    assert means[Foot.RIGHT][WalkingMode.STRAIGHT] == pytest.approx((0.0, -0.01), abs=1e-3)
    assert means[Foot.LEFT][WalkingMode.STRAIGHT] == pytest.approx((0.0, 0.01), abs=1e-3)


def test_with_a_known_heading_what_turns_every_step_is_an_error_of_the_wearer() -> None:
    marked_points, downs = straight_walk(0.0, turned=0.05)  # measured 0.05 rad to the right of the marks
    mode = WalkingMode.STRAIGHT
    fitted = mean_errors(step_errors(marked_points, downs))
    known = mean_errors(step_errors(marked_points, downs, turn=0.0), known_heading=True)
    for foot in Foot:
        assert fitted[foot][mode] == pytest.approx((0.0, 0.0), abs=1e-9)
    assert 0.5 * (known[Foot.LEFT][mode][1] + known[Foot.RIGHT][mode][1]) == pytest.approx(0.6 * sin(0.05), rel=0.05)


def test_errors_do_not_accumulate_and_are_separated_by_foot() -> None:
    marked_points, downs = straight_walk(0.0)
    moved = [touchdown(one.foot, one.t, one.position[0] + (0.03 if k >= 5 else 0.0), one.position[1])
             for k, one in enumerate(downs)]  # fmt: skip
    errors = step_errors(marked_points, moved)
    assert sorted(round(error.forward, 6) for error in errors)[:2] == pytest.approx([-0.03, 0.0], abs=0.002)
    means = mean_errors(errors)
    assert means[Foot.RIGHT][WalkingMode.STRAIGHT][0] == pytest.approx(-0.01, abs=0.002)
    assert means[Foot.LEFT][WalkingMode.STRAIGHT][0] == pytest.approx(0.0, abs=0.002)


def test_what_both_feet_are_off_to_one_side_is_a_heading_and_no_compensation() -> None:
    mode = WalkingMode.STRAIGHT
    means = {Foot.LEFT: {mode: (0.01, -0.02)}, Foot.RIGHT: {mode: (0.02, 0.03), WalkingMode.LEFT_WIDE: (0.0, 0.04)}}
    remove_heading_error(means)
    assert means[Foot.LEFT][mode] == pytest.approx((0.01, -0.025))
    assert means[Foot.RIGHT][mode] == pytest.approx((0.02, 0.025))
    assert means[Foot.RIGHT][WalkingMode.LEFT_WIDE] == (0.0, 0.04)


def test_marks_that_belong_to_no_touchdown_are_named() -> None:
    marked_points, downs = straight_walk(0.0)
    with pytest.raises(CalibrationError, match=r"line 7: the right foot did not come down at 7 s"):
        step_errors(marked_points, downs[:7])
    twice = [*marked_points, marked_points[0]]
    with pytest.raises(CalibrationError, match="line 0: the same touchdown as at line 0"):
        step_errors(twice, downs)
    beyond = [ModeMark("line 9", Foot.LEFT, 0.0, 0.0, WalkingMode.STRAIGHT, step=6)]
    with pytest.raises(CalibrationError, match="line 9: the left foot came down 5 times only"):
        step_errors(beyond, downs)


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("middle,1,0,0,STRAIGHT", "line 2: foot is 'middle', not one of left, right"),
        ("left,1,0,0,STANDING", "line 2: mode is 'STANDING', not one of STRAIGHT"),
        ("left,,0,0,STRAIGHT", "line 2: neither t nor step"),
        ("left,1,zero,0,STRAIGHT", "line 2: x is 'zero', not a number"),
    ],
)
def test_a_bad_mark_is_named(tmp_path: Path, line: str, message: str) -> None:
    path = tmp_path / "marks.csv"
    path.write_text(f"foot,t,x,y,mode\n{line}\n")
    with pytest.raises(CalibrationError, match=message):
        read_marks(path)


def test_marks_may_name_the_number_of_the_step(tmp_path: Path) -> None:
    path = tmp_path / "marks.csv"
    path.write_text("foot,step,x,y,mode\nleft,3,1.5,0.1,LEFT_WIDE\n")
    (mark,) = read_marks(path)
    assert (mark.foot, mark.step, mark.t, mark.mode) == (Foot.LEFT, 3, None, WalkingMode.LEFT_WIDE)
    path.write_text("foot,step,x,y,mode\nleft,2.5,1.5,0.1,LEFT_WIDE\n")
    with pytest.raises(CalibrationError, match="step is 2.5"):
        read_marks(path)


@cache
def marked_walk(mode: WalkingMode) -> tuple[DecodedRecording, Walker]:
    walker = Walker(marked(mode, steps=24), seed=103)
    layouts = {SITE_OF_FOOT[foot]: layout(99, foot) for foot in Foot}
    samples = limb_samples(walker, 50.0, seed=103, layouts=layouts)
    return DecodedRecording(tuple(samples), {foot: layout(99, foot) for foot in Foot}), walker


def test_a_marked_walk_teaches_both_feet_some_centimetres(tmp_path: Path) -> None:
    walks = []
    for mode in (WalkingMode.STRAIGHT, WalkingMode.LEFT_TIGHT):
        recording, walker = marked_walk(mode)
        write_marks(tmp_path / f"{mode.name}.csv", marks(walker))
        walks.append((recording, tmp_path / f"{mode.name}.csv"))
    found = fit_modes(walks, Calibration(limbs=walker.wearer.limbs), heading=0.0).modes
    assert found is not None
    for foot in Foot:
        assert set(found[foot]) == {WalkingMode.STRAIGHT, WalkingMode.LEFT_TIGHT}
        assert all(abs(value) < 0.06 for pair in found[foot].values() for value in pair)
