"""Tests demo, track and live on the page: its messages and commands, and how the commands end."""

from __future__ import annotations

import os
import re
import signal
import sys
from pathlib import Path

import pytest
from commands import run, run_failing
from programs import TAKES, drawn, in_terminal, started
from recordings import into, written
from watchers import ANYWHERE, Watcher, address, watch

from solepath.types.extras import install_hint

pytest.importorskip("aiohttp")

ALONE = "import sys; sys.modules.update(dict.fromkeys(['bleak', 'bumble', 'rich', 'mcap', 'matplotlib'])); "
"""Code that makes packages of all other extras than `view` unavailable."""


@pytest.fixture(scope="module")
def plain(recording: Path) -> tuple[Path, str]:
    """Return where `track` wrote without a page, and what it printed."""
    folder = recording.with_name("plain")
    folder.mkdir()
    return folder, run("track", recording, *into(folder)).stdout


@pytest.mark.soak
def test_in_a_terminal_the_demo_opens_a_browser_is_steered_there_and_ends_with_the_same_table_at_ctrl_c(tmp_path: Path):
    browser, opened = tmp_path / "browser", tmp_path / "opened"
    browser.write_text(f'#!/bin/sh\nprintf %s "$1" > {opened}.new && mv {opened}.new {opened}\n')
    browser.chmod(0o755)

    async def steer(page: Watcher) -> None:
        await page.until(lambda frame: frame["t"] > 0.3 and frame["feet"]["left"] is not None)
        assert (page.scene["source"], page.scene["control"]) == ("demo", True)
        end = page.frame["playback"]["end"]
        await page.send_command("seek", end)
        await page.until(lambda frame: frame["playback"]["t"] >= round(end, 3))

    environment = os.environ | {"BROWSER": str(browser), "TERM": "xterm"}
    with in_terminal("demo", "--distance", 3, code=ALONE, env=environment) as (terminal, process):
        seen = drawn(terminal, until="Ctrl-C ends it")
        url = re.search(r"the page: (\S+)", seen)
        assert url is not None and opened.read_text() == url[1]
        watch(url[1], steer)
        assert process.poll() is None
        process.send_signal(signal.SIGINT)
        seen += drawn(terminal)
        assert process.wait(TAKES) == 0
    table = "against the truth"
    assert table in seen and "\x1b[" not in seen
    straight = run("demo", "--distance", 3).stdout
    assert seen.replace("\r\n", "\n").partition(table)[2] == straight.partition(table)[2]


def test_what_track_writes_does_not_depend_on_the_page_which_is_there_before_anything_is_computed(
    recording: Path, plain: tuple[Path, str], tmp_path: Path
):
    async def steer(page: Watcher) -> None:
        await page.until(lambda frame: True)
        assert (page.scene["title"], page.scene["source"]) == ("walk.jsonl", "recording")
        assert page.frame["playback"]["t"] < 2.0
        await page.send_command("seek", 3.0)
        await page.until(lambda frame: frame["playback"]["t"] >= 3.0)
        await page.send_command("seek", 1.0)
        await page.until(lambda frame: 1.0 <= frame["playback"]["t"] < 3.0)

    with started("track", recording, *ANYWHERE, *into(tmp_path)) as process:
        watch(address(process), steer)
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=TAKES)
    assert (process.returncode, err) == (0, "")
    assert written(tmp_path) == written(plain[0]) and len(written(tmp_path)) == 6
    ended, rest, summed_up = out.partition("the rest of the recording")
    assert "computed" not in ended and rest
    assert summed_up.partition("\n")[2].partition("written to")[0] == plain[1].partition("computed in")[0]


def test_a_damaged_recording_is_played_and_a_public_page_is_reported(recording: Path, tmp_path: Path):
    lines = recording.read_text().splitlines()
    torn = tmp_path / "torn.jsonl"
    torn.write_text("\n".join([*lines[: len(lines) // 2], "what?", *lines[len(lines) // 2 :]]))
    result = run("track", torn, "--view", "0.0.0.0:0", "--speed", 32)
    damage, warning = result.stderr.splitlines()
    assert result.returncode == 0 and f"torn.jsonl: line {len(lines) // 2 + 1}: is not JSON" in damage
    assert "can be reached from other machines" in warning
    assert re.match(r"the page: http://[^/]+:\d+/#token=\S{16,}\n", result.stdout)


def test_without_aiohttp_the_message_names_the_package(recording: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setitem(sys.modules, "aiohttp", None)
    for command in (("demo",), ("track", recording), ("live",)):
        assert run_failing(*command, "--view") == f"solepath: --view needs aiohttp: {install_hint('view')}\n"
