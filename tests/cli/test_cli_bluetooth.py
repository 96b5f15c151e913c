"""Tests scan, live, record and emulate in processes of their own that speak Bluetooth over TCP, in real time."""

from __future__ import annotations

import json
import re
import signal
from pathlib import Path

import commands
import pytest
from programs import TAKES, emulator, run, started, wait_for

from solepath.recording import read_packets
from solepath.types import Site


@pytest.mark.soak
def test_scan_lists_the_insoles_that_are_there(insoles: str) -> None:
    result = run("scan", "--via", insoles, "--seconds", 1)
    rows = [line.split() for line in result.stdout.splitlines()[2:]]
    assert rows == [
        ["F0:5E:00:00:00:01", "insole", "-50", "solepath", "L"],
        ["F0:5E:00:00:00:02", "insole", "-50", "solepath", "R"],
    ]
    assert result.stderr == ""


def test_live_reports_links_and_what_it_records_gives_the_same_events_again(insoles: str, tmp_path: Path) -> None:
    file, out, replayed = tmp_path / "walk.jsonl", tmp_path / "out", tmp_path / "replayed"
    options = ["--left", "solepath L", "--right", "F0:5E:00:00:00:02", "--via", insoles, "--duration", 8]
    result = run("live", *options, "--record", file, "--out", out)
    assert result.stderr == ""
    for foot in ("left", "right"):  # a busy machine delays a second's last packets
        assert re.search(rf"{foot} foot: (9[5-9]|10\d) Hz, battery 87 %, -50 dBm", result.stdout)
    assert commands.run("track", file, "--out", replayed).returncode == 0
    for name in ("events.jsonl", "track.csv", "strides.csv"):
        assert (replayed / name).read_text() == (out / name).read_text()
    assert (replayed / "strides.csv").read_text().count("\n") > 2
    live, later = [json.loads((folder / "run.json").read_text()) for folder in (out, replayed)]
    assert live["inputs"] == [] and live["options"]["left"] == "solepath L"
    decided = [one["delay_ms"].pop("decision") for one in live["sites"].values()]
    assert all([0.0 <= middle <= most for middle, most in decided])  # a recording knows nothing of the program's clock
    assert (live["sites"], live["recipe_sha256"]) == (later["sites"], later["recipe_sha256"])
    devices = {(packet.site, packet.device) for packet in read_packets(file) if packet.device}
    assert devices == {(Site.LEFT_FOOT, "F0:5E:00:00:00:01"), (Site.RIGHT_FOOT, "F0:5E:00:00:00:02")}


@pytest.mark.soak
def test_record_ends_cleanly_on_a_signal(insoles: str, tmp_path: Path) -> None:
    file = tmp_path / "walk.jsonl"
    with started("record", "--via", insoles, "--left", "solepath L", "--out", file, "--duration", 60) as process:
        wait_for(file, "insole/frame")
        process.send_signal(signal.SIGTERM)
        out, err = process.communicate(timeout=TAKES)
    assert (process.returncode, err) == (0, "")
    assert f"recorded in {file}" in out
    assert list(read_packets(file))[-1].site is Site.LEFT_FOOT


@pytest.mark.soak
def test_sensortags_are_distinguished_by_their_addresses(tmp_path: Path) -> None:
    with emulator("--distance", 5, "--device", "cc2541-20hz") as (_, where):
        unclear = run("record", "--via", where, "--out", tmp_path / "walk.jsonl", "--duration", 5, expect=2)
    assert "say which is where with --left and --right" in unclear.stderr
