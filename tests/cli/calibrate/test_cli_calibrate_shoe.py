"""Tests `solepath calibrate shoe --live`: a person in a terminal, and the shoe of emulated insoles in postures."""

import csv
import os
import re
import signal
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from math import degrees, radians
from pathlib import Path

import commands
import pytest
from programs import TAKES, drawn, emulator, in_terminal

from solepath.calibration.file import read_calibration
from solepath.emulate.routes.postures import PITCHES
from solepath_lab.emulated.postures import posture

HOLD = 2.5
"""Time for which the emulated shoes are held in each posture, s."""


@contextmanager
def measuring(folder: Path, hold: float, *options: object) -> Iterator[tuple[int, subprocess.Popen[str], str]]:
    """Yield a terminal, the program in it, and what it printed; it shows the pitch of a left shoe and makes two files.

    The files are postures.csv and me.json in `folder`. The emulated shoe is held for `hold` s in each posture."""
    files = ("calibrate", "shoe", folder / "postures.csv", "--live", "--out", folder / "me.json")
    with (
        emulator("--postures", hold) as (_, where),
        in_terminal(*files, "--via", where, "--left", "solepath L", *options) as (terminal, process),
    ):
        yield terminal, process, drawn(terminal, "left foot: steady")


def test_without_a_terminal_one_line_names_the_terminal_that_it_needs(tmp_path: Path) -> None:
    arguments = ("calibrate", "shoe", tmp_path / "postures.csv", "--live", "--out", tmp_path / "me.json")
    assert commands.run(*arguments).stderr == (
        "solepath: calibrate shoe --live asks a person for what the rulers show: it needs a terminal\n"
    )
    assert list(tmp_path.iterdir()) == []


def test_options_of_the_sensor_without_live_are_rejected(tmp_path: Path) -> None:
    arguments = ("calibrate", "shoe", tmp_path / "postures.csv", "--left", "solepath L", "--out", tmp_path / "me.json")
    assert "--left is an option of --live" in commands.run(*arguments).stderr


@pytest.mark.long
def test_a_person_measures_five_postures_while_the_shoe_s_sensor_gives_the_pitch(tmp_path: Path) -> None:
    table, out = tmp_path / "postures.csv", tmp_path / "me.json"
    with measuring(tmp_path, HOLD, "--times", 1, "--height", 0.029) as (terminal, process, _):
        os.write(terminal, b"\n")
        for number, pitch in enumerate(PITCHES, 1):
            drawn(terminal, f"Posture {number} of 5, time 1 of 1")
            shown_until(terminal, degrees(pitch))
            os.write(terminal, b"\n")
            true = posture(pitch)
            drawn(terminal, "L_r in mm")
            if number == 1:  # a slip of the hand is asked for again
                os.write(terminal, b"x77\n")
                drawn(terminal, "no length from 0 to 500 mm")
            os.write(terminal, f"{1000.0 * true.sensor_to_ground:.1f}\n".encode())
            drawn(terminal, "L_p2t in mm")
            os.write(terminal, f"{1000.0 * true.ground_to_tip:.1f}\n".encode())
        assert "5 measurements of 5 postures, flat to 5" in drawn(terminal)
        assert process.wait(TAKES) == 0
    with table.open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert [row["H_imu_m"] for row in rows] == ["0.0290"] * 5
    assert [float(row["pitch_deg"]) for row in rows] == pytest.approx([degrees(pitch) for pitch in PITCHES], abs=1.5)
    shoe = read_calibration(out).shoe
    assert shoe is not None and shoe.height == 0.029
    for pitch in (radians(15.0), radians(50.0)):
        length = sum(factor * pitch**k for k, factor in enumerate(shoe.forefoot_radius))
        assert length == pytest.approx(posture(pitch).sensor_to_ground, abs=0.002)


def shown_until(terminal: int, pitch: float) -> None:
    """Wait until the pitch that is shown is steady and within 1.5 degrees of `pitch`, in degrees."""
    text = ""
    while not any(abs(float(shown) - pitch) < 1.5 for shown in re.findall(r"pitch +([\d.]+) degrees, steady", text)):
        part = drawn(terminal, " degrees, steady")
        assert part, "the program has ended"
        text = part


@pytest.mark.long
@pytest.mark.parametrize(("end", "status", "words"), [(b"\x04", 2, "no posture was measured"), (b"\x03", 130, "")])
def test_who_ends_before_any_measurement_changes_nothing(tmp_path: Path, end: bytes, status: int, words: str) -> None:
    """Ends are the end of the input (Ctrl-D) and Ctrl-C; the letter q ends a later test."""
    with measuring(tmp_path, HOLD) as (terminal, process, _):
        if end == b"\x03":
            process.send_signal(signal.SIGINT)  # this terminal controls no process
        else:
            os.write(terminal, end)
        text = drawn(terminal)
        assert words in text and "Traceback" not in text
        assert process.wait(TAKES) == status
    assert list(tmp_path.iterdir()) == []
