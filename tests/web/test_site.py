"""The static site in a real browser: Python runs in it, and the server may be gone."""

from __future__ import annotations

import asyncio
import json
from contextlib import ExitStack, suppress
from pathlib import Path
from typing import Any
from urllib.error import URLError
from urllib.request import urlopen

import pytest
from browsers import Browser, Window
from web_pages import PATIENCE, READY, WORDS, demo_packets, open_site, ready, scene_of

from solepath import Packet
from solepath.emulate import emulate
from solepath.emulate.demo import SITE_ROUTE
from solepath.recording import read_packets
from solepath.show.page.messages import encode
from solepath.show.web.serve import serving
from solepath.show.web.site import build_site, compressed_size

MAX_SIZE = 7_000_000
"""Largest size of the site as a server sends it, bytes."""
TO_THE_END = """(() => { const seek = document.getElementById('seek');
    seek.value = seek.max; seek.dispatchEvent(new Event('change')); })()"""
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


def test_two_builds_give_the_same_bytes_of_less_than_7_MB(site: Path, tmp_path: Path) -> None:
    files = build_site(tmp_path / "site", emulate(SITE_ROUTE).packets)
    first = {path.name: path.read_bytes() for path in site.iterdir()}
    assert [name for name in files.keys() | first.keys() if files.get(name) != first.get(name)] == []
    assert sum(map(compressed_size, files.values())) < MAX_SIZE


async def test_the_demonstration_gives_the_strides_that_cpython_gives(chromium: Browser, site: Path) -> None:
    expected = json.loads(encode(scene_of(demo_packets(site)).whole_message()[0]))
    with serving(site) as url:
        async with open_site(chromium, url) as view:
            await view.tab.locator("#demo").click()
            await view.until("solepath.state.playback?.state === 'playing' && solepath.frames > 10")
            await view.until("solepath.state.feet.left?.cells?.length === 96")
            await view.tab.evaluate(TO_THE_END)
            await view.until("solepath.state.playback.state === 'ended'", patience=PATIENCE)
            shown = await view.tab.evaluate("({ feet: solepath.state.feet, tracks: solepath.state.tracks })")
            for foot in ("left", "right"):
                assert shown["feet"][foot]["strides"] == expected["frame"]["feet"][foot]["strides"] > 15
                assert shown["feet"][foot]["distance"] == expected["frame"]["feet"][foot]["distance"]
                assert shown["tracks"][foot] == expected["tracks"][foot]
            await view.tab.locator("#report").click()
            await view.until("!document.getElementById('report-file').hidden", patience=PATIENCE)
            async with view.tab.context.expect_page() as opening:
                await view.tab.locator("#report-link").click()
            report = await opening.value
            await report.wait_for_load_state()
            assert "left foot took" in await report.inner_text("main")
            assert (await report.evaluate("getComputedStyle(document.querySelector('figure')).padding")) != "0px"
            await check_bad_files(view, site)
            await check_isolation(view, site)
            await check_manifest(view)
            assert not view.complaints, view.complaints


async def check_bad_files(view: Window, site: Path) -> None:
    async def words_of(name: str, content: bytes) -> str:
        file: Any = {"name": name, "mimeType": "application/octet-stream", "buffer": content}
        await view.tab.locator("#file").set_input_files([file])
        await view.until(f"{WORDS} !== ''")
        found: str = await view.tab.evaluate(WORDS)
        await view.tab.evaluate("document.getElementById('site-words').textContent = ''")
        return found

    assert "line 1: is not JSON" in await words_of("walk.jsonl", b"{\n")
    assert "holds no packets" in await words_of("a.jsonl", b'{"format": "solepath-packets", "version": 1}\n')
    assert "neither a recording" in await words_of("picture.png", b"\x89PNG")
    assert "not samples" in await words_of("walk.csv", b"t,acc\n")
    assert (await words_of("plan.geojson", b"{}")).startswith("plan.geojson: ")
    assert "of version 9" in await words_of("c.json", b'{"format": "solepath-calibration", "version": 9}')
    assert "cannot be read" in await words_of("walk.jsonl.gz", b"\x1f\x8bno gzip at all")


async def check_isolation(view: Window, site: Path) -> None:
    """Neither page nor worker reaches another origin."""
    with serving(site) as elsewhere:
        for scope in (view.tab, view.tab.workers[0]):
            how = await scope.evaluate(
                "url => fetch(url, {mode: 'no-cors'}).then(() => 'reached', (e) => e.name)", elsewhere
            )
            assert how == "TypeError"
    assert all("Content Security Policy" in words for words in view.complaints), view.complaints
    view.complaints.clear()
    view.requests[:] = [one for one in view.requests if not one.startswith(elsewhere)]


async def check_manifest(view: Window) -> None:
    manifest = await view.devtools.send("Page.getAppManifest")
    assert manifest["url"] and not manifest["errors"]
    found = await view.devtools.send("Page.getInstallabilityErrors")
    faults = [one["errorId"] for one in found["installabilityErrors"]]
    assert [one for one in faults if one != "in-incognito"] == []


async def test_it_starts_without_its_server(chromium: Browser, site: Path) -> None:
    with ExitStack() as server:
        url = server.enter_context(serving(site))
        async with open_site(chromium, url) as view:
            await view.until("navigator.serviceWorker.controller !== null", patience=PATIENCE)
            server.close()
            with pytest.raises(URLError):
                urlopen(url)
            await view.tab.reload()
            await ready(view)
            await view.tab.locator("#demo").click()
            await view.until("solepath.state.playback?.state === 'playing'", patience=PATIENCE)


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
