"""From the files of five devices, and from those of a lab with a mapping, to a report in one command."""

from __future__ import annotations

import re
from math import hypot
from pathlib import Path

import pytest
from commands import rows_in, run
from exported import LENGTH, VENDORS, strange

from solepath.types import Foot

MAPPING = """
[columns]
t = "Zeit"
acc = ["Beschl X", "Beschl Y", "Beschl Z"]
gyro = ["Gyro X", "Gyro Y", "Gyro Z"]

[units]
t = "ms"
acc = "g"
gyro = "deg/s"
"""


def assert_true_walk(files: list[Path], out: Path, *options: object) -> None:
    """Assert that one command computes the walk, with a report, and that there is nothing to repair."""
    done = run("track", *files, *options, "--out", out, "--report", out / "walk.html")
    assert done.returncode == 0 and done.stderr == ""
    page = (out / "walk.html").read_text()
    assert files[0].name in page and "Stride length" in page
    for foot in Foot:
        last = [row for row in rows_in(out / "strides.csv") if row["foot"] == foot.value][-1]
        assert hypot(float(last["x_m"]), float(last["y_m"])) == pytest.approx(LENGTH, rel=0.03)
    checked = run("check", *files, *options)
    assert checked.returncode == 0 and "nothing must be mended" in checked.stdout
    assert re.search(r"left foot 2\d strides", checked.stdout) and re.search(r"right foot 2\d strides", checked.stdout)


@pytest.mark.parametrize("vendor", VENDORS)
def test_an_export_goes_to_a_report_as_it_is(vendor: str, tmp_path: Path) -> None:
    assert_true_walk(VENDORS[vendor](tmp_path / "files"), tmp_path / "out")


def test_a_table_of_a_lab_goes_to_a_report_with_its_mapping(tmp_path: Path) -> None:
    (tmp_path / "lab.toml").write_text(MAPPING)
    files = [strange(tmp_path / "files", foot) for foot in Foot]
    assert_true_walk(files, tmp_path / "out", "--mapping", tmp_path / "lab.toml")
    report = (tmp_path / "out" / "walk.html").read_bytes()
    options = ("--columns", "t=Zeit,acc=Beschl X,Beschl Y,Beschl Z,gyro=Gyro X,Gyro Y,Gyro Z", "--units", "ms,g,deg/s")
    run("track", *files, *options, "--report", tmp_path / "out" / "walk.html")
    assert (tmp_path / "out" / "walk.html").read_bytes() == report, "options say the same as a file"


def test_the_report_of_files_with_times_since_1970_has_their_date(tmp_path: Path) -> None:
    files = VENDORS["mbientlab"](tmp_path)
    run("track", *files, "--report", tmp_path / "walk.html")
    assert "2026-03-01 08:30 UTC" in (tmp_path / "walk.html").read_text()
