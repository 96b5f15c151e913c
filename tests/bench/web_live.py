"""Measures a live walk on the site of `solepath web` in Chromium: `python tests/bench/web_live.py`.

Two insoles of 96 cells at 100 Hz come in real time, for a minute or `--minutes N`, into a window of 360 px that is
drawn all the while, and then as long into the page while it is hidden. Printed are the delay from the arrival of a
frame in the page until its events are computed; the processor time of the worker, which is all that solepath
computes, and of the page, which is its scripts and drawing; and the memory of both at the start and at the end. The
frames come from a script of the page, whose time counts as the page's, and not over Bluetooth: what the radio and the
browser's Bluetooth add is not measured. The page is not hidden, but believes that it is. Times and memory of processes
are those that Linux has (/proc)."""

from __future__ import annotations

import argparse
import asyncio
import os
import sys
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

sys.path[:0] = [str(Path(__file__).parents[1] / "helpers" / folder) for folder in ("", "page")]

from browsers import Browser, Window  # noqa: E402
from scripted_sensors import STREAM, WALK, connect  # noqa: E402
from web_pages import measure_site, open_site  # noqa: E402

from solepath.emulate import Route, emulate  # noqa: E402
from solepath.show.web.serve import serving  # noqa: E402

MINUTE = 60.0
SPEED = 1.3
"""Walking speed, m/s."""
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
HIDE = """() => {
    Object.defineProperty(document, 'hidden', { get: () => true });
    document.dispatchEvent(new Event('visibilitychange'));
}"""
WARM_UP = 5.0
"""Time of the walk before anything is measured, s: everything is loaded and compiled then."""
DELAYS = "() => self.delays.sort((one, other) => one - other)"


def renderers() -> Iterator[Path]:
    """Yield the folders in /proc of the processes that show pages."""
    for process in Path("/proc").iterdir():
        with suppress(OSError):  # a process that has just ended
            if process.name.isdigit() and b"--type=renderer" in (process / "cmdline").read_bytes():
                yield process


def processor_times() -> dict[str, float]:
    """Return the processor time of the workers and of all else of the browser's renderers, s."""
    times = {"worker": 0.0, "page": 0.0}
    for process in renderers():
        for thread in (process / "task").iterdir():
            words = (thread / "stat").read_text().rpartition(")")[2].split()
            who = "worker" if (thread / "comm").read_text().startswith("DedicatedWorker") else "page"
            times[who] += sum(map(int, words[11:13])) / os.sysconf("SC_CLK_TCK")  # utime, stime: proc(5)
    return times


async def memory(view: Window) -> str:
    """Return how much the page's scripts hold after a garbage collection, and its process with the worker in it."""
    heap, _ = await view.memory()
    resident = sum(int((process / "statm").read_text().split()[1]) for process in renderers())
    return (
        f"scripts of the page {heap / 1e6:.1f} MB, whole process {resident * os.sysconf('SC_PAGE_SIZE') / 1e6:.0f} MB"
    )


async def walk(view: Window, seconds: float) -> None:
    """Let both insoles send for a time, and print what it cost."""
    [worker] = view.tab.workers
    await worker.evaluate("() => { self.delays = []; }")
    before, frames = processor_times(), await view.tab.evaluate("solepath.frames")
    fed = await view.tab.evaluate(WALK, {"seconds": seconds, "stream": STREAM})
    after, frames = processor_times(), await view.tab.evaluate("solepath.frames") - frames
    await asyncio.sleep(0.5)
    delays = await worker.evaluate(DELAYS)
    print(f"  {fed} frames of sensors in {seconds:.0f} s, {frames / seconds:.0f} pictures a second")
    print(
        f"  from arrival to events: median {delays[len(delays) // 2]:.1f} ms, "
        f"p99 {delays[int(0.99 * len(delays))]:.1f} ms, at most {delays[-1]:.1f} ms"
    )
    shares = {who: 100.0 * (after[who] - before[who]) / seconds for who in before}
    print(f"  processor time: worker {shares['worker']:.0f} %, page {shares['page']:.0f} % of one core")


async def measure(chromium: Browser, folder: Path, seconds: float) -> None:
    with serving(folder) as url:
        async with open_site(chromium, url, still=False) as view:
            await connect(view)
            await view.tab.workers[0].evaluate(MEASURE, await view.tab.evaluate("began"))
            await view.tab.evaluate(WALK, {"seconds": WARM_UP, "stream": STREAM})
            print(f"the page is seen:\n  memory at first: {await memory(view)}")
            await walk(view, seconds)
            print(f"  memory at the end: {await memory(view)}")
            strides = await view.tab.evaluate("['left', 'right'].map((foot) => solepath.state.feet[foot].strides)")
            print(f"  strides {strides}")
            await view.tab.evaluate(HIDE)
            print("the page is hidden:")
            await walk(view, seconds)
            print(f"  memory at the end: {await memory(view)}")


def main() -> int:
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--minutes", metavar="N", type=float, default=1.0)
    seconds = MINUTE * options.parse_args().minutes
    packets = emulate(Route().stand(2.0).walk(SPEED * (2.0 * seconds + 10.0), SPEED).stop(1.0)).packets
    return measure_site(packets, lambda chromium, folder: measure(chromium, folder, seconds), 2.0 * (seconds + MINUTE))


if __name__ == "__main__":
    sys.exit(main())
