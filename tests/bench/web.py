"""Measures the site of `solepath web` in Chromium: `python tests/bench/web.py`. Prints sizes, starts and computing.

The site is built, opened, opened again, and opened without its server. Then the demonstration is computed from its
start to its end, and a walk is saved. Times depend on the machine; the line about it says how loaded it was."""

from __future__ import annotations

import os
import sys
from contextlib import ExitStack
from pathlib import Path
from tempfile import TemporaryDirectory
from time import monotonic

sys.path[:0] = [str(Path(__file__).parents[1] / "helpers" / folder) for folder in ("", "page")]

from browsers import Browser, browsing, why_not  # noqa: E402
from web_pages import PATIENCE, open_site, ready  # noqa: E402

from solepath.cli.web import size_lines  # noqa: E402
from solepath.emulate import emulate  # noqa: E402
from solepath.emulate.demo import SITE_ROUTE  # noqa: E402
from solepath.show.web.serve import serving  # noqa: E402
from solepath.show.web.site import build_site  # noqa: E402

STARTS = 3
"""Number of starts without the server, of which all are printed."""
COMPUTE = """async () => {
    const seek = document.getElementById('seek');
    const start = performance.now();
    seek.value = seek.max;
    seek.dispatchEvent(new Event('change'));
    while (solepath.state.playback.state !== 'ended') await new Promise((resolve) => setTimeout(resolve, 20));
    return (performance.now() - start) / 1000;
}"""


async def measure(chromium: Browser, folder: Path) -> None:
    """Open the site in one window after the other, and print how long each step takes."""
    with ExitStack() as server:
        url = server.enter_context(serving(folder))
        started = monotonic()
        async with open_site(chromium, url, still=False) as view:
            print(f"first start: {monotonic() - started:.1f} s")
            await view.until("navigator.serviceWorker.controller !== null", patience=PATIENCE)
            started = monotonic()
            await view.tab.reload()
            await ready(view)
            print(f"second start: {monotonic() - started:.1f} s")
            server.close()
            for _ in range(STARTS):
                started = monotonic()
                await view.tab.reload()
                await ready(view)
                print(f"start without the server: {monotonic() - started:.1f} s")
            await view.tab.locator("#demo").click()
            await view.until("solepath.state.playback !== null", patience=PATIENCE)
            seconds = await view.tab.evaluate(COMPUTE)
            length = await view.tab.evaluate("solepath.state.playback.end - solepath.state.playback.start")
            print(f"the demonstration of {length:.0f} s computed in {seconds:.1f} s, drawn meanwhile")


def main() -> int:
    """Run the command and return its exit status."""
    reason = why_not()
    if reason is not None:
        print(reason)
        return 2
    print(f"{os.cpu_count()} processors, load {os.getloadavg()[0]:.1f}")
    with TemporaryDirectory() as directory, browsing() as browser:
        started = monotonic()
        files = build_site(Path(directory, "site"), emulate(SITE_ROUTE).packets)
        print(f"built in {monotonic() - started:.0f} s")
        print("\n".join(size_lines(files)))
        browser.run(lambda chromium: measure(chromium, Path(directory, "site")))
    return 0


if __name__ == "__main__":
    sys.exit(main())
