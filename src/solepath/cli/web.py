"""`solepath web`: writes the page as a static site, in which the library runs in the browser, and shows it."""

from __future__ import annotations

import sys
from argparse import Namespace
from collections.abc import Mapping
from contextlib import ExitStack
from pathlib import Path
from tempfile import TemporaryDirectory
from time import sleep

from ..show.tables.table import number, table
from .common.failure import Failure, note, parse_port, reject_options, tell
from .common.os_errors import address_error_text
from .common.parser import command, option
from .common.view import open_browser

DEFAULT_PORT = 8766
CLOCK_INTERVAL = 0.2
"""Time between two looks at whether the command was stopped, s."""
LISTED = 5
"""Number of the largest files that are named with their sizes."""


def run(options: Namespace) -> int:
    """Write the site, and show it; return the exit status."""
    from ..emulate import emulate
    from ..emulate.demo import SITE_ROUTE
    from ..show.tables.progress import progress_bar
    from ..show.web.site import build_site

    if not options.serve:
        reject_options(options, ("port", "no_browser"), "is for --serve")
        if options.out is None:
            raise Failure("name the folder of the site, or show it with --serve")
    if options.out is not None and options.out.exists() and not options.out.is_dir():
        raise Failure(f"{options.out}: is a file; the site needs a folder")
    with ExitStack() as stack:
        out = options.out or Path(stack.enter_context(TemporaryDirectory()), "site")
        print("building the site: about half a minute ...", flush=True)
        with progress_bar("step 1 of 2, a walk to show"):
            packets = [*emulate(SITE_ROUTE).packets]
        with progress_bar("step 2 of 2, the library for browsers"):
            files = build_site(out, packets)
        print(size_table(files), flush=True)
        if options.out is not None:
            tell(f"the site is in {out}")
        if options.serve:
            _serve(out, options)
    return 0


def size_table(files: Mapping[str, bytes]) -> str:
    """Return a table of the largest files of a site and of all together: raw, and as a server sends them."""
    from ..show.web.site import compressed_size

    sizes = {name: (len(data), compressed_size(data)) for name, data in files.items()}
    largest = sorted(sizes, key=lambda name: -sizes[name][1])[:LISTED]
    totals = [sum(column) for column in zip(*sizes.values(), strict=True)]
    rows = [*[(name, sizes[name]) for name in largest], (f"all {len(sizes)} files", totals)]
    return table(["file", "MB", "gzip MB"], [[name, *[number(size / 1e6) for size in both]] for name, both in rows])


def _serve(folder: Path, options: Namespace) -> None:
    from ..show.web.serve import serving
    from .common.loop import stop_flag

    port = DEFAULT_PORT if options.port is None else options.port
    with stop_flag() as stop_requested, ExitStack() as stack:
        try:
            address = stack.enter_context(serving(folder, port))
        except OSError as error:
            raise Failure(f"--port {port}: {address_error_text(error)}") from None
        print(f"the site: {address}", flush=True)
        note("only this machine can reach it; a phone needs the files on a server with https (docs/browser.md)")
        if sys.stdout.isatty() and not options.no_browser:
            open_browser(address)
        print("Ctrl-C ends it", flush=True)
        while not stop_requested():
            sleep(CLOCK_INTERVAL)


add_web = command(
    "web",
    "Write the page as a folder of static files. Python runs in the browser (Pyodide, fetched once "
    "from the npm registry and checked), so that any web server with https can serve it, and a phone can use it "
    "offline.",
    "solepath web site --serve",
    option("out", metavar="OUT", type=Path, nargs="?", help="folder of the site; files of an earlier one are replaced"),
    option("--serve", action="store_true", help="show the site on this machine"),
    option("--port", metavar="N", type=parse_port, help=f"port of --serve (default: {DEFAULT_PORT}; 0: any)"),
    option("--no-browser", action="store_true", help="open no browser: only say where the site is"),
    run=run,
)
