"""Tests `solepath check`: its verdict on whole and on damaged recordings, and its exit status."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from commands import run, run_failing
from recordings import recorded
from walks import columns_of

from solepath.emulate.routes.route import Route
from solepath.emulate.walk import emulate
from solepath.emulate.wearers.walker import Walker
from solepath.types import Foot

ROUTE = Route().stand(2.0).walk(30.0, speed=1.3).stop(1.5)


@pytest.fixture(scope="module")
def columns() -> dict[str, np.ndarray]:
    return columns_of(Walker(ROUTE, seed=3), Foot.LEFT)


def saved(folder: Path, columns: dict[str, np.ndarray], **changed: np.ndarray) -> Path:
    np.savez(folder / "walk.npz", **(columns | changed))
    return folder / "walk.npz"


def test_a_whole_recording_has_no_fault(columns: dict[str, np.ndarray], tmp_path: Path) -> None:
    done = run("check", saved(tmp_path, columns))
    assert done.returncode == 0 and "nothing must be mended" in done.stdout
    assert "does not say of which foot it is" in done.stdout and "no check sees:" in done.stdout
    named = run("check", saved(tmp_path, columns), "--foot", "left")
    assert "left foot 2" in named.stdout and "of which foot" not in named.stdout


def test_a_mirrored_axis_is_named_and_the_status_is_1(columns: dict[str, np.ndarray], tmp_path: Path) -> None:
    mirrored = columns["gyro"] * np.array([1.0, -1.0, 1.0])
    done = run("check", saved(tmp_path, columns, gyro=mirrored))
    assert done.returncode == 1
    assert done.stdout.splitlines()[1] == "must be mended:" and "the axes of the gyroscope" in done.stdout


def test_a_file_in_other_units_is_named(columns: dict[str, np.ndarray], tmp_path: Path) -> None:
    done = run("check", saved(tmp_path, columns, gyro=np.degrees(columns["gyro"])))
    assert done.returncode == 1 and "deg/s" in done.stdout


def test_a_recording_of_packets_is_checked_too(tmp_path: Path) -> None:
    walk = emulate(Route().stand(2.0).walk(4.0).stop(1.0), seed=3)
    done = run("check", recorded(tmp_path / "walk.jsonl", walk.packets))
    assert done.returncode == 0 and "too little walking" in done.stdout


def test_a_file_that_is_not_there_is_an_error_and_no_verdict(tmp_path: Path) -> None:
    assert "none.npz" in run_failing("check", tmp_path / "none.npz")


def test_an_option_may_be_given_once(columns: dict[str, np.ndarray], tmp_path: Path) -> None:
    done = run("check", saved(tmp_path, columns), "--recipe", "zupt", "--recipe", "kupt")
    assert done.returncode == 2 and "--recipe was given twice" in done.stderr


def test_a_lone_file_of_the_left_foot_is_taken_as_such(columns: dict[str, np.ndarray], tmp_path: Path) -> None:
    np.savez(tmp_path / "Left_shoe.npz", **columns)
    done = run("track", tmp_path / "Left_shoe.npz")
    assert done.returncode == 0 and "taken as the left one" in done.stderr and "left " in done.stdout
