"""Tests scan, live, record and emulate in processes of their own that speak Bluetooth over TCP, in real time."""

from __future__ import annotations

import re
import signal
import time
from pathlib import Path

from programs import TAKES, emulator, run, started, wait_for
from walks import run_session

from solepath import Connected, Disconnected, StrideTaken
from solepath.recording import read_packets
from solepath.types import Site


def test_scan_lists_the_insoles_that_are_there(insoles: str) -> None:
    result = run("scan", "--via", insoles, "--seconds", 1)
    rows = [line.split() for line in result.stdout.splitlines()[2:]]
    assert rows == [
        ["F0:5E:00:00:00:01", "insole", "-50", "solepath", "L"],
        ["F0:5E:00:00:00:02", "insole", "-50", "solepath", "R"],
    ]
    assert result.stderr == ""


def test_live_connects_to_the_insoles_it_finds_and_reports_their_links(insoles: str) -> None:
    result = run("live", "--via", insoles, "--duration", 12)  # some seconds of reports, of which one has to fit
    for foot in ("left", "right"):  # a busy machine delays a second's last packets
        assert re.search(rf"{foot} foot: (9[5-9]|10\d) Hz, 0.0 % lost, battery 87 %, -50 dBm", result.stdout)
    assert result.stderr == ""


def test_what_record_writes_gives_the_same_events_as_live(insoles: str, tmp_path: Path) -> None:
    file, out = tmp_path / "walk.jsonl", tmp_path / "out"
    options = ["--left", "solepath L", "--right", "F0:5E:00:00:00:02", "--via", insoles, "--duration", 12]
    run("live", *options, "--record", file, "--out", out)
    replayed = tmp_path / "replayed"
    run("track", file, "--out", replayed)
    for name in ("events.jsonl", "track.csv", "strides.csv"):
        assert (replayed / name).read_text() == (out / name).read_text()
    assert (replayed / "strides.csv").read_text().count("\n") > 2
    devices = {(packet.site, packet.device) for packet in read_packets(file) if packet.device}
    assert devices == {(Site.LEFT_FOOT, "F0:5E:00:00:00:01"), (Site.RIGHT_FOOT, "F0:5E:00:00:00:02")}


def test_record_ends_cleanly_on_a_signal(insoles: str, tmp_path: Path) -> None:
    file = tmp_path / "walk.jsonl"
    with started("record", "--via", insoles, "--left", "solepath L", "--out", file, "--duration", 60) as process:
        wait_for(file, "insole/frame")
        process.send_signal(signal.SIGTERM)
        out, err = process.communicate(timeout=TAKES)
    assert (process.returncode, err) == (0, "")
    assert f"recorded in {file}" in out
    assert list(read_packets(file))[-1].site is Site.LEFT_FOOT


def test_emulate_ends_cleanly_on_a_signal() -> None:
    with emulator("--distance", 5) as (process, _):
        process.send_signal(signal.SIGINT)
        _, err = process.communicate(timeout=TAKES)
        assert (process.returncode, err) == (0, "")


def test_an_emulator_that_is_killed_is_a_lost_link_and_is_found_again_when_it_is_back(tmp_path: Path) -> None:
    file = tmp_path / "walk.jsonl"
    with emulator("--distance", 5) as (process, where):
        port = int(where.rpartition(":")[2])
        with started("record", "--via", where, "--left", "solepath L", "--out", file, "--duration", 60) as recorder:
            wait_for(file, "insole/frame")
            process.kill()
            wait_for(file, "receiver/disconnected")
            with emulator("--distance", 5, port=port):
                wait_for(file, "receiver/connected", times=2)
                time.sleep(1.0)
                recorder.send_signal(signal.SIGINT)
                recorder.communicate(timeout=TAKES)
    assert recorder.returncode == 0
    events = run_session(read_packets(file))
    links = [type(event) for event in events if isinstance(event, Connected | Disconnected)]
    assert links[:3] == [Connected, Disconnected, Connected]


def test_sensortags_are_distinguished_by_their_addresses(tmp_path: Path) -> None:
    file = tmp_path / "walk.jsonl"
    with emulator("--distance", 5, "--device", "cc2541-20hz") as (_, where):
        unclear = run("record", "--via", where, "--out", file, "--duration", 5, expect=2)
        assert "say which is where with --left and --right" in unclear.stderr
        sides = ["--left", "F0:5E:00:00:00:01", "--right", "F0:5E:00:00:00:02"]
        profile = ["--profile", "cc2541-20hz"]
        run("record", "--via", where, *sides, *profile, "--out", file, "--duration", 9)
    steps = [event for event in run_session(read_packets(file)) if isinstance(event, StrideTaken)]
    assert {event.foot.value for event in steps} == {"left", "right"}


def test_faults_come_from_a_script(tmp_path: Path) -> None:
    script, file = tmp_path / "faults.txt", tmp_path / "walk.jsonl"
    script.write_text("1.0 left_foot disconnect\n2.0 left_foot drop 3\n")
    with emulator("--distance", 5, "--faults", script) as (_, where):
        run("record", "--via", where, "--left", "solepath L", "--out", file, "--duration", 5)
    names = [type(event).__name__ for event in run_session(read_packets(file))]
    assert [name for name in names if "onnected" in name][:3] == ["Connected", "Disconnected", "Connected"]
    assert "PacketsLost" in names
