"""Emulated insoles walk into the site through Chromium's own Bluetooth stack; reads stand in for notifications."""

from __future__ import annotations

import asyncio
import json
from collections import Counter
from pathlib import Path

import pytest
from browsers import Browser, Window
from web_bluetooth import web_bluetooth
from web_pages import READY, open_site, ready

from solepath import Connected, Packet, PacketRejected, Session, StrideTaken
from solepath.emulate.devices.bench import Bench
from solepath.emulate.routes.route import Route
from solepath.recording import read_packets
from solepath.show.web.serve import serving
from solepath.types import Foot, Site

ROUTE = Route().stand(4.0).walk(100.0).stop(2.0)
STATES = "Object.fromEntries(Object.entries(solepath.state.links).map(([site, link]) => [site, link.state]))"
STRIDES = "['left', 'right'].map((foot) => solepath.state.feet[foot]?.strides ?? 0)"
LOG = "solepath.state.log.map(([, , words]) => words)"
IN_FLIGHT = 80
"""Largest number of frames that kills of the tab and of the worker may cost: twice 200 ms of both feet."""
SHOWN = f"({{ strides: {STRIDES}, track: solepath.state.tracks.left }})"


async def recorded(view: Window, folder: Path) -> tuple[Packet, ...]:
    """Return the packets of the recording of the walk that was ended."""
    await view.until("document.querySelectorAll('#walks li').length === 1")
    name = await view.tab.evaluate("document.querySelector('#walks li').dataset.name")
    text = await view.tab.evaluate(f"computer.call('get', '{name}').then((file) => file.text())")
    path = folder / "walk.jsonl"
    path.write_text(text)
    return tuple(read_packets(path))


def strides(packets: tuple[Packet, ...]) -> list[int]:
    """Return the number of final strides of each foot that CPython finds in the packets."""
    session = Session()
    events = [event for packet in packets for event in session.feed(packet)] + session.finish()
    taken = [event for event in events if isinstance(event, StrideTaken) and event.final]
    return [sum(event.foot is foot for event in taken) for foot in Foot]


@pytest.mark.long
async def test_two_insoles_walk_are_lost_and_go_on_after_the_tab_was_killed(
    chromium: Browser, site: Path, tmp_path: Path
) -> None:
    bench = Bench(ROUTE, seed=3)
    bench.prepare()
    left, right = (device.address for device in bench.peripherals)
    with serving(site) as url:
        async with open_site(chromium, url) as view, web_bluetooth(view, bench.peripherals) as radio:
            bench.walk_from(asyncio.get_running_loop().time())
            await radio.choose(left)
            await radio.choose(right)
            await view.until(f"{STRIDES}.every((count) => count >= 2)")
            assert await view.tab.evaluate(STATES) == {"left foot": "ok", "right foot": "ok"}
            await radio.lose(left)
            await view.until(f"{LOG}.includes('left foot: the connection is lost')")
            at_loss = await view.tab.evaluate(STRIDES)
            await view.until(f"({STATES})['left foot'] === 'ok' && {STRIDES}[0] > {at_loss[0]}")
            await view.tab.evaluate("computer.call('save')")
            before = await view.tab.evaluate(SHOWN)
            await radio.kill_tab()
            view.tab = await view.tab.context.new_page()
            await view.tab.goto(url)
            await ready(view)
            await view.until("document.getElementById('where').textContent === 'connect the sensors again'")
            await radio.choose(left)
            await radio.choose(right)
            more = [count + 2 for count in before["strides"]]
            await view.until(f"{STRIDES}.every((count, foot) => count >= {more}[foot])")
            after = await view.tab.evaluate(SHOWN)
            assert after["track"][: len(before["track"])] == before["track"]
            links = (await view.tab.evaluate("solepath.state.links")).values()
            assert all(link["gaps"] >= 1 or link["absent"] > 0.0 for link in links)
            assert any("data come again after" in words for words in await view.tab.evaluate(LOG))
            await radio.stop_reading()
            await view.tab.evaluate("computer.kill()")
            await view.until("document.getElementById('offline').innerText.includes('has stopped')")
            await view.tab.locator("#retry").click()
            await view.until(READY)
            await view.until(f"{LOG}.filter((words) => words.includes('foot: connected, ')).length === {4 + 3}")
            at_restart = await view.tab.evaluate(STRIDES)
            await view.until(f"{STRIDES}.every((count, foot) => count > {at_restart}[foot])")
            await radio.stop_reading()
            await view.tab.locator("#end").click()
            packets = await recorded(view, tmp_path)
            same = json.dumps(strides(packets), separators=(",", ":"))
            await view.until(f"JSON.stringify({STRIDES}) === '{same}'")
            assert [one for one in view.complaints if "Web Bluetooth is experimental" not in one] == []
    session = Session()
    events = [event for packet in packets for event in session.feed(packet)]
    assert not [event for event in events if isinstance(event, PacketRejected)]
    connections = [event for event in events if isinstance(event, Connected)]
    assert Counter(event.site for event in connections) == {Site.LEFT_FOOT: 4, Site.RIGHT_FOOT: 3}
    frames = sum(packet.channel == "insole/frame" for packet in packets)
    assert 0 <= radio.frames_read - frames <= IN_FLIGHT
