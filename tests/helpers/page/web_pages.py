"""Opens the static site in the browser."""

from __future__ import annotations

import gzip
import os
from collections.abc import AsyncIterator, Awaitable, Callable, Iterable
from contextlib import asynccontextmanager
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

from browsers import Browser, Window, browsing, why_not, window
from plain_tabs import PlainTab

from solepath import Packet, Session
from solepath.recording import read_packets
from solepath.show.page.scene.scene import Scene
from solepath.show.web.site import build_site

READY = "document.getElementById('site')?.dataset.ready === 'true' && computer.state === 'ready'"
WORDS = "document.getElementById('site-words').textContent"


@asynccontextmanager
async def open_site(chromium: Browser, url: str, *, script: str = "", still: bool = True) -> AsyncIterator[Window]:
    """Yield a window with the site, ready; at the end it must have requested nothing but files of its own origin."""
    async with window(chromium, url, width=360, script=script, still=still) as view:
        await ready(view)
        yield view
        foreign = [one for one in view.requests if not one.removeprefix("blob:").startswith(url)]
        assert not foreign, foreign


async def ready(view: Window | PlainTab) -> None:
    """Wait until Python runs in the page; the module computer.js is then the page's variable `computer`."""
    await view.tab.evaluate("import('./computer.js').then((m) => { globalThis.computer = m.computer; })")
    await view.until(READY)


def measure_site(packets: Iterable[Packet], measure: Callable[[Browser, Path], Awaitable[None]]) -> int:
    """Build a site with this recording and measure it in a new browser; return the exit status."""
    reason = why_not()
    if reason is not None:
        print(reason)
        return 2
    print(f"{os.cpu_count()} processors, load {os.getloadavg()[0]:.1f}")
    with TemporaryDirectory() as directory, browsing() as browser:
        folder = Path(directory, "site")
        build_site(folder, packets)
        browser.run(lambda chromium: measure(chromium, folder))
    return 0


@cache
def demo_packets(site: Path) -> tuple[Packet, ...]:
    """Return the packets of the recording that comes with the site."""
    path = site.parent / "demo.jsonl"
    path.write_bytes(gzip.decompress((site / "demo.jsonl.gz").read_bytes()))
    return tuple(read_packets(path))


def scene_of(packets: tuple[Packet, ...]) -> Scene:
    """Return the scene after all these packets and the end of the session."""
    session, scene = Session(poses=True, pressures=True, losses=True), Scene("", "default")
    for packet in packets:
        scene.take(packet, session.feed(packet))
    scene.take(None, session.finish())
    return scene
