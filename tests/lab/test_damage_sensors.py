"""The table of recordings damaged on purpose: what is damaged, what a session reports of it, and what is left out."""

from __future__ import annotations

from math import radians
from pathlib import Path

import numpy as np
import pytest
from attrs import evolve
from walks import columns_of

from solepath.emulate.routes.route import Route
from solepath.emulate.wearers.walker import Walker
from solepath.events import Defect
from solepath.lab.damage.sensors import KNOWN, DefectOutcome, examine, pieces, remove_gravity, table
from solepath.types import Foot
from solepath.types.vector import GRAVITY

ROUTE = Route().stand(2.0).walk(26.0, 1.3).turn(radians(180), radius=1.0).walk(10.0, 1.3).stop(1.0)
MIRRORED = [f"{sensor} {axis} mirrored" for sensor in ("gyroscope", "accelerometer") for axis in "xyz"]

Columns = dict[str, np.ndarray]


@pytest.fixture(scope="module")
def columns() -> Columns:
    return columns_of(Walker(ROUTE, seed=5), Foot.RIGHT)


def saved(folder: Path, name: str, columns: Columns) -> Path:
    """Write a walk of the right foot into a folder of data sets; return that folder."""
    (folder / name).mkdir()
    np.savez(folder / name / "walk.npz", **columns)
    return folder


def examined(folder: Path) -> DefectOutcome:
    (piece,) = pieces(folder)
    outcome = examine(piece)
    assert outcome is not None and outcome.piece.foot is Foot.RIGHT
    return outcome


@pytest.fixture(scope="module")
def outcome(columns: Columns, tmp_path_factory: pytest.TempPathFactory) -> DefectOutcome:
    return examined(saved(tmp_path_factory.mktemp("data"), "emulated", columns))


def test_a_foot_at_rest_has_no_force_left_without_gravity_however_it_lies() -> None:
    t = np.arange(500) / 100.0
    for up in ((0.0, 0.0, 1.0), (0.6, 0.0, -0.8), (-0.36, 0.48, 0.8)):
        acc = np.tile(GRAVITY * np.array(up), (500, 1))
        assert np.abs(remove_gravity(t, acc, np.zeros((500, 3)))).max() < 1e-9


def test_a_foot_that_is_turned_at_rest_has_no_force_left_either() -> None:
    t = np.arange(600) / 100.0
    rate = np.where((t > 1.0) & (t < 2.0), radians(90.0), 0.0)
    angle = np.cumsum(rate) / 100.0
    acc = GRAVITY * np.stack([np.sin(angle), 0.0 * angle, np.cos(angle)], axis=1)
    gyro = np.stack([0.0 * rate, -rate, 0.0 * rate], axis=1)
    assert np.abs(remove_gravity(t, acc, gyro)).max() < 0.02 * GRAVITY


def test_the_motion_of_a_foot_is_left_without_gravity() -> None:
    t = np.arange(400) / 100.0
    forwards = np.where(t > 1.0, 3.0 * np.sin(4.0 * np.pi * t), 0.0)
    acc = np.stack([forwards, 0.0 * t, np.full(400, GRAVITY)], axis=1)
    removed = remove_gravity(t, acc, np.zeros((400, 3)))
    assert np.abs(removed[:, 0] - forwards).max() < 0.1 * forwards.max()
    assert np.abs(removed[:, 1:]).max() < 0.1


def test_each_stance_of_a_walk_has_little_force_left_without_gravity_and_each_swing_much(columns: Columns) -> None:
    t, acc, gyro = columns["t"], columns["acc"], columns["gyro"]
    removed = np.linalg.norm(remove_gravity(t, acc, gyro), axis=1)
    rate, walks = np.linalg.norm(gyro, axis=1), (t > 5.0) & (t < 20.0)
    stance, swing = walks & (rate < 0.2), walks & (rate > 3.0)
    assert min(stance.sum(), swing.sum()) > 200
    assert np.median(removed[stance]) < 0.1 * GRAVITY < 0.5 * GRAVITY < np.median(removed[swing])


def test_each_damage_of_a_walk_is_reported_and_the_whole_walk_is_silent(outcome: DefectOutcome) -> None:
    assert outcome.whole == ()
    reported = {name: (hit, delay, names) for name, hit, delay, names in outcome.damaged}
    expected = dict.fromkeys(MIRRORED, Defect.AXES) | {
        "specific force in g": Defect.ACC_UNIT,
        "angular rate in deg/s": Defect.GYRO_UNIT,
        "times in ms": Defect.TIME_UNIT,
        "gravity removed": Defect.NO_GRAVITY,
        "clipped at 2 g and 250 deg/s": Defect.CLIPPED,
        "half the rate, both repeated": Defect.REPEATED,
    }
    assert len(expected) == 12
    for name, defect in expected.items():
        hit, delay, names = reported[name]
        assert hit and defect.name in names, name
        assert delay is not None and -3.0 < delay < 20.0, name


def test_a_sensor_that_is_turned_as_a_whole_is_silent(outcome: DefectOutcome) -> None:
    turned = [row for row in outcome.damaged if row[0].startswith("whole sensor turned")]
    assert len(turned) == 2
    for _, hit, delay, names in turned:
        assert hit and delay is None and names == ()


def test_the_table_has_a_line_for_each_damage(outcome: DefectOutcome) -> None:
    first, empty, header, rule, *rows = table([outcome, outcome])
    assert first == "Alarms on 2 undamaged feet, without the known defects: 0.0 %." and empty == ""
    assert header.startswith("| damage | feet | reported |") and set(rule) == {"|", "-"}
    cells = [[cell.strip() for cell in row.strip("|").split("|")] for row in rows]
    assert [row[0] for row in cells] == [row[0] for row in outcome.damaged] and len(rows) > 20
    of_name = {name: row for name, *row in cells}
    assert [of_name[name][:2] for name in MIRRORED] == [["2", "100.0 %"]] * 6
    assert of_name["whole sensor turned, 1"][:2] == ["2", "silent 100.0 %"]
    assert of_name["times in ms"][2] == "0.3 s"


def test_the_table_shows_the_share_of_the_feet_with_a_report(outcome: DefectOutcome) -> None:
    unreported = evolve(outcome, damaged=tuple((name, False, None, ()) for name, *_ in outcome.damaged))
    (row,) = [row for row in table([outcome, unreported]) if row.startswith("| gyroscope x mirrored")]
    assert row.startswith("| gyroscope x mirrored | 2 | 50.0 % |")


@pytest.mark.soak
def test_a_known_defect_of_a_data_set_is_neither_scored_nor_an_alarm(columns: Columns, tmp_path: Path) -> None:
    assert KNOWN["hugadb"] == {Defect.CLIPPED}
    clipped = columns | {"acc": np.clip(columns["acc"], -2.0 * GRAVITY, 2.0 * GRAVITY)}
    known = examined(saved(tmp_path, "hugadb", clipped))
    assert Defect.CLIPPED in {event.defect for event in known.whole}
    assert table([known])[0].endswith("without the known defects: 0.0 %.")
    names = [name for name, *_ in known.damaged]
    assert "clipped at 2 g and 250 deg/s" not in names and len(names) == 20
    assert not [name for name in names if name.startswith("whole sensor turned")], "cut peaks cannot be turned"
    assert all("CLIPPED" not in reported for *_, reported in known.damaged)


def test_a_defect_that_is_not_known_is_an_alarm_with_the_name_of_the_recording(
    columns: Columns, tmp_path: Path
) -> None:
    short = {key: column[columns["t"] < 14.0] for key, column in columns.items()}
    alarming = examined(saved(tmp_path, "other", short | {"acc": 0.5 * short["acc"]}))
    assert alarming.damaged == ()
    first, alarm, *_ = table([alarming])
    assert first == "Alarms on 1 undamaged feet, without the known defects: 100.0 %."
    assert alarm.startswith("- other/walk, right: the accelerometer reads 4.9")


def test_only_feet_with_both_sensors_in_the_chosen_data_sets_are_examined(columns: Columns, tmp_path: Path) -> None:
    for name in ("one", "two"):
        saved(tmp_path, name, columns)
    saved(tmp_path, "without", {key: columns[key] for key in ("t", "acc")})
    (tmp_path / "without" / "broken.npz").write_bytes(b"PK")
    assert [piece.path.parent.name for piece in pieces(tmp_path)] == ["one", "two"]
    assert [piece.path.parent.name for piece in pieces(tmp_path, ["two", "without"])] == ["two"]


def test_a_foot_that_takes_few_strides_is_not_examined(tmp_path: Path) -> None:
    few = columns_of(Walker(Route().stand(2.0).walk(2.5, 1.3).stop(1.0), seed=5), Foot.RIGHT)
    (piece,) = pieces(saved(tmp_path, "emulated", few))
    assert examine(piece) is None
