"""examples/edge_box.py is killed in mid-walk, again and again, and its database has every row once."""

from __future__ import annotations

import importlib.util
import json
import os
import socket
import sqlite3
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest
from attrs import evolve
from here import EXAMPLES
from programs import TAKES, emulator
from walks import insoles

from solepath import Session

PACKETS = insoles(cells=24).packets
HALF = len(PACKETS) // 2

ADDRESSES = ("F0:5E:00:00:00:01", "F0:5E:00:00:00:02")


@contextmanager
def box(database: Path, via: str, **environment: str) -> Iterator[subprocess.Popen[bytes]]:
    """Run the box; it is killed with SIGKILL at the end of the context."""
    command = [sys.executable, EXAMPLES / "edge_box.py", database, *ADDRESSES, via]
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


def rows(database: Path) -> list[tuple[int, str, dict[str, Any]]]:
    """Return number, time and fields of each row."""
    found = sqlite3.connect(database).execute("select row, time, fields from rows order by row")
    return [(number, at, json.loads(fields)) for number, at, fields in found]


def wait_for_strides(database: Path, count: int) -> None:
    end = time.monotonic() + TAKES
    while not database.exists() or strides(database) < count:
        assert time.monotonic() < end, "the wearer does not walk"
        time.sleep(0.1)


def strides(database: Path) -> int:
    try:
        return sum(row["event"] == "StrideTaken" for _, _, row in rows(database))
    except sqlite3.OperationalError:  # no table yet, or it is being written
        return 0


@pytest.mark.long
def test_killed_twice_in_mid_walk_a_box_has_every_row_once_and_gives_systemd_signs_of_life(tmp_path: Path) -> None:
    database, notify = tmp_path / "box.db", tmp_path / "notify"
    with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as systemd, emulator("--duration", "600") as (_, address):
        systemd.bind(str(notify))
        systemd.settimeout(TAKES)
        for kill in range(3):
            with box(database, address, NOTIFY_SOCKET=str(notify)):
                wait_for_strides(database, (strides(database) if kill else 0) + 3 + kill)
        assert [systemd.recv(100) for _ in range(2)] == [b"READY=1\nWATCHDOG=1"] * 2
    found = rows(database)
    assert [number for number, _, _ in found] == list(range(1, len(found) + 1))
    known = [row["known_at"] for _, _, row in found]
    assert known == sorted(known)
    for foot in ("left", "right"):
        taken = [row for _, _, row in found if row["event"] == "StrideTaken" and row["foot"] == foot]
        assert len(taken) >= 4
        assert all([before["t_end"] <= after["t_start"] + 1e-9 for before, after in pairwise(taken)])


def test_rows_of_a_box_that_was_killed_after_a_save_are_those_of_one_session(tmp_path: Path) -> None:
    module, database = example(), tmp_path / "box.db"
    first = module.Box(str(database), 0.0)
    for packet in PACKETS[:HALF]:
        first.receive(packet)
    used = next(k for k in range(HALF, len(PACKETS)) if PACKETS[k].t >= first.save_at)
    for packet in PACKETS[HALF : used + 1]:  # the last one saves
        first.receive(packet)
    assert first.events == []
    again = module.Box(str(database), PACKETS[used].t)
    for packet in PACKETS[used + 1 :]:
        again.receive(packet)
    events = [json.loads(json.dumps(event.to_dict())) for event in Session().feed(PACKETS)]
    unsaved = [json.loads(json.dumps(event.to_dict())) for event in again.events]
    assert [row for _, _, row in rows(database)] + unsaved == events


def test_after_a_reboot_the_clock_restarts_and_after_a_kill_it_does_not(tmp_path: Path) -> None:
    module, database = example(), tmp_path / "box.db"
    resets = []
    starts = [("first", PACKETS[:400]), ("first", PACKETS[400:HALF]), ("second", ()), ("second", PACKETS[HALF:])]
    for boot, packets in starts:
        module.BOOT = boot
        later = 100.0 if boot == "first" else 0.0
        box = module.Box(str(database), later)
        for packet in packets:
            box.receive(evolve(packet, t=packet.t + later))
        resets.append(sum(row["event"] == "ClockReset" for _, _, row in rows(database)))
    assert resets == [0, 0, 0, 2]
    assert not [row for _, _, row in rows(database) if row["event"] == "PacketRejected"]
