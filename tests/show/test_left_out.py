"""A foot whose data cannot be right is left out of every figure, wherever it is shown; the sound foot stands alone."""

from __future__ import annotations

import csv
import json
import re
from collections.abc import Callable, Sequence
from functools import cache
from html import unescape
from pathlib import Path

import pytest
from attrs import evolve
from commands import run
from soak import longer

from solepath import Activity, Defect, DefectFound, Foot, GaitCycleMeasured, Sample, Session, Site, recipes
from solepath.emulate import Route, Walker
from solepath.show.outcomes import walking_bouts
from solepath.show.page.scene.scene import Scene
from solepath.walk.walk import Walk

Change = Callable[[Sample], Sample]
ROUTE = Route().stand(3.0).walk(60.0, 1.3).stop(2.0)


def _acc(change: Callable[[float, float, float], tuple[float, float, float]], after: float = 0.0) -> Change:
    return lambda one: evolve(one, acc=change(*one.acc)) if one.t >= after and one.acc else one


def _gyro(change: Callable[[float, float, float], tuple[float, float, float]]) -> Change:
    return lambda one: evolve(one, gyro=change(*one.gyro)) if one.gyro else one


DAMAGES: dict[str, Change] = {
    "accelerometer too large": _acc(lambda x, y, z: (1.3 * x, 1.3 * y, 1.3 * z)),
    "gravity removed": _acc(lambda x, y, z: (x, y, z - 9.81)),
    "gyroscope dead": _gyro(lambda x, y, z: (0.0, 0.0, 0.0)),
    "gyroscope halved": _gyro(lambda x, y, z: (0.5 * x, 0.5 * y, 0.5 * z)),
    "gyroscope's axes exchanged": _gyro(lambda x, y, z: (y, x, z)),
    "stuck half way": _acc(lambda x, y, z: (0.03, -0.2, 9.8), 25.0),
}


@cache
def _walked(foot: Foot) -> tuple[Sample, ...]:
    return tuple(Walker(ROUTE, seed=3).samples(foot, 100.0))


def _together(left: Change) -> list[Sample]:
    return sorted([*map(left, _walked(Foot.LEFT)), *_walked(Foot.RIGHT)], key=lambda one: one.t)


def _fed(samples: Sequence[Sample]) -> tuple[Walk, Scene, list[DefectFound], list[GaitCycleMeasured]]:
    session, walk, scene = Session(recipes.DEFAULT, poses=True, losses=True), Walk(limit=None), Scene("walk", "default")
    events = []
    for item in [*samples, None]:
        found = session.finish() if item is None else session.feed(item)
        walk.take(item, found)
        scene.take(item, found)
        events += found
    assert session.gait is not None
    assert list(session.gait.feet) == [Foot.RIGHT]
    found_defects = [one for one in events if isinstance(one, DefectFound)]
    return walk, scene, found_defects, [one for one in events if isinstance(one, GaitCycleMeasured)]


def _write(path: Path, samples: Sequence[Sample]) -> Path:
    rows = [",".join(map(repr, [one.t, *(one.acc or ()), *(one.gyro or ())])) for one in samples]
    path.write_text("\n".join(["t,acc_x,acc_y,acc_z,gyro_x,gyro_y,gyro_z", *rows, ""]))
    return path


@pytest.fixture(scope="module")
def alone() -> tuple[float, float, float]:
    """Distance, m, mean stride length, m, and double support of the right foot's walk in sound company."""
    walk = Walk(limit=None)
    session = Session(recipes.DEFAULT, poses=True)
    for item in _walked(Foot.RIGHT):
        walk.take(item, session.feed(item))
    walk.take(None, session.finish())
    gait = walk.gait.of(False)
    assert gait is not None
    assert gait.both.stride_length is not None
    assert gait.both.speed is not None
    return walk.feet[Foot.RIGHT].distance, gait.both.stride_length.mean, gait.both.speed.mean


@pytest.mark.parametrize("damage", DAMAGES)
def test_a_damaged_foot_is_in_no_figure_of_the_walk_nor_of_the_page(
    damage: str, alone: tuple[float, float, float]
) -> None:
    walk, scene, defects, cycles = _fed(_together(DAMAGES[damage]))
    spoiling = [one for one in defects if one.spoilt_foot is Foot.LEFT]
    assert spoiling, [one.defect for one in defects]
    gait, page = walk.gait.of(False), scene.values()
    assert walk.gait.of(True) is None
    assert gait is not None
    assert list(gait.feet) == [Foot.RIGHT]
    assert gait.both.step_time is gait.both.initial_double_support is None
    assert gait.both.stride_length is not None
    assert gait.both.stride_length.mean == pytest.approx(alone[1], rel=0.005)
    assert walk.feet[Foot.LEFT].strides == walk.feet[Foot.LEFT].distance == len(walk.cycles[Foot.LEFT]) == 0
    assert page["total"]["speed"] == pytest.approx(alone[2], abs=0.02)
    assert page["spoilt"] == ["left"]
    assert not walk.turns, "the way is straight"
    known_at = min([one.known_at for one in spoiling])
    late = [one for one in cycles if one.foot is Foot.LEFT and one.known_at >= known_at]
    assert all([one.degraded and not one.steady for one in late])
    assert not [one for one in cycles if one.known_at >= known_at and one.step_time is not None]
    lasting = walk.timeline.durations(walk.now)
    assert lasting[Activity.WALKING] > 40.0
    assert Activity.RUNNING not in lasting


@pytest.mark.parametrize("damage", [*[*DAMAGES][:2], *longer(*[*DAMAGES][2:])])
def test_every_file_of_a_recording_gives_the_sound_foot_alone(
    damage: str, alone: tuple[float, float, float], tmp_path: Path
) -> None:
    left = _write(tmp_path / "left.csv", [*map(DAMAGES[damage], _walked(Foot.LEFT))])
    right = _write(tmp_path / "right.csv", _walked(Foot.RIGHT))
    out, report = tmp_path / "out", tmp_path / "walk.html"
    text = run("track", left, right, "--out", out, "--report", report, "--outcomes").stdout
    html = re.sub(r"<(style|script)[\s\S]*?</\1>", " ", report.read_text())
    words = re.sub(r"\s+", " ", unescape(re.sub(r"<[^>]+>", " ", html)))
    for shown in (text, words):
        assert "those of the right foot alone" in shown
        assert "running, steady" not in shown.lower()
    assert f"Walked {alone[0]:.0f} m" in words
    assert "measured at the right foot alone" in words
    bouts = list(csv.DictReader((out / "bouts.csv").open()))
    assert [float(bout["walking_speed_m_per_s"]) for bout in bouts] == [pytest.approx(alone[2], abs=0.03)]
    assert [int(bout["degraded_strides"]) for bout in bouts] == [0]
    rows = [one for one in csv.DictReader((out / "gait_cycles.csv").open()) if one["foot"] == "left"]
    assert {row["steady"] for row in rows} <= {"0"}
    assert not [row for row in csv.DictReader((out / "gait_cycles.csv").open()) if row["step_time_s"]]
    strides = list(csv.DictReader((out / "strides.csv").open()))
    assert {row["degraded"] for row in strides if row["foot"] == "right"} == {"0"}
    assert {row["degraded"] for row in strides if row["foot"] == "left"} <= {"1"}
    assert all(["defect" in row["flaws"].split() for row in strides if row["foot"] == "left"])
    events = [json.loads(line) for line in (out / "events.jsonl").open()]
    assert [[row["foot"], float(row["t_end_s"])] for row in strides] == [
        [one["foot"], one["t"]] for one in events if one["event"] == "StrideTaken" and one["final"]
    ]
    outcomes = {row["outcome"]: row["value"] for row in csv.DictReader((out / "outcomes.csv").open())}
    assert float(outcomes["steady_speed"]) == pytest.approx(alone[2], abs=0.02)
    assert "foot_left_out" in [one["code"] for one in json.loads((out / "run.json").read_text())["findings"]]


def test_a_walk_of_which_no_foot_can_be_right_has_no_figure(tmp_path: Path) -> None:
    damage = DAMAGES["gravity removed"]
    files = [_write(tmp_path / f"{foot}.csv", [*map(damage, _walked(foot))]) for foot in Foot]
    report = tmp_path / "walk.html"
    text = run("track", *files, "--report", report).stdout
    assert "the data of no foot can be right" in text
    assert "steady strides" not in text
    assert "the data of no foot can be right, so nothing of the walk is counted" in report.read_text()


def test_a_bout_has_the_means_of_its_strides_that_are_right() -> None:
    _, _, (found, *_), cycles = _fed(_together(DAMAGES["gyroscope's axes exchanged"]))
    cycles = [one for one in cycles if one.known_at >= found.known_at]
    right = [one for one in cycles if one.foot is Foot.RIGHT]
    (both,), (one,) = walking_bouts(cycles), walking_bouts(right)
    assert both.walking_speed == pytest.approx(one.walking_speed, rel=1e-9)


def test_clocks_apart_withhold_the_comparison_in_every_row(tmp_path: Path) -> None:
    late = [evolve(one, t=one.t + 0.006 * max(0.0, one.t - 25.0)) for one in _walked(Foot.RIGHT)]
    files = _write(tmp_path / "left.csv", _walked(Foot.LEFT)), _write(tmp_path / "right.csv", late)
    text = run("track", *files, "--out", tmp_path / "out").stdout
    codes = [one["code"] for one in json.loads((tmp_path / "out" / "run.json").read_text())["findings"]]
    assert Defect.CLOCKS.name.lower() in codes, text
    rows = list(csv.DictReader((tmp_path / "out" / "gait_cycles.csv").open()))
    assert len(rows) > 60
    assert {row["step_time_s"] + row["double_support_share"] for row in rows} == {""}
    assert [float(row["t_s"]) for row in rows if row["foot"] == "left"] == sorted(
        [float(row["t_s"]) for row in rows if row["foot"] == "left"]
    )
    assert Site.RIGHT_FOOT.value in [
        one["site"] for one in json.loads((tmp_path / "out" / "run.json").read_text())["findings"]
    ]


def test_the_speed_of_the_outcomes_is_that_of_the_gait_table_and_counts_of_cycles_are_called_so(tmp_path: Path) -> None:
    left = [one for one in _walked(Foot.LEFT) if not 20.0 < one.t < 40.0]  # fewer strides of one foot
    files = _write(tmp_path / "left.csv", left), _write(tmp_path / "right.csv", _walked(Foot.RIGHT))
    text = run("track", *files, "--outcomes").stdout
    (table,) = [line.split() for line in text.splitlines() if line.startswith("speed m/s")]
    (outcome,) = [line.split() for line in text.splitlines() if line.startswith("speed of steady strides")]
    assert table[4] == outcome[5], text
    assert "gait cycles " in text
    assert "\nstrides " not in text.partition("walking, steady strides")[2].partition("stride time")[0]


def test_a_walk_too_short_for_steady_cycles_says_so_in_every_output(tmp_path: Path) -> None:
    short = Walker(Route().stand(2.0).walk(3.0, 1.3).stop(2.0), seed=3).samples(Foot.LEFT, 100.0)
    walk, out, report = _write(tmp_path / "left.csv", short), tmp_path / "out", tmp_path / "walk.html"
    text = run("track", walk, "--out", out, "--report", report).stdout
    found = {one["code"]: one["text"] for one in json.loads((out / "run.json").read_text())["findings"]}
    for shown in (text, run("check", walk).stdout):
        assert found["no_steady_cycle"] in shown
    assert "no gait cycle is steady" in unescape(report.read_text()).lower()
