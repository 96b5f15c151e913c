"""Tests how a position that a person reports on the page gets to the session: command, access, packet, recording."""

from __future__ import annotations

from pathlib import Path

import pytest
from commands import run
from programs import TAKES, emulator, started
from served import TOKEN, close_code, scene_of, served
from watchers import ANYWHERE, Watcher, address, watch

from solepath.emulate.routes.building import BUILDING
from solepath.recording import read_packets
from solepath.show.page.live_commands import position_of
from solepath.wire.receiver import PositionFrame, parse_position


@pytest.mark.parametrize(
    "text", ['{"do":"pause"}', '{"do":"seek","value":1}', '{"do":"here","sigma":1,"at":[1,2],"level":"no such level"}']
)
async def test_a_live_session_takes_no_other_commands_and_no_other_levels(text: str) -> None:
    reported: list[PositionFrame] = []
    async with (
        served(commands=lambda command: reported.append(position_of(command, BUILDING))) as (_, client, url),
        client.ws_connect(f"{url}ws?token={TOKEN}") as watching,
    ):
        await scene_of(watching)
        await watching.send_str(text)
        assert await close_code(watching) == 1008
    assert reported == []


@pytest.mark.soak
def test_a_position_that_is_reported_to_live_sensors_is_in_the_recording_and_a_replay_gives_the_same_events(
    tmp_path: Path,
) -> None:
    pytest.importorskip("bumble")

    async def report(page: Watcher) -> None:
        await page.until(lambda frame: frame["feet"]["left"] is not None and frame["feet"]["left"]["strides"] >= 2)
        await page.socket.send_str('{"do":"here","sigma":0.1,"at":[200,0]}')
        await page.until(lambda frame: any("position rejected" in line[2] for line in frame.get("log", [])))

    recording, live, again = tmp_path / "walk.jsonl", tmp_path / "live", tmp_path / "again"
    with emulator("--distance", 6) as (_, where):
        named = ("--left", "solepath L", "--right", "solepath R", "--via", where)
        with started("live", *named, *ANYWHERE, "--record", recording, "--out", live, "--duration", 60) as process:
            watch(address(process), report)
            process.terminate()
            _, err = process.communicate(timeout=TAKES)
    assert (process.returncode, err) == (0, "")
    (reported,) = (packet for packet in read_packets(recording) if packet.channel == "receiver/position")
    assert parse_position(reported.data) == PositionFrame((200.0, 0.0), pytest.approx(0.1))
    run("track", recording, "--out", again)
    events = (live / "events.jsonl").read_text("utf-8")
    assert events == (again / "events.jsonl").read_text("utf-8")
    assert events.count('"PositionReported"') == events.count('"PositionRejected"') == 1
