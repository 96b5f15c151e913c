"""examples/edge_box.py is killed in mid-walk, again and again, and its files have every stride once."""

from __future__ import annotations

import configparser
import importlib.util
import json
import os
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import pytest
from attrs import evolve
from here import EXAMPLES
from programs import TAKES, emulator
from walks import insoles

from solepath import Session
from solepath.recording import read_packets

PACKETS = insoles().packets
HALF = len(PACKETS) // 2

ADDRESSES = ("F0:5E:00:00:00:01", "F0:5E:00:00:00:02")
RUN = f"""
import asyncio, sys
from pathlib import Path
sys.path.insert(0, {str(EXAMPLES)!r})
import edge_box
edge_box.SAVE_INTERVAL, edge_box.KEEP_RECORDINGS = 3.0, True
asyncio.run(edge_box.main(Path(sys.argv[1]), *sys.argv[2:]))
"""


@contextmanager
def box(folder: Path, via: str, **environment: str) -> Iterator[subprocess.Popen[bytes]]:
    """Run the box; it is killed with SIGKILL at the end of the context."""
    command = [sys.executable, "-c", RUN, str(folder), *ADDRESSES, via]
    process = subprocess.Popen(command, stderr=subprocess.PIPE, env=os.environ | environment)
    try:
        yield process
        assert process.poll() is None, process.communicate()[1].decode()
    finally:
        process.kill()
        process.communicate()


def example() -> Any:
    """Return a fresh module of the example."""
    spec = importlib.util.spec_from_file_location("edge_box", EXAMPLES / "edge_box.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def rows(folder: Path) -> list[dict[str, Any]]:
    """Return the whole rows of all days."""
    return [
        json.loads(line) for path in sorted(folder.glob("rows-*.jsonl")) for line in path.read_text().split("\n")[:-1]
    ]


def strides(folder: Path) -> int:
    return sum(row["event"] == "StrideTaken" for row in rows(folder))


def wait_for_strides(folder: Path, count: int) -> None:
    end = time.monotonic() + TAKES
    while strides(folder) < count:
        assert time.monotonic() < end, "the wearer does not walk"
        time.sleep(0.05)


@pytest.fixture(scope="module")
def walked(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the folder of a box that was killed three times in one walk."""
    folder = tmp_path_factory.mktemp("box")
    with emulator("--duration", "600") as (_, address):
        for kill in range(4):
            with box(folder, address):
                wait_for_strides(folder, strides(folder) + 3 + kill)
    return folder


def undisturbed(folder: Path) -> list[Any]:
    """Return the events of one session, which nobody killed, for the recordings of all starts."""
    session = Session()
    return [
        event
        for path in sorted(folder.glob("packets-*.jsonl"))
        for packet in read_packets(path, report=lambda _: None)
        for event in session.feed(packet)
    ]


def test_after_three_kills_in_mid_walk_the_rows_are_those_of_one_session_that_was_never_killed(walked: Path) -> None:
    found, events = rows(walked), undisturbed(walked)
    assert [row["row"] for row in found] == list(range(1, len(found) + 1)), "none is missing, and none is there twice"
    assert len(events) - len(found) <= 20, "the events of the packet at which it was killed"
    for row, event in zip(found, events, strict=False):
        expected = json.loads(json.dumps(event.to_dict()))
        assert {name: row[name] for name in expected} == expected


def test_each_kill_is_a_gap_of_both_feet_and_the_stride_that_it_falls_in_is_degraded(walked: Path) -> None:
    found = rows(walked)
    for site, foot in (("left_foot", "left"), ("right_foot", "right")):
        starts = [row["t"] for row in found if row["event"] == "Connected" and row["site"] == site]
        assert len(starts) == 4
        gaps = [row["t"] for row in found if row["event"] in ("SampleGap", "ClockReset") and row["site"] == site]
        assert len(gaps) >= 3 and all(
            0.0 < start - max([t for t in gaps if t < start + 0.5]) < 10.0 for start in starts[1:]
        )
        for stride in found:
            if stride["event"] == "StrideTaken" and stride["foot"] == foot:
                has_gap = any(stride["t_start"] < start < stride["t_end"] for start in starts[1:])
                assert stride["degraded"] or not has_gap


def test_the_recordings_before_a_save_are_deleted_and_a_row_that_was_torn_is_cut_off(tmp_path: Path) -> None:
    box_module = example()
    box_module.BOOT = "first"
    box = box_module.Box(tmp_path)
    for packet in PACKETS[:HALF]:
        box.receive(packet)
    assert [path.name for path in tmp_path.glob("packets-*")] == ["packets-00000001.jsonl"]
    box.save()
    for packet in PACKETS[HALF : HALF + 200]:
        box.receive(packet)
    assert [path.name for path in tmp_path.glob("packets-*")] == ["packets-00000002.jsonl"]
    box.writer.close()
    (file,) = tmp_path.glob("rows-*.jsonl")
    before = rows(tmp_path)
    file.write_bytes(file.read_bytes()[:-20])
    again = box_module.Box(tmp_path)
    assert rows(tmp_path) == before and again.number == box.number
    assert again.session.pack() == box.session.pack()


@pytest.mark.parametrize("text", ["", "{", "{}"])
def test_a_damaged_state_and_a_damaged_row_never_keep_the_box_from_starting(tmp_path: Path, text: str) -> None:
    box = example().Box(tmp_path)
    for packet in PACKETS[:HALF]:
        box.receive(packet)
    box.writer.close()
    before = rows(tmp_path)
    (tmp_path / "state.json").write_text(text)
    with next(tmp_path.glob("rows-*.jsonl")).open("ab") as file:
        file.write(b'{"row": \n')
    again = example().Box(tmp_path)
    assert again.number == len(before) and again.session.pack() == box.session.pack()


def test_after_an_update_of_solepath_the_rows_go_on_with_a_new_track(tmp_path: Path) -> None:
    box_module = example()
    box = box_module.Box(tmp_path)
    for packet in PACKETS[:HALF]:
        box.receive(packet)
    box.save()
    box.writer.close()
    before, state = rows(tmp_path), json.loads((tmp_path / "state.json").read_text())
    state["session"]["solepath"] -= 1
    (tmp_path / "state.json").write_text(json.dumps(state))
    again = box_module.Box(tmp_path)
    for packet in PACKETS[HALF:]:
        again.receive(packet)
    found = rows(tmp_path)
    assert found[: len(before)] == before and [row["row"] for row in found] == list(range(1, len(found) + 1))
    assert sum(row["event"] == "StrideTaken" for row in found[len(before) :]) >= 2


def test_after_a_reboot_the_clock_restarts_and_after_a_kill_it_does_not(tmp_path: Path) -> None:
    box_module = example()
    resets = []
    starts = [("first", PACKETS[:400]), ("first", PACKETS[400:HALF]), ("second", ()), ("second", ())]
    for boot, packets in (*starts, ("second", PACKETS[HALF:])):  # twice it ends before a sensor is found
        box_module.BOOT = boot
        box = box_module.Box(tmp_path)
        for packet in packets:
            box.receive(evolve(packet, t=packet.t + 100.0) if boot == "first" else packet)
        box.writer.close()
        resets.append(sum(row["event"] == "ClockReset" for row in rows(tmp_path)))
    assert resets == [0, 0, 0, 0, 2]
    assert not [row for row in rows(tmp_path) if row["event"] == "PacketRejected"]


def test_rows_of_another_day_are_in_another_file(tmp_path: Path) -> None:
    box = example().Box(tmp_path)
    box.started_at, box.t_start = datetime(2026, 11, 21, 23, 59, 55, tzinfo=UTC), PACKETS[0].t
    for packet in PACKETS:
        box.receive(packet)
    box.writer.close()
    first, second = [path.name for path in sorted(tmp_path.glob("rows-*.jsonl"))]
    assert (first, second) == ("rows-2026-11-21.jsonl", "rows-2026-11-22.jsonl")
    times = [row["time"] for row in rows(tmp_path)]
    assert times == sorted(times) and times[0].startswith("2026-11-21T23:59:5")


def test_systemd_starts_it_again_after_every_end_and_gets_signs_of_life(tmp_path: Path) -> None:
    unit = configparser.RawConfigParser(strict=False, interpolation=None)
    unit.optionxform = str  # type: ignore[assignment]
    unit.read(EXAMPLES / "edge_box.service")
    service = unit["Service"]
    assert (service["Restart"], service["Type"]) == ("always", "notify") and float(service["WatchdogSec"]) >= 5.0
    assert service["ExecStart"].split()[1].endswith("/edge_box.py") and len(service["ExecStart"].split()) == 5
    with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as systemd:
        systemd.bind(str(tmp_path / "notify"))
        systemd.settimeout(TAKES)
        with (
            emulator("--duration", "600") as (_, address),
            box(tmp_path / "box", address, NOTIFY_SOCKET=str(tmp_path / "notify")),
        ):
            assert [systemd.recv(100) for _ in range(3)] == [b"READY=1", b"WATCHDOG=1", b"WATCHDOG=1"]
