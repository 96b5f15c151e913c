"""Tests `solepath calibrate shoe --live`: a person in a terminal, and the shoe of emulated insoles in postures."""

import csv
import os
import re
import signal
from math import degrees, radians
from pathlib import Path

import pytest
from programs import TAKES, drawn, emulator, run, started

from solepath.calibration.file import read_calibration
from solepath.emulate.routes.postures import PITCHES, posture

HOLD = 2.5
"""Time for which the emulated shoes are held in each posture, s."""


def test_without_a_terminal_one_line_names_the_terminal_that_it_needs(tmp_path: Path) -> None:
    arguments = ("calibrate", "shoe", tmp_path / "postures.csv", "--live", "--out", tmp_path / "me.json")
    assert run(*arguments, expect=2).stderr == (
        "solepath: calibrate shoe --live asks a person for what the rulers show: it needs a terminal\n"
    )
    assert list(tmp_path.iterdir()) == []


def test_options_of_the_sensor_without_live_are_rejected(tmp_path: Path) -> None:
    arguments = ("calibrate", "shoe", tmp_path / "postures.csv", "--left", "solepath L", "--out", tmp_path / "me.json")
    assert "--left is an option of --live" in run(*arguments, expect=2).stderr


def test_a_person_measures_five_postures_while_the_shoe_s_sensor_gives_the_pitch(tmp_path: Path) -> None:
    pty = pytest.importorskip("pty")
    ours, theirs = pty.openpty()
    table, out = tmp_path / "postures.csv", tmp_path / "me.json"
    options = ["--times", 1, "--height", 0.029, "--left", "solepath L", "--out", out]
    with emulator("--postures", HOLD) as (_, where):
        terminal = dict.fromkeys(("stdin", "stdout", "stderr"), theirs)
        with started("calibrate", "shoe", table, "--live", "--via", where, *options, **terminal) as process:
            os.close(theirs)
            drawn(ours, "left foot: steady")
            os.write(ours, b"\n")
            for number, pitch in enumerate(PITCHES, 1):
                drawn(ours, f"Posture {number} of 5, time 1 of 1")
                shown_until(ours, degrees(pitch))
                os.write(ours, b"\n")
                true = posture(pitch)
                drawn(ours, "L_r in mm")
                if number == 1:  # a slip of the hand is asked for again
                    os.write(ours, b"x77\n")
                    drawn(ours, "no length from 0 to 500 mm")
                os.write(ours, f"{1000.0 * true.sensor_to_ground:.1f}\n".encode())
                drawn(ours, "L_p2t in mm")
                os.write(ours, f"{1000.0 * true.ground_to_tip:.1f}\n".encode())
            assert "5 measurements of 5 postures, flat to 5" in drawn(ours)
            assert process.wait(TAKES) == 0
    os.close(ours)
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


@pytest.mark.parametrize(
    ("end", "status", "words"), [(b"q\n", 2, "no posture was measured"), (b"\x04", 2, "no posture"), (b"\x03", 130, "")]
)
def test_who_ends_before_any_measurement_changes_nothing(tmp_path: Path, end: bytes, status: int, words: str) -> None:
    """Ends are the letter q, the end of the input (Ctrl-D) and Ctrl-C."""
    pty = pytest.importorskip("pty")
    ours, theirs = pty.openpty()
    table, out = tmp_path / "postures.csv", tmp_path / "me.json"
    with emulator("--postures", HOLD) as (_, where):
        terminal = dict.fromkeys(("stdin", "stdout", "stderr"), theirs)
        options = ["--left", "solepath L", "--out", out]
        with started("calibrate", "shoe", table, "--live", "--via", where, *options, **terminal) as process:
            os.close(theirs)
            drawn(ours, "left foot: steady")
            if end == b"\x03":
                process.send_signal(signal.SIGINT)  # this terminal controls no process
            else:
                os.write(ours, end)
            text = drawn(ours)
            assert words in text and "Traceback" not in text
            assert process.wait(TAKES) == status
    os.close(ours)
    assert not table.exists() and not out.exists()


def test_a_measurement_is_taken_back(tmp_path: Path) -> None:
    pty = pytest.importorskip("pty")
    ours, theirs = pty.openpty()
    table, out = tmp_path / "postures.csv", tmp_path / "me.json"
    with emulator("--postures", 60) as (_, where):
        terminal = dict.fromkeys(("stdin", "stdout", "stderr"), theirs)
        options = ["--times", 1, "--left", "solepath L", "--out", out]
        with started("calibrate", "shoe", table, "--live", "--via", where, *options, **terminal) as process:
            os.close(theirs)
            drawn(ours, "left foot: steady")
            for answer, reply in (
                (b"\n", "Posture 1"),
                (b"\n", "L_r in mm"),
                (b"80\n", "L_p2t"),
                (b"70\n", "Posture 2"),
            ):
                os.write(ours, answer)
                drawn(ours, reply)
            assert table.read_text().splitlines()[1].endswith(",0.0800,0.0700")
            for answer, reply in ((b"u\n", "Posture 1"), (b"u\n", "Stand with the shoe flat"), (b"q\n", "no posture")):
                os.write(ours, answer)
                drawn(ours, reply)
            assert process.wait(TAKES) == 2
    os.close(ours)
    assert table.read_text() == "pitch_deg,L_r_m,L_p2t_m\n"
    assert not out.exists()
