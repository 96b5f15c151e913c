"""`solepath calibrate sensor`: rests and turns become a calibration, or a sentence on what is missing."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from commands import run
from quoted import below, nearly_the_same
from recordings import recorded

from solepath import Calibration, Foot, Packet, Site
from solepath.calibration import HeadingCalibration
from solepath.calibration.file import read_calibration, write_calibration
from solepath.emulate.radio import Radio
from solepath.emulate.sensors.device import device_rng
from solepath.emulate.sensors.insole_device import Insole
from solepath.emulate.sensors.parts import MPU9250
from solepath_lab.command import main as lab
from solepath_lab.emulated.by_hand import specimen, true_corrections
from solepath_lab.emulated.handling import Handling

IMU = specimen(MPU9250, 81)


def packets(hand: Handling, site: Site) -> tuple[Packet, ...]:
    """Return the packets of an insole in a hand, over a radio that loses some."""
    sent = Insole(cells=8, chip=IMU).emit(hand, site, device_rng(81, site))
    radio = Radio(loss=0.002, jitter=0.02)
    return tuple(radio.transmit(sent, site, np.random.default_rng(81)))


@pytest.mark.soak
def test_a_recording_of_packets_becomes_a_calibration_that_track_takes(tmp_path: Path) -> None:
    file, out = recorded(tmp_path / "turns.jsonl", packets(Handling(81), Site.LEFT_FOOT)), tmp_path / "me.json"
    write_calibration(out, Calibration(headings={Foot.LEFT: HeadingCalibration(0.001, 0.0, 1e-3, 1e-3)}))
    result = run("calibrate", "sensor", file, "--out", out)
    assert result.returncode == 0 and result.stderr == ""
    assert "left foot: " in result.stdout and "rests, 5 + 5 turns in " in result.stdout
    assert "left: heading or drift were learnt without this correction and are removed" in result.stdout
    learnt = read_calibration(out)
    assert list(learnt.sensors) == [Foot.LEFT] and not learnt.headings
    _, gyro = true_corrections(IMU)
    assert np.abs(np.array(learnt.sensors[Foot.LEFT].gyro.matrix).reshape(3, 3) - gyro).max() < 0.0035  # 0.2 degrees
    assert run("track", file, "--calibration", out).returncode == 0


@pytest.mark.soak
def test_the_example_of_the_page_is_what_the_command_prints(tmp_path: Path) -> None:
    lab(["emulated", "by-hand", "--record", str(tmp_path / "turns.jsonl"), "--seed", "7"])
    printed = run("calibrate", "sensor", tmp_path / "turns.jsonl", "--out", tmp_path / "me.json").stdout
    shown = printed.replace(str(tmp_path / "me.json"), "me.json")
    nearly_the_same(below("calibrate-sensor"), shown.splitlines())
