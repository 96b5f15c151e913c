"""Measures the cost of the page: `python tests/bench/page.py [--minutes 10]`. Prints tables; asserts nothing.

A separate process feeds a session with two insoles of 96 cells at 100 Hz, in real time. There are four cases: no page,
a page without a client, a page in a browser (Chromium, 1280 x 900), and a page whose client has stopped reading. Each
takes `--minutes`. The share of a core is the processor time of that process from the first packet to the last. It
includes the page's server and not the browser.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import os
import platform
import re
import socket
import subprocess
import sys
from collections.abc import Iterator
from contextlib import AsyncExitStack, contextmanager
from pathlib import Path
from statistics import median, quantiles
from time import process_time
from urllib.parse import urlsplit

HELPERS = Path(__file__).parents[1] / "helpers"
sys.path[:0] = [str(HELPERS), str(HELPERS / "page")]

from attrs import define, field  # noqa: E402
from browsers import Browser, Browsing, Window, browsing, program, why_not, window  # noqa: E402
from shown import squares, walked  # noqa: E402

from solepath import Session  # noqa: E402
from solepath.show.page.scene.scene import Scene  # noqa: E402
from solepath.show.page.server.server import Page  # noqa: E402

CASES = {
    "without": "no page",
    "alone": "a page, nobody watching",
    "browser": "a browser",
    "stalled": "a watcher that reads nothing",
}
MINUTE = 60.0
SQUARE_DURATION = 40.0
"""Shortest time in which the emulated wearer walks a square, s."""
SETTLING_MINUTES = 1.0
"""Time from the start to the first measurement of the page's memory, minutes."""


async def serve(case: str, seconds: float) -> None:
    """Print the page's address, wait for a line, feed the session, and print the processor time in s."""
    packets = [packet for packet in walked(squares(int(seconds / SQUARE_DURATION) + 1)) if packet.t <= seconds]
    page = None if case == "without" else Page(Scene("a walk of the benchmark", "default", "live"), port=0)
    session = Session(poses=True) if page is None else Session(poses=True, pressures=True)
    loop = asyncio.get_running_loop()
    async with AsyncExitStack() as stack:
        if page is not None:
            await stack.enter_async_context(page)
        print("" if page is None else page.url, flush=True)
        await loop.run_in_executor(None, sys.stdin.readline)
        started_at, used = loop.time(), process_time()
        for packet in packets:
            wait = started_at + packet.t - loop.time()
            if wait > 0.0:
                await asyncio.sleep(wait)
            events = session.feed(packet)
            if page is not None:
                page.scene.take(packet, events)
        print(json.dumps(process_time() - used), flush=True)


@contextmanager
def serving(case: str, seconds: float) -> Iterator[subprocess.Popen[str]]:
    command = [sys.executable, __file__, "--serve", case, "--minutes", str(seconds / MINUTE)]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as process:
        try:
            yield process
        finally:
            process.kill()


@define
class BrowserMeasurements:
    """The measurements of a browser.

    `early` and `late` are the bytes of the scripts' heap, the elements of the document and the bytes of the process,
    after SETTLING_MINUTES and at the end.
    """

    sizes: list[int] = field(factory=list)
    """Sizes of the received messages, bytes."""
    frame_rate: float = 0.0
    """Frames a second."""
    work_share: float = 0.0
    """Share of the time in which the page's thread works."""
    early: tuple[int, int, int] | None = None
    late: tuple[int, int, int] = (0, 0, 0)


def watch(browser: Browsing, url: str, process: subprocess.Popen[str], seconds: float) -> BrowserMeasurements:
    async def main(chromium: Browser) -> BrowserMeasurements:
        measurements = BrowserMeasurements()
        async with window(chromium, "about:blank") as view:
            view.tab.on(
                "websocket", lambda link: link.on("framereceived", lambda data: measurements.sizes.append(len(data)))
            )
            await view.devtools.send("Performance.enable")
            await view.tab.goto(url)
            await asyncio.sleep(1.0)
            start(process)
            measurements.sizes.clear()
            worked, n_frames, spent = await work_time(view), await frames(view), 0.0
            if seconds > SETTLING_MINUTES * MINUTE:
                spent = SETTLING_MINUTES * MINUTE
                await asyncio.sleep(spent)
                measurements.early = (*await view.memory(), await resident(chromium))
            await asyncio.sleep(seconds - 1.0 - spent)
            measurements.frame_rate = (await frames(view) - n_frames) / (seconds - 1.0)
            measurements.work_share = (await work_time(view) - worked) / (seconds - 1.0)
            measurements.late = (*await view.memory(), await resident(chromium))
            return measurements

    return browser.run(main, longest=seconds + 2.0 * MINUTE)


async def frames(view: Window) -> int:
    """Return the number of frames that the page has drawn."""
    count: int = await view.tab.evaluate("solepath.frames")
    return count


async def work_time(view: Window) -> float:
    """Return the time for which the page's thread has worked, s."""
    metrics = (await view.devtools.send("Performance.getMetrics"))["metrics"]
    return next(float(metric["value"]) for metric in metrics if metric["name"] == "TaskDuration")


async def resident(browser: Browser) -> int:
    """Return the memory of the browser's page processes, bytes, with their part of memory shared with other processes.

    It is 0 where the system does not report it.
    """
    devtools = await browser.new_browser_cdp_session()
    processes = (await devtools.send("SystemInfo.getProcessInfo"))["processInfo"]
    await devtools.detach()
    files = [Path(f"/proc/{one['id']}/smaps_rollup") for one in processes if one["type"] == "renderer"]
    shares = [re.search(r"^Pss: +(\d+) kB", file.read_text(), re.MULTILINE) for file in files if file.exists()]
    return 1024 * sum(int(share[1]) for share in shares if share)


def start(process: subprocess.Popen[str]) -> None:
    assert process.stdin is not None
    print(file=process.stdin, flush=True)


def stall(url: str) -> socket.socket:
    """Return the socket of a client that requests the events of the page and reads nothing."""
    parts = urlsplit(url)
    token = parts.fragment.removeprefix("token=")
    link = socket.socket()
    link.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
    link.connect((parts.hostname, parts.port))
    link.sendall(
        f"GET /ws?token={token} HTTP/1.1\r\nHost: {parts.netloc}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
        "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: c29sZXBhdGggYmVuY2gxMg==\r\n\r\n".encode()
    )
    return link


def spent(process: subprocess.Popen[str]) -> float:
    assert process.stdout is not None
    return float(json.loads(process.stdout.readline()))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--minutes", type=float, default=1.0, help="of each of the four (default: 1)")
    parser.add_argument("--serve", choices=CASES, help=argparse.SUPPRESS)
    options = parser.parse_args()
    seconds = options.minutes * MINUTE
    if options.serve is not None:
        asyncio.run(serve(options.serve, seconds))
        return
    reason = why_not()
    if reason is not None:
        sys.exit(reason)
    print(f"Python {platform.python_version()}, {os.cpu_count()} cores, {program()}; {options.minutes:g} min each\n")
    print(f"{'the session with':30} {'of a core':>10} {'extra':>8}")
    base_share: float | None = None
    measurements = BrowserMeasurements()
    for case, name in CASES.items():
        with serving(case, seconds) as process:
            assert process.stdout is not None
            url = process.stdout.readline().strip()
            if case == "browser":
                with browsing() as browser:
                    measurements = watch(browser, url, process, seconds)
                    share = spent(process) / seconds
            else:
                stalled_link = stall(url) if case == "stalled" else None
                start(process)
                share = spent(process) / seconds
                if stalled_link is not None:
                    stalled_link.close()
        base_share = share if base_share is None else base_share
        print(f"{name:30} {100 * share:8.1f} % {100 * (share - base_share):6.1f} %", flush=True)
    sizes = measurements.sizes
    print(
        f"\nthe page draws {measurements.frame_rate:.1f} frames a second; "
        f"its thread works {100 * measurements.work_share:.0f} % of the time"
    )
    print(
        f"{len(sizes) / seconds:.1f} messages a second, {sum(sizes) / seconds / 1000:.1f} kB/s; "
        f"bytes of one: median {median(sizes):.0f}, p99 {quantiles(sizes, n=100)[98]:.0f}, most {max(sizes)}"
    )
    for when, memory in ((SETTLING_MINUTES, measurements.early), (options.minutes, measurements.late)):
        if memory is not None:
            heap, elements, process = memory
            print(
                f"after {when:g} min its scripts hold {heap / 1e6:.2f} MB, its document {elements} elements, "
                f"its process {process / 1e6:.0f} MB"
            )


if __name__ == "__main__":
    main()
