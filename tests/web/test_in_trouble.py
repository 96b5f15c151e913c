"""What a phone may withhold from the site: Bluetooth, a screen that stays on, a save of use, an app to share with."""

from __future__ import annotations

import asyncio
from pathlib import Path

import pytest
from browsers import Browser, Window, window
from here import PROTOCOL
from scripted_sensors import STREAM, WALK, connect
from web_pages import READY, WORDS, open_site, ready

from solepath.recording import read_packets
from solepath.show.web.serve import serving

IPHONE = "Mozilla/5.0 (iPhone; CPU iPhone OS 18_5 like Mac OS X) AppleWebKit/605.1.15 Version/18.5 Mobile Safari/604.1"
WORDS_FOR = """(userAgent) => {
    Object.defineProperty(navigator, 'userAgent', { value: userAgent, configurable: true });
    return import('./bluetooth.js').then((bluetooth) => bluetooth.bluetoothWords());
}"""
SPY = """
globalThis.held = 0;
if (navigator.wakeLock) {
    const request = navigator.wakeLock.request.bind(navigator.wakeLock);
    navigator.wakeLock.request = async (kind) => {
        const lock = await request(kind).catch(() => new EventTarget());
        held += 1;
        const release = lock.release?.bind(lock);
        lock.release = async () => { held -= 1; await release?.(); };
        return lock;
    };
}
"""
CHANGE_SAVE = """(change) => new Promise((resolve) => {
    indexedDB.open('solepath').onsuccess = ({ target: { result } }) => {
        const values = result.transaction('values', 'readwrite').objectStore('values');
        values.get('walk').onsuccess = ({ target }) => {
            values.put({ ...target.result, ...change }, 'walk').onsuccess = () => { result.close(); resolve(); };
        };
    };
})"""
FULL = """(full) => {
    const kind = FileSystemSyncAccessHandle.prototype;
    kind.whole ??= kind.write;
    kind.write = full ? () => { throw new DOMException('', 'QuotaExceededError'); } : kind.whole;
}"""
STRIDES = "(solepath.state.feet.left?.strides ?? 0) + (solepath.state.feet.right?.strides ?? 0)"


@pytest.mark.soak
async def test_without_bluetooth_the_page_names_browsers_that_have_it(chromium: Browser, site: Path) -> None:
    with serving(site) as url:
        async with window(chromium, url, width=360, script="delete Navigator.prototype.bluetooth;") as view:
            await ready(view)
            await view.until("document.getElementById('activity').textContent === 'No Bluetooth'")
            assert await view.tab.locator("#connect").is_hidden() and await view.tab.locator("#demo").is_visible()
            assert "Chrome on Linux lets a page" in await view.text("first")
            words = await view.tab.evaluate(WORDS_FOR, IPHONE)
            assert "No browser on an iPhone or iPad" in words and "the demonstration can be played here" in words


async def restart(view: Window) -> None:
    """Let the worker end, and start it again by the button of the page."""
    await view.tab.evaluate("computer.kill()")
    await view.until("document.getElementById('offline').innerText.includes('has stopped')")
    await view.tab.locator("#retry").click()
    await view.until(READY)


@pytest.mark.long
async def test_what_was_recorded_is_computed_once_although_the_storage_was_full(
    chromium: Browser, site: Path, tmp_path: Path
) -> None:
    with serving(site) as url:
        async with open_site(chromium, url, script=SPY) as view:
            await view.tab.locator("#file").set_input_files([PROTOCOL / "floorplans" / "house.geojson"])
            await view.until(f"{WORDS}.includes('this floor plan is used from now on')")
            await connect(view)
            await view.until("held === 1 && solepath.state.plan !== null")
            await view.tab.evaluate(WALK, {"seconds": 2.0, "stream": STREAM})
            [worker] = view.tab.workers
            await worker.evaluate(FULL, True)
            await view.tab.evaluate(WALK, {"seconds": 2.0, "stream": STREAM})
            assert "the storage of this device is full" in await view.tab.evaluate(WORDS)
            await view.tab.evaluate("computer.call('save')")
            await worker.evaluate(FULL, False)
            await asyncio.sleep(2.0)  # it is tried again by then
            await view.tab.evaluate(WALK, {"seconds": 1.0, "stream": STREAM})
            before = await view.tab.evaluate(STRIDES)
            await check_tabs(view, url)
            await view.until(f"solepath.state.known && {STRIDES} === {before} && solepath.state.plan !== null")
            await view.tab.evaluate(CHANGE_SAVE, {"saved": "{}"})
            await restart(view)
            words = await view.tab.evaluate(WORDS)
            assert "The saved state cannot be used (not a saved walk); the recording is computed again" in words
            assert await view.tab.evaluate(STRIDES) == before >= 4
            await view.tab.evaluate(CHANGE_SAVE, {"attempts": 3})
            await restart(view)
            assert "does not go on: the page ended 3 times" in await view.tab.evaluate(WORDS)
            await view.until("held === 0 && document.querySelectorAll('#walks li').length === 1")
            await check_sharing(view, tmp_path)
            await view.tab.context.set_offline(True)
            await view.tab.locator("#demo").click()  # no walk is in the way, and no network either
            await view.until("solepath.state.playback?.state === 'playing'")


async def check_tabs(view: Window, url: str) -> None:
    """A second tab says that a walk is measured elsewhere, and continues it once the first is closed."""
    first, view.tab = view.tab, await view.tab.context.new_page()
    await view.tab.goto(url)
    await ready(view)
    assert "Another tab of this page measures a walk" in await view.tab.evaluate(WORDS)
    await first.close()
    await view.tab.evaluate("import('./live.js').then((live) => live.startWalk('another'))")


async def check_sharing(view: Window, folder: Path) -> None:
    """A walk goes to the downloads where the browser has no list of apps."""
    await view.tab.locator("#more").click()
    async with view.tab.expect_download() as downloading:
        await view.tab.get_by_role("button", name="Share walk-").click()
    await (await downloading.value).save_as(folder / "walk.jsonl")
    packets = list(read_packets(folder / "walk.jsonl"))
    assert sum(packet.channel == STREAM for packet in packets) == pytest.approx(1000, abs=50)
