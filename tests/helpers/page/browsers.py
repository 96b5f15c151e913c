"""A real browser for the tests of the page: Chromium driven by Playwright, on the loop of the page's server.

Every wait is limited: a test that takes longer than MAX_TEST_TIME fails.
"""

from __future__ import annotations

import asyncio
import re
import shutil
from collections.abc import AsyncIterator, Awaitable, Callable, Iterator
from contextlib import asynccontextmanager, contextmanager, suppress
from typing import Any, TypeVar

from attrs import define, field

try:
    from playwright.async_api import Browser, CDPSession, async_playwright
    from playwright.async_api import Page as Tab
except ImportError:  # the tests are skipped
    Browser = CDPSession = Tab = Any  # type: ignore[assignment, misc]
    async_playwright = None  # type: ignore[assignment]

T = TypeVar("T")

PROGRAMS = ("chromium", "chromium-browser", "google-chrome")
FLAGS = (
    "--no-sandbox",  # root may not have one; nothing but our own page is opened
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--enable-features=WebBluetooth",  # which Chromium has not on Linux by itself
)
MAX_TEST_TIME = 240.0
"""Longest time of a test, s."""
MAX_WAIT = 180.0
"""Longest wait for a condition, s: what takes a second may take a minute while others compute."""
UNREACHABLE = re.compile(r"net::ERR_CONNECTION_REFUSED|net::ERR_CONNECTION_RESET|ERR_SOCKET_NOT_CONNECTED")
"""Messages that Chromium writes to the console while there is no server."""


def why_not() -> str | None:
    """Return the reason why no browser can be started here; None if one can."""
    if async_playwright is None:
        return "playwright is not installed"
    if program() is None:
        return f"no browser here: {', '.join(PROGRAMS)}"
    return None


def program() -> str | None:
    return next(filter(None, map(shutil.which, PROGRAMS)), None)


@define
class Browsing:
    """A browser, and the event loop on which it stays between tests."""

    runner: asyncio.Runner
    browser: Browser

    def run(self, main: Callable[[Browser], Awaitable[T]], longest: float = MAX_TEST_TIME) -> T:
        async def timed() -> T:
            async with asyncio.timeout(longest):
                return await main(self.browser)

        return self.runner.run(timed())


@contextmanager
def browsing() -> Iterator[Browsing]:
    """Yield a browser that has just been started."""
    with asyncio.Runner() as runner:
        driver = runner.run(_within(async_playwright().start()))
        try:
            browser = runner.run(_within(driver.chromium.launch(executable_path=program(), args=[*FLAGS])))
            yield Browsing(runner, browser)
            runner.run(_within(browser.close()))
        finally:
            runner.run(_within(driver.stop()))


async def _within(work: Awaitable[T]) -> T:
    async with asyncio.timeout(MAX_TEST_TIME):
        return await work


@define
class Window:
    """A page that is open.

    `complaints` holds the messages of its console, and errors that it did not catch. `requests` holds every address
    that it requested, those of WebSockets included."""

    tab: Tab
    devtools: CDPSession
    complaints: list[str] = field(factory=list)
    requests: list[str] = field(factory=list)

    async def memory(self) -> tuple[int, int]:
        """Return the size of the scripts' heap after garbage collection, bytes, and the number of elements.

        Elements of the log do not count, since its number of sentences varies, up to fifty."""
        # objects with a finalizer need another collection, and what a frame just drew is collected by the next
        least = min([await self._collected() for _ in range(5)])
        elements = await self.tab.evaluate("document.querySelectorAll('*:not(#log *)').length")
        return round(least), elements

    async def _collected(self) -> float:
        """Return the size of the heap after another garbage collection, bytes."""
        await self.devtools.send("HeapProfiler.collectGarbage")
        await asyncio.sleep(0.1)
        used: float = (await self.devtools.send("Runtime.getHeapUsage"))["usedSize"]
        return used

    async def until(self, condition: str, argument: Any = None, patience: float = MAX_WAIT) -> None:
        """Wait until a condition, an expression or a function of `argument`, holds in the page; else fail.

        The page forbids scripts from elsewhere, and thereby Playwright's own function for this."""
        try:
            async with asyncio.timeout(patience):
                while not await self.tab.evaluate(condition, argument):
                    await asyncio.sleep(0.05)
        except TimeoutError:
            raise AssertionError(f"not within {patience:g} s: {condition}; complaints: {self.complaints}") from None

    async def text(self, name: str) -> str:
        """Return the text of the element with this id."""
        text: str = await self.tab.locator(f"#{name}").inner_text()
        return text.strip()


@asynccontextmanager
async def closing(close: Callable[[], Awaitable[None]]) -> AsyncIterator[None]:
    """Close something of a browser at the end; one that has died cannot, which does not hide what went wrong before."""
    try:
        yield
    except BaseException:
        with suppress(Exception):
            await close()
        raise
    await close()


@asynccontextmanager
async def window(
    browser: Browser,
    url: str,
    *,
    width: int = 1280,
    height: int = 900,
    dark: bool = False,
    script: str = "",
    still: bool = False,
) -> AsyncIterator[Window]:
    """Yield the page at `url` in a new window of this size, px; `script` runs in it before any other.

    `still` is a person's wish for little motion, with which a page is drawn less often."""
    context = await browser.new_context(
        viewport={"width": width, "height": height},
        color_scheme="dark" if dark else "light",
        locale="en-GB",
        reduced_motion="reduce" if still else "no-preference",
    )
    async with closing(context.close):
        context.set_default_timeout(MAX_WAIT * 1000.0)
        await context.add_init_script(script)
        tab = await context.new_page()
        view = Window(tab, await context.new_cdp_session(tab))
        tab.on("console", lambda message: view.complaints.append(f"{message.type}: {message.text}"))
        tab.on("pageerror", lambda error: view.complaints.append(str(error)))
        context.on("request", lambda request: view.requests.append(request.url))
        tab.on("websocket", lambda socket: view.requests.append(socket.url))
        await tab.goto(url)
        yield view
