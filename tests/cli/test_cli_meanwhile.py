"""What another program writes while a command runs is not replaced: recordings, and what another `calibrate` learnt."""

from __future__ import annotations

import os
from pathlib import Path
from time import monotonic, sleep

import pytest
from commands import run, run_failing
from programs import TAKES, started
from recordings import PACKETS, recorded, written
from soak import soaked

from solepath.calibration.file import read_calibration
from solepath.recording import PacketWriter, read_packets
from solepath.types import Foot

GAUGE = "counts,newtons\n" + "".join(f"{counts},{0.1 * counts:.1f}\n" for counts in (60, 100, 400, 800, 1200, 1900))


@pytest.mark.parametrize("replaced", [False, *soaked(True)])
def test_a_recording_that_waits_for_its_first_packet_is_not_replaced(
    recording: Path, tmp_path: Path, replaced: bool
) -> None:
    path = tmp_path / "walk.mcap"
    if replaced:
        recorded(path, PACKETS[:1])
    with PacketWriter(path, replace=replaced) as writer:
        commands: list[list[object]] = [["track", recording, "--report", path]]
        if replaced:
            pytest.importorskip("mcap", reason="the extra mcap is not installed")
            commands.append(["convert", recording, path])
        for command in commands:
            for force in ((), ("--force",)):
                assert run_failing(*command, *force) == f"solepath: {path}: another program is recording into it\n"
        writer.write(PACKETS[2])
    assert list(read_packets(path)) == PACKETS[2:]


@pytest.mark.parametrize(
    ("force", "is_complete"), [((), True), pytest.param(("--force",), False, marks=pytest.mark.soak)]
)
def test_a_recording_that_is_made_during_a_run_is_not_replaced_at_its_end(
    recording: Path, tmp_path: Path, force: tuple[str, ...], is_complete: bool
) -> None:
    pipe, report = tmp_path / "pipe", tmp_path / "r.html"
    os.mkfifo(pipe)
    with started("track", pipe, "--report", report, *force) as process:
        with pipe.open("wb") as source:
            source.write(recording.read_bytes())
            source.flush()
            end = monotonic() + TAKES
            while not list(tmp_path.glob(".solepath-*")):
                assert monotonic() < end, "no temporary file came"
                sleep(0.01)
            writer = PacketWriter(report)
            writer.write(PACKETS[0])
            if is_complete:
                writer.close()
        _, err = process.communicate(timeout=TAKES)
    writer.close()
    why = (
        "another program wrote it meanwhile, so that it stays"
        if is_complete
        else "another program is recording into it"
    )
    assert (process.returncode, err) == (2, f"solepath: {report}: {why}\n")
    assert list(read_packets(report)) == PACKETS[:1] and set(written(tmp_path)) == {"r.html"}


def test_two_calibrations_at_once_keep_what_both_learn(tmp_path: Path) -> None:
    pipe, gauge, out = tmp_path / "pipe", tmp_path / "gauge.csv", tmp_path / "me.json"
    gauge.write_text(GAUGE)
    os.mkfifo(pipe)
    with started("calibrate", "newton", pipe, "--foot", "left", "--out", out) as process:
        with pipe.open("w") as source:  # the command has read the calibration, and waits for the table
            assert run("calibrate", "newton", gauge, "--foot", "right", "--out", out).returncode == 0
            source.write(GAUGE)
        _, err = process.communicate(timeout=TAKES)
    assert (process.returncode, err) == (0, "")
    assert set(read_calibration(out).insoles) == set(Foot)
