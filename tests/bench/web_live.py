"""Measures a live walk on the site, in real time: `python tests/bench/web_live.py [--seconds 60] [--walks 1]`.

It asserts nothing. The site is built and opened in Chromium, in the size of a phone. Two insoles of 96 cells at 100 Hz
walk: another worker of the page hands it each frame at its time, in place of a notification, since Chromium's emulation
of Bluetooth is too slow for 200 frames a second. A share is the processor time of a thread by the system, of one core;
a wake-up is a time at which the thread went to sleep by itself. The delay of a frame goes from its arrival at the page
to the moment at which its events are there, in the worker. A person can use the first screen who can choose a sensor.
"""

from __future__ import annotations

import argparse
import asyncio
import os
import re
import sys
from base64 import b64encode
from contextlib import ExitStack
from pathlib import Path
from statistics import median, quantiles
from tempfile import TemporaryDirectory
from time import monotonic
from typing import Any

HELPERS = Path(__file__).parents[1] / "helpers"
sys.path[:0] = [str(HELPERS), str(HELPERS / "page")]

from attrs import frozen  # noqa: E402
from browsers import Browser, Window, browsing, program, why_not, window  # noqa: E402
from measure import machine  # noqa: E402
from scripted_sensors import connect  # noqa: E402
from web_pages import ready  # noqa: E402
from yardstick import UsualFilter  # noqa: E402

from bench import time_each  # noqa: E402
from page import frames, resident  # noqa: E402
from solepath.emulate import Walker, emulate  # noqa: E402
from solepath.emulate.demo import SITE_ROUTE  # noqa: E402
from solepath.emulate.routes.route import Route  # noqa: E402
from solepath.emulate.sensors.parts import LSM6DSOX  # noqa: E402
from solepath.link.devices.insole import PROFILE as INSOLE  # noqa: E402
from solepath.show.web.serve import serving  # noqa: E402
from solepath.show.web.site import build_site  # noqa: E402
from solepath.types import Foot  # noqa: E402

PHONE = {"width": 390, "height": 844}
STARTS = 3
"""Number of first starts and of starts without a network."""
STANDING = 4.0
"""Time for which the wearer stands before the walk, s."""
SETTLING = 12.0
"""Time from the start of the walk to the first measurement, s."""
SPEED = 1.3
"""Speed of the wearer, m/s."""
WALKING = "['left', 'right'].every((foot) => (solepath.state.feet[foot]?.strides ?? 0) >= 4)"
USABLE = "!document.getElementById('connect').disabled && document.getElementById('connect').offsetWidth > 0"
SHIFTS = """globalThis.shifts = [];
new PerformanceObserver((list) => shifts.push(...list.getEntries().map((one) => one.value)))
    .observe({ type: 'layout-shift', buffered: true });"""
WORKER = "DedicatedWorker"
"""Beginning of the name of a worker's thread in Chromium; the earlier one computes, the later one is the sensors'."""
LEAST_SHARE = 0.005
"""Share of a core from which on another thread is printed."""
BEGAN = "import('./live.js').then(({ clock }) => (performance.timeOrigin + performance.now()) / 1000 - clock())"
HAND_OVER = """async ([rows, stream]) => {
    const { notified } = await import('./live.js');
    const send = () => (onmessage = ({ data: rows }) => {
        let [began, next] = [0, 0];
        const go = () => {
            const t = performance.now() - began;
            for (; next < rows.length && rows[next][0] <= t; next += 1) postMessage(rows[next]);
            if (next < rows.length) setTimeout(go, rows[next][0] - t);
        };
        onmessage = () => go((began = performance.now()));
        postMessage(null);
    });
    const source = (globalThis.source = new Worker(URL.createObjectURL(new Blob([`(${send})()`]))));
    const bytes = (text) => new DataView(Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0)).buffer);
    source.postMessage(rows.map(([t, device, text]) => [t, device, bytes(text)]));
    await new Promise((resolve) => (source.onmessage = resolve));
    source.onmessage = ({ data: [, device, bytes] }) => notified(device, stream, bytes);
    const sensors = ['left_foot', 'right_foot'].map((name) => [name, { name, words: name, connected: true }]);
    computer.emit('sensors', new Map(sensors));
}"""
"""Hands the frames [ms, device, bytes] to a worker, which will send each to the page at its time after a message.

The page takes the devices for sensors that are connected."""
STAMP = """async ([base, began]) => {
    const { Walk } = await import(new URL('walk.js', base).href);
    const receive = Walk.prototype.receive;
    globalThis.delays = [];
    globalThis.posts = [];
    Walk.prototype.receive = function (messages) {
        if (!globalThis.python) (globalThis.python = this.python.runtime).runPython(TIMED);
        const started = performance.now();
        const answers = receive.call(this, messages);
        posts.push(performance.now() - started);
        const now = (performance.timeOrigin + performance.now()) / 1000 - began;
        for (const { values = [] } of messages) for (const [t] of values) delays.push(1000 * (now - t));
        return answers;
    };
}"""
"""Notes in the worker the delay of each frame, ms, and how long each message of the page takes until its events, ms.

TIMED is replaced by the Python that notes how long the session takes for each frame, ms."""
TIMED = """
import json
from time import perf_counter
from solepath import Session
feed, taken = Session.feed, []
def timed(session, packet):
    started = perf_counter()
    events = feed(session, packet)
    if packet.channel == "insole/frame":
        taken.append(1000.0 * (perf_counter() - started))
    return events
Session.feed = timed
"""


@frozen
class Thread:
    """A thread of the page's process: its name, its processor time, s, and the times that it went to sleep."""

    name: str
    used: float
    sleeps: int


def threads(process: int) -> dict[int, Thread]:
    """Return the threads of a process by their number."""
    found = {}
    for task in Path(f"/proc/{process}/task").iterdir():
        used = int((task / "schedstat").read_text().split()[0]) / 1e9
        [sleeps] = re.findall(r"^voluntary_ctxt_switches:\s+(\d+)", (task / "status").read_text(), re.MULTILINE)
        found[int(task.name)] = Thread((task / "comm").read_text().strip(), used, int(sleeps))
    return found


async def page_process(browser: Browser) -> int:
    """Return the process of the page: the one that has a worker and has used most."""
    devtools = await browser.new_browser_cdp_session()
    processes = (await devtools.send("SystemInfo.getProcessInfo"))["processInfo"]
    await devtools.detach()
    return int(max((one for one in processes if one["type"] == "renderer"), key=lambda one: one["cpuTime"])["id"])


async def first_screen(view: Window, load: Any) -> float:
    """Return the time after which a person can choose a sensor, s; wait until all is ready."""
    started_at = monotonic()
    await load
    await view.until(USABLE)
    usable = monotonic() - started_at
    await ready(view)
    return usable


async def time_starts(chromium: Browser, folder: Path) -> None:
    """Print the times of the first screen in a browser that has never seen the site, and without a network."""
    cold, offline = [], []
    for _ in range(STARTS):
        with ExitStack() as server:
            url = server.enter_context(serving(folder))
            async with window(chromium, "about:blank", **PHONE) as view:
                cold.append(await first_screen(view, view.tab.goto(url)))
                await view.until("navigator.serviceWorker.controller !== null")
                server.close()
                await view.tab.reload()
                await ready(view)
                offline.append(await first_screen(view, view.tab.reload()))
    for name, times in (("first start", cold), ("start without a network", offline)):
        print(f"{name}: the first screen can be used after {', '.join(f'{one:.1f}' for one in sorted(times))} s")


async def walk(chromium: Browser, folder: Path, seconds: float) -> None:
    """Print what a walk of so many seconds takes."""
    packets = emulate(Route().stand(STANDING).walk((seconds + 3.0 * SETTLING) * SPEED, SPEED), seed=3).packets
    stream = [packet for packet in packets if packet.channel in INSOLE.streams]
    rows = [[1000.0 * one.t, one.site.value, b64encode(one.data).decode()] for one in stream]
    with serving(folder) as url:
        async with window(chromium, url, script=SHIFTS, **PHONE) as view:
            await ready(view)
            [worker] = view.tab.workers
            await view.tab.evaluate(HAND_OVER, [rows, *INSOLE.streams])
            await connect(view, [packet for packet in packets if packet.channel not in INSOLE.streams], INSOLE)
            await view.tab.evaluate("source.postMessage(null)")
            await worker.evaluate(STAMP.replace("TIMED", f"`{TIMED}`"), [url, await view.tab.evaluate(BEGAN)])
            await view.until(WALKING)
            await asyncio.sleep(SETTLING)
            early = (*await view.memory(), await resident(chromium))
            process = await page_process(chromium)
            await worker.evaluate("delays.length = posts.length = 0, python.runPython('taken.clear()')")
            started_at, drawn, before = monotonic(), await frames(view), threads(process)
            await asyncio.sleep(seconds)
            after, n_drawn = threads(process), await frames(view) - drawn
            passed = monotonic() - started_at
            delays = await worker.evaluate("delays")
            posts = await worker.evaluate("posts")
            decisions = await worker.evaluate("JSON.parse(python.runPython('json.dumps(taken)'))")
            shifts = await view.tab.evaluate("shifts")
            late = (*await view.memory(), await resident(chromium))
    print(f"{'thread':24} {'of a core':>10} {'wake-ups a second':>18}")
    workers = [number for number in sorted(after) if after[number].name.startswith(WORKER)]
    names = {process: "the page's", **dict(zip(workers, ("the worker's", "(the sensors')"), strict=True))}
    for number, one in after.items():
        was = before.get(number, one)
        share, sleeps = (one.used - was.used) / passed, (one.sleeps - was.sleeps) / passed
        name = names.get(number, one.name)
        if number in names or share > LEAST_SHARE:
            print(f"{name:24} {100.0 * share:8.1f} % {sleeps:18.0f}")
    print(f"{n_drawn / passed:.1f} frames a second drawn; sum of layout shifts {sum(shifts):.4f}")
    print(f"{len(delays) / passed:.0f} frames a second received in {len(posts) / passed:.0f} messages")
    print(f"from a frame's arrival to its events: {spread(delays)}")
    print(f"of it, in Python for the frames of a message: {spread(posts)}")
    print(f"of it, the session's decision for one frame: {spread(decisions)}")
    for when, (heap, elements, memory) in (("at the start", early), ("at the end", late)):
        words = f"the page's scripts hold {heap / 1e6:.2f} MB, its document {elements} elements"
        print(f"{when} {words}, its process {memory / 1e6:.0f} MB")


def spread(times: list[float]) -> str:
    cuts = quantiles(times, n=100)
    return f"median {median(times):.1f} ms, p95 {cuts[94]:.1f}, p99 {cuts[98]:.1f}, most {max(times):.0f}"


def yardstick() -> str:
    samples = Walker(Route().stand(2.0).walk(10.0), seed=1).samples(Foot.LEFT, 100.0, LSM6DSOX)
    return f"yardstick {time_each(samples, UsualFilter):.0f} us a sample, load {os.getloadavg()[0]:.1f}"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seconds", type=float, default=60.0, help="of each walk (default: 60)")
    parser.add_argument("--walks", type=int, default=1, help="number of walks (default: 1)")
    parser.add_argument("--site", type=Path, help="a site that is built already")
    parser.add_argument("--no-starts", action="store_true", help="measure walks only")
    options = parser.parse_args()
    reason = why_not()
    if reason is not None:
        sys.exit(reason)
    print(f"{machine()}, {program()}; {yardstick()}")
    with TemporaryDirectory() as directory:
        folder = options.site or Path(directory, "site")
        if options.site is None:
            build_site(folder, emulate(SITE_ROUTE).packets)
        if not options.no_starts:
            with browsing() as browser:
                browser.run(lambda chromium: time_starts(chromium, folder))
        for _ in range(options.walks):
            with browsing() as browser:
                print(f"\n{options.seconds:g} s of walking; {yardstick()}")
                longest = 2.0 * options.seconds + 120.0
                browser.run(lambda chromium: walk(chromium, folder, options.seconds), longest)
    return 0


if __name__ == "__main__":
    sys.exit(main())
