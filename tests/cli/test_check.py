"""Tests `solepath check`: its verdict on whole and on damaged recordings, and its exit status."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from commands import run
from walks import columns_of

from solepath.emulate.routes.route import Route
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
    assert done.returncode == 0 and "nothing needs fixing" in done.stdout
    assert "does not say of which foot it is" in done.stdout and "degraded" not in done.stdout
    named = run("check", saved(tmp_path, columns), "--foot", "left")
    assert "left foot 2" in named.stdout and "of which foot" not in named.stdout


def test_a_mirrored_axis_is_named_and_the_status_is_1(columns: dict[str, np.ndarray], tmp_path: Path) -> None:
    mirrored = columns["gyro"] * np.array([1.0, -1.0, 1.0])
    done = run("check", saved(tmp_path, columns, gyro=mirrored))
    assert done.returncode == 1
    assert done.stdout.splitlines()[1] == "needs fixing:" and "the axes of the gyroscope" in done.stdout


def test_values_in_other_units_get_the_readers_sentence_and_no_summary_of_a_walk(
    columns: dict[str, np.ndarray], tmp_path: Path
) -> None:
    done = run("check", saved(tmp_path, columns, gyro=np.degrees(columns["gyro"])))
    assert done.returncode == 1 and done.stderr == ""
    title, heading, sentence, end = done.stdout.splitlines()
    assert (title, heading) == ("walk.npz: its values cannot be used", "needs fixing:")
    assert sentence.startswith("  gyro: ") and "deg/s" in sentence and "stride" not in done.stdout
    assert end == "nothing else was checked: fix this first"


def test_values_that_can_be_read_but_not_be_right_are_named_too(columns: dict[str, np.ndarray], tmp_path: Path) -> None:
    done = run("check", saved(tmp_path, columns, acc=0.5 * columns["acc"]), "--foot", "left")
    assert done.returncode == 1
    assert "\n  left foot: the accelerometer reads 4.9" in done.stdout
    assert "the sensor's range is 2 times the range that is assumed" in done.stdout


def test_degraded_strides_are_counted_and_explained_by_the_gaps_in_them(
    columns: dict[str, np.ndarray], tmp_path: Path
) -> None:
    for lost, words in ((1, None), (9, "degraded: a gap of more than 60 ms and two samples in")):
        kept = (np.arange(len(columns["t"])) - 30) % 60 >= lost
        done = run("check", saved(tmp_path, {key: column[kept] for key, column in columns.items()}), "--foot", "left")
        found = re.search(r"left foot: (\d+) of (\d+) strides (degraded: .* in) (\d+)", done.stdout)
        assert done.returncode == 0 and (found is None) is (words is None), "one lost sample is no flaw"
        if found is not None:
            assert int(found[1]) == int(found[4]) > 0.5 * int(found[2]) > 7 and found[3] == words


def test_a_row_that_cannot_be_read_is_named_and_the_others_are_checked(
    columns: dict[str, np.ndarray], tmp_path: Path
) -> None:
    acc = columns["acc"].copy()
    acc[2000] = np.nan
    done = run("check", saved(tmp_path, columns, acc=acc), "--foot", "left")
    assert done.returncode == 0 and done.stderr == ""
    assert re.search(r"^walk.npz: 2\d.\d s, left foot 2\d strides$", done.stdout, re.MULTILINE)
    assert "\n  acc, row 2000: is nan, not a finite number (t = 20 s); this row is left out\n" in done.stdout
