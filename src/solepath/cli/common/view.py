"""Defines the options of the page in a browser, and serves it while a command runs."""

from __future__ import annotations

import os
import sys
from argparse import Namespace
from collections.abc import AsyncIterator, Callable, Iterator
from contextlib import AsyncExitStack, asynccontextmanager, contextmanager
from itertools import count
from typing import TYPE_CHECKING

from attrs import frozen

from ...recording import printable
from .failure import PAGE_ADDRESS, Failure, has_terminal, note, parse_address, parse_positive, reject_options, require
from .os_errors import address_error_text
from .parser import Option, option

if TYPE_CHECKING:
    from ...show.page.messages import Command
    from ...show.page.player.player import Player
    from ...show.page.scene.scene import Scene
    from ...show.page.server.server import Page

DEFAULT_PAGE = ("127.0.0.1", None)
"""Host of the page where none is named, and its port: None for the usual one, or another when that is taken."""
ITEMS_PER_UPDATE = 1000
"""Number of items (packets or samples) between two updates of the progress."""


@frozen
class PageAddress:
    """The address at which the page is served; `browser` is true if a browser is opened, `port` None if not named."""

    host: str = "127.0.0.1"
    port: int | None = None
    browser: bool = False


def view_option(what: str) -> Option:
    """Return --view; `what` says what it does, such as "play it"."""
    return option(
        "--view",
        metavar="HOST:PORT",
        nargs="?",
        const=(),
        type=parse_address,
        help=f"{what} on a page in the browser, served there (default: {PAGE_ADDRESS}, or another port when that is "
        "taken; port 0: any that is free)",
    )


add_no_browser = option("--no-browser", action="store_true", help="open no browser: only say where the page is")
"""--no-browser, which goes with --view."""


def speed_option(default: str) -> Option:
    """Return --speed."""
    return option("--speed", metavar="X", type=parse_positive, help=f"times real time (default: {default})")


def page_address_of(options: Namespace) -> PageAddress | None:
    """Return the address of --view, None without it.

    Failure is raised when it is malformed or in use, when aiohttp is not installed, or for an option of the page
    without --view."""
    if options.view is None:
        reject_options(options, ("speed", "no_browser"), "is for the page: it goes with --view")
        return None
    browser = sys.stdout.isatty() and not options.no_browser
    host, port = options.view or DEFAULT_PAGE
    address = PageAddress(host, port, browser)
    require("--view needs", "view", "aiohttp")
    from ...show.page.server.access import listen

    with _naming(address):  # before a long recording is read
        listen(address.host, address.port).close()
    return address


@contextmanager
def _naming(address: PageAddress) -> Iterator[None]:
    """Raise Failure, with the reason, if the page cannot be served at the address."""
    try:
        yield
    except (OSError, UnicodeError) as error:
        reason = "there is no such host" if isinstance(error, UnicodeError) else address_error_text(error)
        raise Failure(f"--view {printable(address.host, 80)}:{address.port or 0}: {reason}") from None


def speed_of(options: Namespace, default: float) -> float:
    """Return --speed for the page, in multiples of real time; raise Failure when it is out of the player's range."""
    from ...show.page.messages import MAX_SPEED, MIN_SPEED

    if options.speed is None:
        return default
    if not MIN_SPEED <= options.speed <= MAX_SPEED:
        raise Failure(f"--speed {options.speed:g}: on the page it is from {MIN_SPEED:g} to {MAX_SPEED:g}")
    return float(options.speed)


@asynccontextmanager
async def serve_page(
    scene: Scene, address: PageAddress, commands: Callable[[Command], None] | None = None
) -> AsyncIterator[Page]:
    """Serve the page, print its address, and open a browser if one is requested and present.

    Failure is raised when the page cannot be served at that address."""
    import asyncio

    from ...show.page.server.access import on_loopback
    from ...show.page.server.server import Page

    async with AsyncExitStack() as stack:
        with _naming(address):
            page = await stack.enter_async_context(Page(scene, host=address.host, port=address.port, commands=commands))
        print(f"the page: {page.url}", flush=True)
        if not on_loopback(address.host):
            note("the page can be reached from other machines: whoever has this address with its token sees it")
        if address.browser:
            await asyncio.to_thread(open_browser, page.url)
        yield page


def play(player: Player, address: PageAddress, pace: float, what: str) -> None:
    """Play `player` on a page, at `pace` times real time, until Ctrl-C; without a terminal until the recording ends.

    The rest is computed then, so that `on_events` gets all items; `what` names it, such as "walk"."""
    import asyncio

    from ...show.page.player.player_loop import play_on
    from .loop import run_to_end

    async def main(stop: asyncio.Event) -> int:
        once = not has_terminal()
        async with serve_page(player.scene, address, player.command) as page:
            if not once:
                print("Ctrl-C ends it", flush=True)
            await play_on(page, player, stop, once=once)
        return 0

    player.playback.speed = pace
    if len(player.items):
        run_to_end(main)
    _compute_rest(player, what)


def _compute_rest(player: Player, what: str) -> None:
    """Compute what was not played; another Ctrl-C raises KeyboardInterrupt, between two items."""
    from ...show.tables.progress import progress_bar
    from .loop import stop_flag

    items = player.items
    remaining = len(items) - player.delivered_count
    with progress_bar("computing", len(items)) as show, stop_flag() as stop_requested:
        if remaining > 0:
            print(f"the rest of the {what}, as fast as it can be computed; Ctrl-C again gives it up ...", flush=True)
        counter = count(1)
        while player.run_through(lambda: next(counter) % ITEMS_PER_UPDATE == 0 or stop_requested()):
            show(player.delivered_count)
            if stop_requested():
                t = items.t(player.delivered_count - 1) if player.delivered_count else items.start
                note(
                    f"given up after {t - items.start:.1f} of {items.end - items.start:.1f} s: nothing is summed up "
                    "or written, and what was written before stays as it is"
                )
                raise KeyboardInterrupt


def open_browser(url: str) -> None:
    """Open a graphical browser, if there is one; one in the terminal would hide this command's output."""
    import webbrowser

    variables = ("DISPLAY", "WAYLAND_DISPLAY", "BROWSER")
    has_browser = sys.platform in ("darwin", "win32") or any(map(os.environ.get, variables))
    if has_browser and not webbrowser.open(url):
        note("no browser could be opened: open the address yourself")
