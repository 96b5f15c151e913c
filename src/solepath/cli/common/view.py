"""The page in a browser: its options, and serving it while a command runs."""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import AsyncIterator, Callable
from contextlib import AsyncExitStack, asynccontextmanager
from itertools import count
from typing import TYPE_CHECKING

from attrs import frozen

from ...calibration import Calibration
from ...recording import printable
from ...types import Foot
from .failure import Failure, attended, host_and_port, in_words, need, note, positive

if TYPE_CHECKING:
    from ...show.page.messages import Command
    from ...show.page.player.player import Player
    from ...show.page.scene.scene import Scene
    from ...show.page.server.server import Page

HERE = "127.0.0.1:8765"
LONG = 40_000
"""Number of items from which on there is a progress bar: some seconds of computing."""
ITEMS = 1000
"""Items that are computed between two steps of the progress bar."""


@frozen
class View:
    """Address at which the page is served, and whether a browser is opened; `port` is None when nobody named one."""

    host: str = "127.0.0.1"
    port: int | None = None
    browser: bool = False


def add_view(command: argparse.ArgumentParser, group: argparse._ActionsContainer, what: str) -> None:
    """Add --view, in `group`, and --no-browser to a command; `what` says in a word or two what --view does."""
    group.add_argument(
        "--view",
        metavar="HOST:PORT",
        nargs="?",
        const="",
        help=f"{what} on a page in the browser, served there (default: {HERE}, or another port when that is taken; "
        "port 0: any that is free)",
    )
    command.add_argument("--no-browser", action="store_true", help="open no browser: only say where the page is")


def add_speed(command: argparse.ArgumentParser, default: str) -> None:
    """Add --speed to a command."""
    command.add_argument("--speed", metavar="X", type=positive, help=f"times real time (default: {default})")


def need_page(options: argparse.Namespace, page: bool) -> None:
    """Raise Failure for an option of the page when there is no page."""
    for name in ("speed", "no_browser"):
        if not page and getattr(options, name, None):
            raise Failure(f"--{name.replace('_', '-')} is for the page: it goes with --view")


def view_of(options: argparse.Namespace) -> View | None:
    """Return the address of --view, None without it. Failure when it is no address or taken, or aiohttp is missing."""
    if options.view is None:
        return None
    browser = sys.stdout.isatty() and not options.no_browser
    if options.view == "":
        view = View(browser=browser)
    else:
        view = View(*host_and_port("--view", options.view, f", as in {HERE}"), browser)
    need("--view needs", "view", "aiohttp")
    _check_free(view)
    return view


def pace_of(options: argparse.Namespace, default: float) -> float:
    """Return --speed for the page. Failure when no player plays at that speed."""
    from ...show.page.messages import MAX_SPEED, MIN_SPEED

    if options.speed is None:
        return default
    if not MIN_SPEED <= options.speed <= MAX_SPEED:
        raise Failure(f"--speed {options.speed:g}: on the page it is from {MIN_SPEED:g} to {MAX_SPEED:g}")
    return float(options.speed)


def newtons_of(calibration: Calibration | None) -> tuple[Foot, ...]:
    """Return the feet whose calibration turns counts into N."""
    return tuple(foot for foot in Foot if calibration is not None and calibration.insole(foot).newtons is not None)


@asynccontextmanager
async def page_of(scene: Scene, view: View, commands: Callable[[Command], None] | None = None) -> AsyncIterator[Page]:
    """Serve the page, print its address, and open a browser when one is requested and there.

    Failure when the page cannot be served there."""
    import asyncio

    from ...show.page.server.access import on_loopback
    from ...show.page.server.server import Page

    async with AsyncExitStack() as stack:
        try:
            page = await stack.enter_async_context(Page(scene, host=view.host, port=view.port, commands=commands))
        except (OSError, UnicodeError) as error:
            raise _taken(view, error) from None
        print(f"the page: {page.url}", flush=True)
        if not on_loopback(view.host):
            note("the page can be reached from other machines: whoever has this address with its token sees it")
        if view.browser and _there_is_a_browser():
            await asyncio.to_thread(_open, page.url)
        yield page


def play(player: Player, view: View, pace: float) -> None:
    """Play `player` on a page of its own, at `pace` times real time, until Ctrl-C.

    Where there is no terminal, it also ends when all was played."""
    import asyncio

    from ...show.page.player.player_loop import PlayerLoop
    from .loop import run_to_end

    async def played(stop: asyncio.Event) -> int:
        playing, once = PlayerLoop(player), not attended()
        async with page_of(player.scene, view, playing.command) as page:
            if not once:
                print("Ctrl-C ends it", flush=True)
            await playing.run(page, stop, once=once)
        return 0

    player.set_speed(pace)
    run_to_end(played)


def run_rest(player: Player, what: str) -> None:
    """Compute what nobody has watched of `what`, a word, so that `on_events` gets all of it.

    Another Ctrl-C raises KeyboardInterrupt, after an item that `on_events` got."""
    from ...show.tables.progress import progress_bar
    from .loop import stop_flag

    items = player.items
    left = len(items) - player.delivered_count
    with progress_bar("computing", len(items), enabled=left > LONG) as show, stop_flag() as stop_requested:
        if left > 0:
            print(f"the rest of the {what}, as fast as it can be computed; Ctrl-C again gives it up ...", flush=True)
        fed = count(1)
        while player.run_through(lambda: next(fed) % ITEMS == 0 or stop_requested()):
            show(player.delivered_count)
            if stop_requested():
                at = items.t(player.delivered_count - 1) if player.delivered_count else items.start
                note(
                    f"given up after {at - items.start:.1f} of {items.end - items.start:.1f} s: nothing is summed up "
                    "or written, and what was written before stays as it is"
                )
                raise KeyboardInterrupt


def _there_is_a_browser() -> bool:
    """Return whether there is a browser with windows: one of the terminal would take the place of this command."""
    if sys.platform in ("darwin", "win32"):
        return True
    return any(os.environ.get(name) for name in ("DISPLAY", "WAYLAND_DISPLAY", "BROWSER"))


def _open(url: str) -> None:
    import webbrowser

    if not webbrowser.open(url):
        note("no browser could be opened: open the address yourself")


def _check_free(view: View) -> None:
    """Raise Failure if the address cannot be served. Checked before a long recording is read."""
    from ...show.page.server.access import listen

    try:
        listen(view.host, view.port).close()
    except (OSError, UnicodeError) as error:
        raise _taken(view, error) from None


def _taken(view: View, error: OSError | UnicodeError) -> Failure:
    """Return a Failure with the reason why the address cannot be served."""
    why = "there is no such host" if isinstance(error, UnicodeError) else in_words(error)
    return Failure(f"--view {printable(view.host, 80)}:{view.port or 0}: {why}")
