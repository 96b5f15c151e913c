"""Measures the site of `solepath web` in Chromium: `python tests/bench/web.py`. Prints sizes, starts and computing.

The site is built, opened, opened again, and opened without its server. Then the demonstration is computed from its
start to its end. Times depend on the machine; the first line says how loaded it was."""

from __future__ import annotations

import sys
from contextlib import ExitStack
from pathlib import Path
from time import monotonic

sys.path[:0] = [str(Path(__file__).parents[1] / "helpers" / folder) for folder in ("", "page")]

from browsers import Browser  # noqa: E402
from web_pages import measure_site, open_site, ready  # noqa: E402

from solepath.cli.web import size_table  # noqa: E402
from solepath.emulate import emulate  # noqa: E402
from solepath.emulate.demo import SITE_ROUTE  # noqa: E402
from solepath.show.web.serve import serving  # noqa: E402

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
    """Print the sizes of the site, open it in one window after the other, and print how long each step takes."""
    print(size_table({path.name: path.read_bytes() for path in folder.iterdir()}))
    with ExitStack() as server:
        url = server.enter_context(serving(folder))
        started = monotonic()
        async with open_site(chromium, url, still=False) as view:
            print(f"first start: {monotonic() - started:.1f} s")
            await view.until("navigator.serviceWorker.controller !== null")
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
            await view.until("solepath.state.playback !== null")
            seconds = await view.tab.evaluate(COMPUTE)
            length = await view.tab.evaluate("solepath.state.playback.end - solepath.state.playback.begin")
            print(f"the demonstration of {length:.0f} s computed in {seconds:.1f} s, drawn meanwhile")


def main() -> int:
    """Run the command and return its exit status."""
    return measure_site(emulate(SITE_ROUTE).packets, measure)


if __name__ == "__main__":
    sys.exit(main())
