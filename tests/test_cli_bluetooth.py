"""scan, live, record and emulate, as programs of their own that speak Bluetooth over TCP; in real time."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from solepath import Connected, Disconnected, Session, StepTaken
from solepath.recording import read_packets
from solepath.types import Packet, Site

SOLEPATH = [sys.executable, "-m", "solepath"]
TAKES = 30.0
"""s that a program may take to say or do something before the test gives up."""


@contextmanager
def started(*arguments: object) -> Iterator[subprocess.Popen[str]]:
    """A command that runs until the test is through with it."""
    command = [*SOLEPATH, *map(str, arguments)]
    process = subprocess.Popen(
        command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    try:
        yield process
    finally:
        process.kill()
        process.communicate()


@contextmanager
def emulator(*arguments: object, port: int = 0) -> Iterator[tuple[subprocess.Popen[str], str]]:
    """Emulated devices, and where they are: tcp:HOST:PORT."""
    with started("emulate", "--listen", f"127.0.0.1:{port}", *arguments) as process:
        assert process.stdout is not None
        said, where = process.stdout.readline().rsplit(maxsplit=1)
        assert said == "serving at"
        yield process, where


def run(*arguments: object, expect: int = 0) -> subprocess.CompletedProcess[str]:
    command = [*SOLEPATH, *map(str, arguments)]
    done = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode == expect, done.stderr
    return done


def wait_for(path: Path, what: str) -> None:
    """Until `what` stands in the file."""
    end = time.monotonic() + TAKES
    while not path.exists() or what not in path.read_text(encoding="utf-8"):
        assert time.monotonic() < end, f"{what} did not come"
        time.sleep(0.05)


@pytest.fixture(scope="module")
def insoles() -> Iterator[str]:
    with emulator("--distance", 20) as (_, where):
        yield where


def test_scan_lists_the_insoles_that_are_there(insoles: str) -> None:
    done = run("scan", "--via", insoles, "--seconds", 1)
    rows = [line.split() for line in done.stdout.splitlines()[2:]]
    assert rows == [
        ["F0:5E:00:00:00:01", "insole", "-50", "solepath", "L"],
        ["F0:5E:00:00:00:02", "insole", "-50", "solepath", "R"],
    ]
    assert done.stderr == ""


def test_live_takes_the_insoles_that_it_hears_and_tells_how_the_links_do(insoles: str) -> None:
    done = run("live", "--via", insoles, "--duration", 7)
    assert "left foot: 100 Hz, 0.0 % lost, battery 87 %, -50 dBm" in done.stdout
    assert "right foot: 100 Hz, 0.0 % lost, battery 87 %, -50 dBm" in done.stdout
    assert done.stderr == ""


def test_what_record_writes_is_replayed_as_it_was_heard_live(insoles: str, tmp_path: Path) -> None:
    file, out = tmp_path / "walk.jsonl", tmp_path / "out"
    options = ["--left", "solepath L", "--right", "F0:5E:00:00:00:02", "--via", insoles, "--duration", 7]
    run("live", *options, "--record", file, "--out", out)
    replayed = tmp_path / "replayed"
    run("track", file, "--out", replayed)
    for name in ("events.jsonl", "track.csv", "steps.csv"):
        assert (replayed / name).read_text() == (out / name).read_text()
    assert (replayed / "steps.csv").read_text().count("\n") > 2
    devices = {(packet.site, packet.device) for packet in read_packets(file) if packet.device}
    assert devices == {(Site.LEFT_FOOT, "F0:5E:00:00:00:01"), (Site.RIGHT_FOOT, "F0:5E:00:00:00:02")}


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM], ids=["ctrl-c", "sigterm"])
def test_record_ends_cleanly_when_it_is_told_to(insoles: str, tmp_path: Path, number: int) -> None:
    file = tmp_path / "walk.jsonl"
    with started("record", "--via", insoles, "--left", "solepath L", "--out", file, "--duration", 60) as process:
        wait_for(file, "insole/frame")
        process.send_signal(number)
        out, err = process.communicate(timeout=TAKES)
    assert (process.returncode, err) == (0, "")
    assert f"recorded in {file}" in out
    assert list(read_packets(file))[-1].site is Site.LEFT_FOOT


def test_emulate_ends_cleanly_when_it_is_told_to() -> None:
    with emulator("--distance", 5) as (process, _):
        process.send_signal(signal.SIGINT)
        _, err = process.communicate(timeout=TAKES)
        assert (process.returncode, err) == (0, "")


def test_all_but_the_last_200_ms_can_be_read_after_kill_9(insoles: str, tmp_path: Path) -> None:
    file = tmp_path / "walk.jsonl"
    with started("record", "--via", insoles, "--left", "solepath L", "--out", file, "--duration", 60) as process:
        wait_for(file, "insole/frame")
        time.sleep(1.0)
        process.kill()
        killed = time.monotonic()
        process.wait()
    packets = list(read_packets(file, report=lambda flaw: None))
    frames = [packet for packet in packets if packet.channel == "insole/frame"]
    assert len(frames) > 50
    assert killed - frames[-1].t < 0.2
    assert max(b.t - a.t for a, b in zip(frames, frames[1:], strict=False)) < 0.2


def events_of(packets: list[Packet]) -> list[object]:
    session = Session()
    return [*session.feed(packets), *session.finish()]


def test_an_emulator_that_is_killed_is_a_lost_link_and_is_found_again_when_it_is_back(tmp_path: Path) -> None:
    file = tmp_path / "walk.jsonl"
    with emulator("--distance", 5) as (process, where):
        port = int(where.rpartition(":")[2])
        with started("record", "--via", where, "--left", "solepath L", "--out", file, "--duration", 60) as recorder:
            wait_for(file, "insole/frame")
            process.kill()
            wait_for(file, "receiver/disconnected")
            with emulator("--distance", 5, port=port):
                end = time.monotonic() + TAKES
                while file.read_text().count("receiver/connected") < 2:
                    assert time.monotonic() < end, "it was not found again"
                    time.sleep(0.05)
                time.sleep(1.0)
                recorder.send_signal(signal.SIGINT)
                recorder.communicate(timeout=TAKES)
    assert recorder.returncode == 0
    events = events_of(list(read_packets(file)))
    links = [type(event) for event in events if isinstance(event, Connected | Disconnected)]
    assert links[:3] == [Connected, Disconnected, Connected]


def test_sensortags_are_told_apart_by_their_addresses(tmp_path: Path) -> None:
    file = tmp_path / "walk.jsonl"
    with emulator("--distance", 5, "--device", "cc2541-20hz") as (_, where):
        unclear = run("record", "--via", where, "--out", file, "--duration", 5, expect=2)
        assert "say which is where with --left and --right" in unclear.stderr
        sides = ["--left", "F0:5E:00:00:00:01", "--right", "F0:5E:00:00:00:02"]
        profile = ["--profile", "cc2541-20hz"]
        run("record", "--via", where, *sides, *profile, "--out", file, "--duration", 9)
    steps = [event for event in events_of(list(read_packets(file))) if isinstance(event, StepTaken)]
    assert {event.foot.value for event in steps} == {"left", "right"}


def test_faults_come_from_a_script(tmp_path: Path) -> None:
    script, file = tmp_path / "faults.txt", tmp_path / "walk.jsonl"
    script.write_text("1.0 left_foot disconnect\n2.0 left_foot drop 3\n")
    with emulator("--distance", 5, "--faults", script) as (_, where):
        run("record", "--via", where, "--left", "solepath L", "--out", file, "--duration", 5)
    names = [type(event).__name__ for event in events_of(list(read_packets(file)))]
    assert names.count("Connected") == 2 and names.count("Disconnected") >= 1
    assert "PacketsLost" in names


# --- what is wrong is said in one line ---


def complaint(*arguments: object) -> str:
    done = run(*arguments, expect=2)
    assert done.stderr.count("\n") == 1 and done.stderr.startswith("solepath: "), done.stderr
    return done.stderr.removeprefix("solepath: ").rstrip()


def test_where_nobody_serves_that_is_said() -> None:
    assert "nothing answers at tcp:127.0.0.1:1" in complaint("scan", "--via", "tcp:127.0.0.1:1")


@pytest.mark.parametrize("command", ["scan", "live", "record"])
def test_a_machine_without_bluetooth_is_named_as_such(command: str, tmp_path: Path) -> None:
    if os.path.exists("/run/dbus/system_bus_socket"):
        pytest.skip("this machine may have Bluetooth")
    more = ["--out", tmp_path / "walk.jsonl"] if command == "record" else []
    assert "no Bluetooth" in complaint(command, *more)


@pytest.mark.parametrize(
    ("options", "told"),
    [
        (["--via", "there"], "'there' is not tcp:HOST:PORT"),
        (["--at", "knee=X"], "--at knee=X: that is not SITE=DEVICE"),
        (["--left", "X", "--profile", "wellington"], "there is no profile 'wellington'"),
        (["--left", "X", "--recipe", "cake"], "there is no recipe 'cake'"),
        (["--left", "X", "--right", "X"], "X"),
        (["--left", "X", "--at", "left_foot=Y"], "two devices cannot be at one site"),
    ],
)
def test_options_that_make_no_sense_are_named(options: list[str], told: str) -> None:
    assert told in complaint("live", *options)


@pytest.mark.parametrize(
    ("options", "told"),
    [
        (["--listen", "here"], "that is not HOST:PORT"),
        (["--mtu", "12"], "an MTU is from 23 to 517"),
    ],
)
def test_what_cannot_be_emulated_is_said(options: list[str], told: str) -> None:
    assert told in complaint("emulate", *options)


def test_a_script_that_makes_no_sense_is_named_with_its_line(tmp_path: Path) -> None:
    script = tmp_path / "faults.txt"
    script.write_text("1 left_foot disconnect\n2 left_foot stumble\n")
    assert f"{script}: line 2: " in complaint("emulate", "--faults", script)


def test_a_port_in_use_is_named(insoles: str) -> None:
    assert "in use" in complaint("emulate", "--listen", insoles.removeprefix("tcp:"))


def test_a_full_disk_ends_a_recording_with_one_line(insoles: str) -> None:
    if not Path("/dev/full").exists():
        pytest.skip("no /dev/full here")
    assert "/dev/full" in complaint("record", "--via", insoles, "--left", "solepath L", "--out", "/dev/full")


@pytest.mark.parametrize("command", ["scan", "live", "record", "emulate"])
def test_help_ends_with_an_example(command: str) -> None:
    assert f"example: solepath {command}" in " ".join(run(command, "--help").stdout.split())
