"""`solepath live` on a floor plan, as a program of its own; in real time."""

from __future__ import annotations

import csv
from pathlib import Path

import commands
import pytest
from floors import office
from plan_files import format_floorplan
from programs import emulator, run


@pytest.mark.long
def test_live_prints_the_place_on_the_plan_and_writes_places(tmp_path: Path) -> None:
    plan, out_directory = tmp_path / "office.geojson", tmp_path / "out"
    plan.write_text(format_floorplan(office()))
    with emulator("--distance", 20) as (_, where):
        options = ["--floorplan", plan, "--start", "0,9,6.2,0", "--out", out_directory, "--duration", 12]
        result = run("live", "--via", where, *options)
    assert "place: level 0, (" in result.stdout
    assert "place: found after 1 stride" in result.stdout and "at the end: level 0, (" in result.stdout
    rows = list(csv.DictReader((out_directory / "places.csv").open(encoding="utf-8")))
    assert len(rows) > 3 and {row["level"] for row in rows} == {"0"}


def test_live_rejects_a_start_outside_of_the_plan_before_it_connects(tmp_path: Path) -> None:
    plan = tmp_path / "office.geojson"
    plan.write_text(format_floorplan(office()))
    result = commands.run("live", "--floorplan", plan, "--start", "7,1,1", "--via", "tcp:127.0.0.1:1")
    assert result.returncode == 2 and "the plan has no level '7'" in result.stderr
