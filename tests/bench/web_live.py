"""Measures a live walk on the site of `solepath web` in Chromium: `python tests/bench/web_live.py`.

Two insoles of 96 cells at 100 Hz come in real time, for a minute or `--minutes N`, into a window of 360 px that is
drawn all the while. Printed are the delay from the arrival of a frame in the page until its events are computed, the
processor time of the page's process, and the memory of the page's scripts at the start and at the end. The frames come
from a script of the page, not over Bluetooth: what the radio and the browser's Bluetooth add is not measured."""

from __future__ import annotations

import argparse
import asyncio
import os
import sys
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

sys.path[:0] = [str(Path(__file__).parents[1] / "helpers" / folder) for folder in ("", "page")]

from browsers import Browser, browsing, why_not  # noqa: E402
from web_pages import PATIENCE, open_site  # noqa: E402

from solepath.emulate import Route, emulate  # noqa: E402
from solepath.link.devices.insole import PROFILE as INSOLE  # noqa: E402
from solepath.link.profile import Access  # noqa: E402
from solepath.show.web.serve import serving  # noqa: E402
from solepath.show.web.site import build_site  # noqa: E402

MINUTE = 60.0
SPEED = 1.3
"""Walking speed, m/s."""
CONNECT = """async (characteristics) => {
    const live = await import('./live.js'), { unpacked } = await import('./unpack.js');
    const text = new TextDecoder().decode(await unpacked(await (await fetch('demo.jsonl.gz')).blob()));
    globalThis.rows = text.trim().split('\\n').slice(1).map(JSON.parse);
    const value = (device, channel) => rows.find((row) => row.site === device && row.channel === channel)?.data ?? '';
    computer.on('orders', (orders) => orders.forEach(({ type, device, channel }) => {
        if (['read', 'subscribe', 'write'].includes(type))
            live.send({ type: 'done', device, t: live.clock(), value: type === 'read' ? value(device, channel) : '' });
    }));
    computer.on('walk', (walk) => (globalThis.began = walk.began));
    await live.startWalk('A walk');
    for (const device of ['left_foot', 'right_foot']) {
        live.send({ type: 'add', device });
        live.send({ type: 'connected', device, t: live.clock(), name: device, characteristics });
    }
}"""
"""Lets two insoles connect whose values are those of the demonstration; their sites are also their identifiers."""
WALK = """async ({ seconds, stream }) => {
    const { clock, notified, bytes } = await import('./live.js');
    const frames = rows.filter(({ channel }) => channel === stream);
    const start = clock() - frames[0].t;
    let next = 0;
    while (clock() - start < seconds && next < frames.length) {
        for (; next < frames.length && frames[next].t <= clock() - start; next += 1)
            notified(frames[next].site, stream, new DataView(bytes(frames[next].data).buffer));
        await new Promise((resolve) => setTimeout(resolve, 1));
    }
    return next;
}"""
MEASURE = """(began) => {
    const handle = self.onmessage;
    self.delays = [];
    self.onmessage = async (event) => {
        await handle(event);
        const now = (performance.timeOrigin + performance.now()) / 1000 - began;
        for (const message of event.data.sensors ?? [])
            if (message.type === 'values') for (const [t] of message.values) self.delays.push(1000 * (now - t));
    };
}"""
DELAYS = "() => self.delays.sort((one, other) => one - other)"


async def processor_time(devtools: Any) -> float:
    """Return the processor time of all renderers of the browser, s."""
    processes = (await devtools.send("SystemInfo.getProcessInfo"))["processInfo"]
    return sum(one["cpuTime"] for one in processes if one["type"] == "renderer")


async def measure(chromium: Browser, folder: Path, seconds: float) -> None:
    characteristics = [[one.service, one.characteristic, one.access is Access.NOTIFY] for one in INSOLE.channels]
    browser = await chromium.new_browser_cdp_session()
    with serving(folder) as url:
        async with open_site(chromium, url) as view:
            await view.tab.evaluate(CONNECT, characteristics)
            await view.until("Object.keys(solepath.state.links).length === 2", patience=PATIENCE)
            [worker] = view.tab.workers
            await worker.evaluate(MEASURE, await view.tab.evaluate("began"))
            await view.tab.evaluate(WALK, {"seconds": 5.0, "stream": INSOLE.streams[0]})  # everything is loaded now
            await worker.evaluate("() => { self.delays = []; }")
            heap, _ = await view.memory()
            used, frames = await processor_time(browser), await view.tab.evaluate("solepath.frames")
            fed = await view.tab.evaluate(WALK, {"seconds": seconds, "stream": INSOLE.streams[0]})
            used, frames = await processor_time(browser) - used, await view.tab.evaluate("solepath.frames") - frames
            await asyncio.sleep(0.5)
            delays = await worker.evaluate(DELAYS)
            later, _ = await view.memory()
            strides = await view.tab.evaluate("['left', 'right'].map((foot) => solepath.state.feet[foot].strides)")
    print(f"{fed} frames in {seconds:.0f} s, {frames / seconds:.0f} pictures a second, strides {strides}")
    print(
        f"from arrival to events: median {delays[len(delays) // 2]:.1f} ms, "
        f"p99 {delays[int(0.99 * len(delays))]:.1f} ms, at most {delays[-1]:.1f} ms"
    )
    print(f"processor time of the page: {100.0 * used / seconds:.0f} % of one core")
    print(f"memory of the page's scripts: {heap / 1e6:.1f} MB at first, {later / 1e6:.1f} MB at the end")


def main() -> int:
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--minutes", metavar="N", type=float, default=1.0)
    seconds = MINUTE * options.parse_args().minutes
    reason = why_not()
    if reason is not None:
        print(reason)
        return 2
    print(f"{os.cpu_count()} processors, load {os.getloadavg()[0]:.1f}")
    with TemporaryDirectory() as directory, browsing() as browser:
        site = Path(directory, "site")
        build_site(site, emulate(Route().stand(2.0).walk(SPEED * (seconds + 10.0), SPEED).stop(1.0)).packets)
        browser.run(lambda chromium: measure(chromium, site, seconds), seconds + 2.0 * MINUTE)
    return 0


if __name__ == "__main__":
    sys.exit(main())
