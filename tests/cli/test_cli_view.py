"""demo, track and live on the page: what a browser hears, what it may ask for, and how the commands end."""

from __future__ import annotations

import json
import os
import re
import signal
import socket
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import ExitStack, suppress
from pathlib import Path
from time import sleep
from typing import Any

import pytest
from commands import refused, run
from shown import frame
from walks import insoles
from watchers import ANYWHERE, TAKES, Watcher, address, started, watch

from solepath import ActivityChanged, Session
from solepath.cli.bluetooth.live_run import LiveFiles, LiveSession
from solepath.emulate.routes.route import Route
from solepath.emulate.walk import emulate
from solepath.recording import PacketWriter
from solepath.show.page.scene.scene import Scene

pytest.importorskip("aiohttp")

ALONE = "import sys; sys.modules.update(dict.fromkeys(['bleak', 'bumble', 'rich', 'mcap', 'matplotlib'])); "
"""Nothing but the extra `view`."""


@pytest.fixture(autouse=True)
def nobody_at_a_terminal(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    with open(os.devnull) as nothing:
        monkeypatch.setattr(sys, "stdin", nothing)
        yield


@pytest.fixture(scope="module")
def recording(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Some steps in two insoles."""
    file = tmp_path_factory.mktemp("view") / "walk.jsonl"
    with PacketWriter(file) as writer:
        for packet in emulate(Route().stand(0.5).walk(2.5, speed=1.3).stop(0.5), seed=4).packets:
            writer.write(packet)
    return file


@pytest.fixture(scope="module")
def long_recording(recording: Path) -> Path:
    """The same over and over: some seconds of computing."""
    header, *packets = map(json.loads, recording.read_text().splitlines())
    length = packets[-1]["t"]
    file = recording.parent / "long.jsonl"
    again = [packet | {"t": packet["t"] + k * length} for k in range(30) for packet in packets]
    file.write_text("".join(f"{json.dumps(line)}\n" for line in [header, *again]))
    return file


def test_in_a_terminal_the_demo_opens_a_browser_is_steered_there_and_ends_with_the_same_table_at_ctrl_c(tmp_path: Path):
    pty = pytest.importorskip("pty")
    browser, opened = tmp_path / "browser", tmp_path / "opened"
    browser.write_text(f'#!/bin/sh\nprintf %s "$1" > {opened}.new && mv {opened}.new {opened}\n')
    browser.chmod(0o755)

    async def steer(page: Watcher) -> None:
        await page.until(lambda frame: frame["t"] > 0.3 and frame["feet"]["left"] is not None)
        assert (page.scene["source"], page.scene["control"]) == ("demo", True)
        assert len(page.scene["layouts"]["left"]["cells"]) == 96
        assert page.frame["feet"]["left"]["cells"] is not None
        end = page.frame["playback"]["end"]
        await page.ask("pause")
        await page.until(lambda frame: frame["playback"]["state"] == "paused")
        await page.ask("seek", end - 1.0)
        await page.until(lambda frame: frame["playback"]["t"] == round(end - 1.0, 3))
        scenes = page.scenes
        assert page.frame["feet"]["left"]["steps"] >= 2
        await page.ask("seek", 1.0)
        await page.until(lambda frame: frame["playback"]["t"] == 1.0)
        assert page.frame["feet"]["left"]["steps"] == 0 and page.scenes > scenes
        assert page.frame["playback"]["seeking"] is None
        await page.ask("speed", 32)
        await page.ask("play")
        await page.until(lambda frame: frame["playback"]["state"] == "ended")
        assert page.frame["playback"]["t"] == end

    ours, theirs = pty.openpty()
    environment = os.environ | {"BROWSER": str(browser), "TERM": "xterm"}
    terminal = dict.fromkeys(("stdin", "stdout", "stderr"), theirs) | {"env": environment}
    with started("demo", "--distance", 3, code=ALONE, **terminal) as process:
        os.close(theirs)
        seen = ""
        while "Ctrl-C ends it" not in seen:
            seen += os.read(ours, 65536).decode()
        url = re.search(r"the page: (\S+)", seen)
        assert url is not None and opened.read_text() == url[1]
        watch(url[1], steer)
        assert process.poll() is None
        process.send_signal(signal.SIGINT)
        try:
            while part := os.read(ours, 65536):
                seen += part.decode()
        except OSError:  # how Linux says that the other end of a terminal was closed
            pass
        assert process.wait(TAKES) == 0
    os.close(ours)
    table = "against the truth"
    assert table in seen and "\x1b[" not in seen
    straight = run("demo", "--distance", 3).stdout
    assert seen.replace("\r\n", "\n").partition(table)[2] == straight.partition(table)[2]


def test_without_a_terminal_the_demo_plays_to_its_end_by_itself_at_a_port_that_is_free():
    with ExitStack() as stack:
        with suppress(OSError):  # somebody else has it
            stack.enter_context(socket.create_server(("127.0.0.1", 8765)))
        done = run("demo", "--distance", 2, "--view", "--speed", 32)
    assert (done.returncode, done.stderr) == (0, "")
    found = re.search(r"\nthe page: http://127.0.0.1:(\d+)/", done.stdout)
    assert found is not None and found[1] != "8765" and "\nagainst the truth" in done.stdout


def test_what_track_writes_does_not_depend_on_the_page_which_is_there_before_anything_is_computed(
    recording: Path, tmp_path: Path
):
    plain, viewed = tmp_path / "plain", tmp_path / "viewed"
    said = run("track", recording, "--out", plain, "--report", tmp_path / "plain.html")

    async def steer(page: Watcher) -> None:
        await page.until(lambda frame: True)
        assert (page.scene["title"], page.scene["source"]) == ("walk.jsonl", "recording")
        assert page.frame["playback"]["t"] < 2.0
        await page.ask("seek", 3.0)
        await page.until(lambda frame: frame["playback"]["t"] >= 3.0)
        await page.ask("seek", 1.0)
        await page.until(lambda frame: 1.0 <= frame["playback"]["t"] < 3.0)

    with started("track", recording, *ANYWHERE, "--out", viewed, "--report", tmp_path / "viewed.html") as process:
        watch(address(process), steer)
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=TAKES)
    assert (process.returncode, err) == (0, "")
    for name in ("events.jsonl", "track.csv", "strides.csv", "gait_cycles.csv"):
        assert (plain / name).read_bytes() == (viewed / name).read_bytes()
    assert (tmp_path / "plain.html").read_bytes() == (tmp_path / "viewed.html").read_bytes()
    ended, rest, summed_up = out.partition("the rest of the recording")
    assert "computed" not in ended and rest
    assert summed_up.partition("\n")[2].partition("written to")[0] == said.stdout.partition("computed in")[0]


def test_another_ctrl_c_gives_the_rest_up_and_what_an_earlier_run_wrote_stays(long_recording: Path, tmp_path: Path):
    out, report = tmp_path / "out", tmp_path / "r.html"
    out.mkdir()
    earlier = {report: "a report", out / "events.jsonl": "events", out / "track.csv": "a track"}
    for file, text in earlier.items():
        file.write_text(text)
    with started("track", long_recording, *ANYWHERE, "--out", out, "--report", report) as process:
        address(process)
        assert process.stdout is not None
        process.send_signal(signal.SIGINT)
        while "Ctrl-C again gives it up" not in process.stdout.readline():
            pass
        process.send_signal(signal.SIGINT)
        said, err = process.communicate(timeout=TAKES)
    assert process.returncode == 130 and said == ""
    assert re.fullmatch(r"solepath: given up after \d+\.\d of .* s: .* what was written before stays as it is\n", err)
    assert {*out.iterdir(), report} == set(earlier)
    assert {file: file.read_text() for file in earlier} == earlier


def test_closing_the_terminal_ends_the_page_as_ctrl_c_does_and_all_is_written(recording: Path, tmp_path: Path):
    pty = pytest.importorskip("pty")
    plain, closed = tmp_path / "plain", tmp_path / "closed"
    run("track", recording, "--out", plain, "--report", tmp_path / "plain.html")
    ours, theirs = pty.openpty()
    terminal = dict.fromkeys(("stdin", "stdout", "stderr"), theirs) | {"start_new_session": True}
    owned = f"import fcntl, termios; fcntl.ioctl({theirs}, termios.TIOCSCTTY, 0); "  # to be told when it is closed
    terminal["pass_fds"] = (theirs,)
    command = ("track", recording, *ANYWHERE, "--no-browser", "--out", closed, "--report", tmp_path / "closed.html")
    with started(*command, code=owned, **terminal) as process:
        os.close(theirs)
        seen = ""
        while "Ctrl-C ends it" not in seen:
            seen += os.read(ours, 65536).decode()
        os.close(ours)
        assert process.wait(TAKES) == 0
    for name in ("events.jsonl", "track.csv", "strides.csv", "gait_cycles.csv"):
        assert (plain / name).read_bytes() == (closed / name).read_bytes()
    assert (tmp_path / "plain.html").read_bytes() == (tmp_path / "closed.html").read_bytes()
    assert len(list(closed.iterdir())) == 4


@pytest.mark.parametrize("how", ["SIGHUP", "SIGTERM", "SIGINT"])
def test_a_run_that_is_ended_leaves_what_an_earlier_one_wrote(how: str, long_recording: Path, tmp_path: Path):
    out, report = tmp_path / "out", tmp_path / "r.html"
    out.mkdir()
    (out / "track.csv").write_text("a track")
    report.write_text("a report")
    with started("track", long_recording, "--out", out, "--report", report) as process:
        while len(list(out.iterdir())) < 5 and process.poll() is None:
            sleep(0.01)
        process.send_signal(getattr(signal, how))
        assert process.wait(TAKES) == 130
    assert {*tmp_path.iterdir()} == {out, report} and [*out.iterdir()] == [out / "track.csv"]
    assert (out / "track.csv").read_text() == "a track" and report.read_text() == "a report"


def test_a_run_writes_through_links_and_into_pipes_and_leaves_who_may_read(recording: Path, tmp_path: Path):
    kept, link, pipe = tmp_path / "kept.html", tmp_path / "link.html", tmp_path / "pipe"
    kept.write_text("")
    kept.chmod(0o600)
    link.symlink_to(kept)
    os.mkfifo(pipe)
    assert run("track", recording, "--report", link).returncode == 0
    assert link.is_symlink() and kept.stat().st_mode & 0o777 == 0o600
    with subprocess.Popen(["cat", str(pipe)], stdout=subprocess.PIPE) as reader:
        assert run("track", recording, "--report", pipe).returncode == 0
        assert reader.communicate(timeout=TAKES)[0] == kept.read_bytes() != b""
    assert pipe.is_fifo()


def test_names_that_are_no_text_and_hold_control_codes_are_shown_without(recording: Path, tmp_path: Path):
    here = Path(os.fsdecode(os.fsencode(tmp_path) + b"/\xff\x1b[31m"))
    here.mkdir()
    walk = here / recording.name.replace("walk", "\x1b]0;\udcff")
    walk.write_bytes(recording.read_bytes())
    done = run("track", walk, "--out", here / "out", "--report", here / "r.html")
    assert (done.returncode, done.stderr) == (0, "")
    assert "\x1b" not in done.stdout and done.stdout.encode("utf-8")
    assert "\x1b" not in (here / "r.html").read_text(encoding="utf-8")
    done = run("demo", "--terminal", "--distance", 1, "--record", here / "demo.jsonl")
    assert done.returncode == 0 and "\x1b" not in done.stdout and done.stdout.encode("utf-8")


def test_a_damaged_recording_is_played_up_to_the_damage_and_a_page_for_other_machines_is_said_to_be_one(
    recording: Path, tmp_path: Path
):
    lines = recording.read_text().splitlines()
    torn = tmp_path / "torn.jsonl"
    torn.write_text("\n".join([*lines[: len(lines) // 2], "what?", *lines[len(lines) // 2 :]]))
    done = run("track", torn, "--view", "0.0.0.0:0", "--speed", 32)
    damage, warning = done.stderr.splitlines()
    assert done.returncode == 2 and f"torn.jsonl: line {len(lines) // 2 + 1}: is not JSON" in damage
    assert "can be reached from other machines" in warning
    assert re.match(r"the page: http://[^/]+:\d+/#token=\S{16,}\n", done.stdout)


@pytest.mark.parametrize("where", ["8765", "here", ":80", "127.0.0.1:", "127.0.0.1:70000", "127.0.0.1:-1"])
def test_what_is_no_address_is_refused(where: str, recording: Path):
    for command in (("demo",), ("track", recording), ("live",)):
        assert "that is not HOST:PORT, as in 127.0.0.1:8765" in refused(*command, f"--view={where}")


def test_a_pace_that_no_page_has_is_refused(recording: Path):
    assert "on the page it is from 0.1 to 32" in refused("track", recording, *ANYWHERE, "--speed", "33")
    assert "on the page it is from 0.1 to 32" in refused("demo", *ANYWHERE, "--speed", "0.01")


def test_what_is_said_of_a_page_that_nobody_asks_for_is_refused(recording: Path):
    for given in (("--speed", "4"), ("--no-browser",)):
        line = refused("track", recording, *given)
        assert line == f"solepath: {given[0]} is for the page: it goes with --view\n"
    assert "--no-browser is for the page: it goes with --view" in refused("live", "--no-browser")
    assert "--no-browser is for the page, and --terminal shows none" in refused("demo", "--terminal", "--no-browser")


def test_without_aiohttp_the_page_is_refused_with_how_to_install_it(recording: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setitem(sys.modules, "aiohttp", None)
    for command in (("demo",), ("track", recording), ("live",)):
        assert refused(*command, "--view") == "solepath: --view needs aiohttp: pip install 'solepath[view]'\n"


def test_a_report_that_cannot_be_written_is_refused_before_anything_is_computed(recording: Path, tmp_path: Path):
    assert "no such file or directory" in refused("track", recording, "--report", tmp_path / "none" / "r.html").lower()


def test_live_sensors_and_their_silence_are_seen_on_the_page(tmp_path: Path):
    pytest.importorskip("bumble")

    def all_are(state: str) -> Callable[[dict[str, Any]], bool]:
        return lambda frame: all(link["state"] == state for link in frame["links"].values())

    async def look(page: Watcher) -> None:
        await page.until(lambda frame: len(frame["links"]) == 2 and frame["feet"]["left"] is not None)
        assert (page.scene["source"], page.scene["control"]) == ("live", False)
        await page.until(all_are("ok"))
        await page.until(lambda frame: frame["feet"]["right"] is not None and frame["feet"]["right"]["force"] > 100.0)
        emulator.send_signal(signal.SIGSTOP)  # from nobody anything comes
        await page.until(all_are("silent"))
        assert page.frame["feet"]["left"]["cells"] is None
        await page.until(lambda frame: all(link["silent_for"] > 1.6 for link in frame["links"].values()))
        emulator.send_signal(signal.SIGCONT)
        await page.until(all_are("ok"))

    with started("emulate", "--listen", "127.0.0.1:0", "--distance", 5) as emulator:
        assert emulator.stdout is not None
        where = emulator.stdout.readline().split()[-1]
        named = ("--left", "solepath L", "--right", "solepath R", "--via", where)
        with started("live", *named, *ANYWHERE, "--out", tmp_path, "--duration", 60) as process:
            watch(address(process), look)
            process.send_signal(signal.SIGINT)
            out, err = process.communicate(timeout=TAKES)
    assert (process.returncode, err) == (0, "") and f"written to {tmp_path}" in out
    assert "FootPressed" not in (tmp_path / "events.jsonl").read_text()


def test_what_a_live_session_says_at_its_end_reaches_the_page_too() -> None:
    session, other = Session(poses=True, pressures=True), Session(poses=True, pressures=True)
    live = LiveSession(session, scene := Scene("Live", "default"), LiveFiles(None, None))
    for packet in insoles().packets:
        live.take(packet)
        other.feed(packet)
    before = frame(scene)["activity"]
    live.finish()
    (last,) = [event for event in other.finish() if isinstance(event, ActivityChanged)]
    after = frame(scene)["activity"]
    assert (after["now"], after["since"]) == (last.activity.value, round(last.t, 3)) != (before["now"], before["since"])
