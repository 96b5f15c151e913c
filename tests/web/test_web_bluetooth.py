"""Emulated insoles walk into the site through Chromium's own Bluetooth stack; reads stand in for notifications."""

from __future__ import annotations

import asyncio
from pathlib import Path

from browsers import Browser, Window
from web_bluetooth import WebBluetooth
from web_pages import WORDS, open_site

from solepath import Packet, Session, StrideTaken
from solepath.emulate.devices.bench import Bench
from solepath.emulate.routes.route import Route
from solepath.recording import read_packets
from solepath.show.web.serve import serving
from solepath.types import Foot

ROUTE = Route().stand(4.0).walk(30.0).stop(2.0)
STATES = "Object.fromEntries(Object.entries(solepath.state.links).map(([site, link]) => [site, link.state]))"
STRIDES = "['left', 'right'].map((foot) => solepath.state.feet[foot]?.strides ?? 0)"


async def recorded(view: Window, folder: Path) -> tuple[Packet, ...]:
    """Return the packets of the recording of the walk that was ended."""
    await view.until("document.querySelectorAll('#walks li').length === 1")
    name = (await view.tab.evaluate("document.querySelector('.walk-name').textContent")).partition(",")[0]
    text = await view.tab.evaluate(f"computer.call('get', '{name}.jsonl').then((file) => file.text())")
    path = folder / "walk.jsonl"
    path.write_text(text)
    return tuple(read_packets(path))


def strides(packets: tuple[Packet, ...]) -> list[int]:
    """Return the number of final strides of each foot that CPython finds in the packets."""
    session = Session()
    events = [event for packet in packets for event in session.feed(packet)] + session.finish()
    taken = [event for event in events if isinstance(event, StrideTaken) and event.final]
    return [sum(event.foot is foot for event in taken) for foot in Foot]


async def test_two_insoles_walk_are_lost_and_go_on_after_the_tab_was_killed(
    chromium: Browser, site: Path, tmp_path: Path
) -> None:
    bench = Bench(ROUTE, seed=3)
    bench.prepare()
    left, right = (device.address for device in bench.peripherals)
    with serving(site) as url:
        async with open_site(chromium, url) as view:
            radio = WebBluetooth(view, bench.peripherals)
            await radio.start()
            try:
                await radio.choose(None)
                await view.until(f"{WORDS}.includes('No sensor was chosen')")
                bench.walk_from(asyncio.get_running_loop().time())
                for address in (left, right):
                    await radio.choose(address)
                await view.until(f"{STRIDES}.every((count) => count >= 2)")
                assert await view.tab.evaluate(STATES) == {"left foot": "ok", "right foot": "ok"}
                await radio.lose(left)
                await view.until(f"({STATES})['left foot'] === 'lost'")
                for _ in range(4):
                    await asyncio.sleep(1.0)
                    print(
                        await view.tab.evaluate("solepath.state.log.map(([, , words]) => words)"),
                        await view.tab.evaluate("import('./bluetooth.js').then((m) => [...m.sensors.keys()])"),
                        view.complaints,
                    )
                before: list[int] = await view.tab.evaluate(STRIDES)
                await view.until(f"({STATES})['left foot'] === 'ok' && {STRIDES}[0] > {before[0]}")
            finally:
                await radio.stop()
            print(view.complaints)
