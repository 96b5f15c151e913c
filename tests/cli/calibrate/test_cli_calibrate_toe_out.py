"""Tests `solepath calibrate toe-out --live`: a person in a terminal, and emulated SensorTags on a straight walk."""

import os
from math import degrees
from pathlib import Path

import pytest
from programs import TAKES, drawn, emulator, in_terminal

from solepath.calibration.file import read_calibration
from solepath.emulate.wearers.gait import Wearer
from solepath.recording import read_packets


@pytest.mark.long
def test_a_person_walks_and_the_strides_and_angles_are_shown(tmp_path: Path) -> None:
    file, out = tmp_path / "walk.jsonl", tmp_path / "me.json"
    with emulator("--device", "cc2541-20hz", "--distance", 14) as (_, where):
        names = ("--left", "F0:5E:00:00:00:01", "--right", "F0:5E:00:00:00:02")
        options = ("--live", "--out", out, "--via", where, *names)
        with in_terminal("calibrate", "toe-out", file, *options) as (terminal, process):
            drawn(terminal, "Stand still")
            drawn(terminal, "strides")
            os.write(terminal, b"\n")
            drawn(terminal, "Walk straight ahead")
            drawn(terminal, " degrees; right 8 strides")
            os.write(terminal, b"\n")
            assert "toe-out degrees" in drawn(terminal)
            assert process.wait(TAKES) == 0
    assert sum(1 for _ in read_packets(file)) > 500
    angles = read_calibration(out).toe_out.values()
    assert angles and all(abs(degrees(angle - Wearer().toe_out)) < 4.0 for angle in angles)
