"""A walk in the browser goes on after its tab or its worker was killed; full storage and a second tab are in words."""

from __future__ import annotations

import asyncio
from contextlib import suppress
from pathlib import Path
from typing import Any

from browsers import Browser, Window
from web_pages import PATIENCE, READY, WORDS, demo_packets, open_site, ready

from solepath import Packet
from solepath.recording import read_packets
from solepath.show.web.serve import serving

FEED = """async (seconds) => {
    const { clock, packet } = await import('./live.js');
    const { unpacked } = await import('./unpack.js');
    const bytes = await unpacked(await (await fetch('demo.jsonl.gz')).blob());
    const rows = new TextDecoder().decode(bytes).trim().split('\\n').slice(1).map(JSON.parse);
    const stood = 1.2; // s for which the wearer has stood when the walk starts
    const end = clock() + seconds;
    let next = rows.findIndex(({ t }) => t > clock() + stood);
    const first = next;
    while (clock() < end) {
        for (; rows[next].t <= clock() + stood; next += 1) {
            const { site, channel, data } = rows[next];
            packet(site, channel, Uint8Array.from(data.match(/../g) ?? [], (two) => parseInt(two, 16)));
        }
        await new Promise((resolve) => setTimeout(resolve, 10));
    }
    return next - first;
}"""
SHOWN = """({ strides: ['left', 'right'].map((foot) => solepath.state.feet[foot]?.strides),
    track: solepath.state.tracks.left, phases: solepath.state.phases.left.length > 0 })"""


async def test_a_walk_goes_on_after_its_tab_and_its_worker_were_killed(
    chromium: Browser, site: Path, tmp_path: Path
) -> None:
    """The packets of the demonstration come in real time, as from sensors, with a gap while the tab is dead."""
    with serving(site) as url:
        async with open_site(chromium, url) as view:
            await view.tab.evaluate("import('./live.js').then((live) => live.startWalk('A walk'))")
            await view.until("!document.getElementById('end').hidden")
            fed = await walk(view, 3.5)
            await view.tab.evaluate("computer.call('save')")
            fed += await walk(view, 1.0)
            before = await settled(view)
            assert min(before["strides"]) >= 2
            with suppress(TimeoutError):  # who is killed does not answer
                await asyncio.wait_for(view.devtools.send("Page.crash"), 1.0)
            view.tab = await view.tab.context.new_page()
            await view.tab.goto(url)
            await ready(view)
            assert await settled(view) == before
            assert await view.text("title") == "A walk"
            fed += await walk(view, 3.0)
            resumed = await settled(view)
            assert all(now > then for now, then in zip(resumed["strides"], before["strides"], strict=True))
            assert resumed["track"][: len(before["track"])] == before["track"]
            assert all(link["gaps"] >= 1 for link in (await view.tab.evaluate("solepath.state.links")).values())
            log = await view.tab.evaluate("solepath.state.log.map(([, , words]) => words)")
            assert any("data come again after" in words for words in log), log
            await check_another_tab(view, url)
            await check_full_storage(view, url)
            await view.tab.evaluate("computer.kill()")
            await view.until("document.getElementById('offline').innerText.includes('has stopped')")
            await view.tab.locator("#retry").click()
            await view.until(READY, patience=PATIENCE)
            assert await settled(view) == resumed
            await view.tab.locator("#end").click()
            await view.until("document.querySelectorAll('#walks li').length === 1")
            name = (await view.tab.evaluate("document.querySelector('.walk-name').textContent")).partition(",")[0]
            text = await view.tab.evaluate(f"computer.call('get', '{name}.jsonl').then((file) => file.text())")
            path = tmp_path / "recorded.jsonl"
            path.write_text(text)
            recorded = tuple(read_packets(path))
            assert len(recorded) == fed
            assert set(recorded_data(recorded)) <= set(recorded_data(demo_packets(site)))


async def check_another_tab(view: Window, url: str) -> None:
    """A second tab neither shows the walk as its own nor starts another one."""
    first, view.tab = view.tab, await view.tab.context.new_page()
    await view.tab.goto(url)
    await ready(view)
    start = "import('./live.js').then((live) => live.startWalk('B')).then(() => '', (error) => error.message)"
    assert "another tab" in await view.tab.evaluate(start)
    await view.tab.close()
    view.tab = first


async def check_full_storage(view: Window, url: str) -> None:
    devtools = await view.tab.context.new_cdp_session(view.tab)
    await devtools.send("Storage.overrideQuotaForOrigin", {"origin": url.rstrip("/"), "quotaSize": 1})
    await walk(view, 0.3)
    await view.until(f"{WORDS}.includes('storage of this device is full')")
    await devtools.send("Storage.overrideQuotaForOrigin", {"origin": url.rstrip("/")})


async def walk(view: Window, seconds: float) -> int:
    """Let the sensors of the demonstration send for a time, s, up to now; return the number of packets."""
    fed: int = await view.tab.evaluate(FEED, seconds)
    return fed


async def settled(view: Window) -> dict[str, Any]:
    """Return what the page shows of a walk, when nothing is on the way any more."""
    await view.tab.evaluate("new Promise((resolve) => setTimeout(resolve, 300))")
    found: dict[str, Any] = await view.tab.evaluate(SHOWN)
    return found


def recorded_data(packets: tuple[Packet, ...]) -> list[tuple[str, str, bytes]]:
    return [(packet.site.value, packet.channel, packet.data) for packet in packets]
