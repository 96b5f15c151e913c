"""Tabs that can be hidden and frozen as on a phone: Playwright keeps its own ones visible, whatever is before them.

They are driven by the messages of Chromium's own protocol (DevTools), wrapped in those of another connection."""

from __future__ import annotations

import asyncio
import json
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager, suppress
from typing import Any

from browsers import MAX_WAIT, Browser

OPEN_FILE = """([name, text]) => {
    const [input, files] = [document.getElementById('file'), new DataTransfer()];
    files.items.add(new File([text], name));
    input.files = files.files;
    input.dispatchEvent(new Event('change'));
}"""
"""Opens a file as a person does who chose it."""


class PlainTab:
    """A tab of the browser's first window, and a second one that can be put before it."""

    def __init__(self, devtools: Any, tab: str, other: str, session: str) -> None:
        self._devtools, self._tab, self._other, self._session = devtools, tab, other, session
        self._count = 0
        self._answers: dict[int, asyncio.Future[dict[str, Any]]] = {}
        devtools.on("Target.receivedMessageFromTarget", self._receive)

    def _receive(self, got: dict[str, Any]) -> None:
        message = json.loads(got["message"])
        if got["sessionId"] != self._session:
            return
        if message.get("id") in self._answers:
            self._answers.pop(message["id"]).set_result(message)

    @property
    def tab(self) -> PlainTab:
        """The tab itself, as a Window has one."""
        return self

    async def _send(self, method: str, **values: Any) -> dict[str, Any]:
        self._count += 1
        number = self._count
        answer = self._answers[number] = asyncio.get_running_loop().create_future()
        message = json.dumps({"id": number, "method": method, "params": values})
        await self._devtools.send("Target.sendMessageToTarget", {"sessionId": self._session, "message": message})
        got = await asyncio.wait_for(answer, MAX_WAIT)
        assert "error" not in got, got
        return dict(got["result"])

    async def evaluate(self, script: str, argument: Any = None) -> Any:
        """Return the value of an expression in the page, or of a function of `argument`."""
        expression = script if argument is None else f"({script})({json.dumps(argument)})"
        got = await self._send("Runtime.evaluate", expression=expression, awaitPromise=True, returnByValue=True)
        assert "exceptionDetails" not in got, got
        return got["result"].get("value")

    async def until(self, condition: str, argument: Any = None, patience: float = MAX_WAIT) -> None:
        """Wait until a condition holds in the page; else fail."""
        try:
            async with asyncio.timeout(patience):
                while not await self.evaluate(condition, argument):
                    await asyncio.sleep(0.05)
        except TimeoutError:
            raise AssertionError(f"not within {patience:g} s: {condition}") from None

    async def hide(self) -> None:
        """Put another tab before this one."""
        await self._devtools.send("Target.activateTarget", {"targetId": self._other})
        await self.until("document.visibilityState === 'hidden'")

    async def freeze(self) -> None:
        """Stop the hidden page, as a browser does that saves power."""
        await self._send("Page.setWebLifecycleState", state="frozen")

    async def show(self) -> None:
        """Let a frozen page go on, and put it before the other tab."""
        await self._send("Page.setWebLifecycleState", state="active")
        await self._devtools.send("Target.activateTarget", {"targetId": self._tab})
        await self.until("document.visibilityState === 'visible'")


@asynccontextmanager
async def plain_tab(browser: Browser, url: str) -> AsyncIterator[PlainTab]:
    """Yield a tab with the page at `url`."""
    devtools: Any = await browser.new_browser_cdp_session()
    opened = [(await devtools.send("Target.createTarget", {"url": one}))["targetId"] for one in ("about:blank", url)]
    attached = await devtools.send("Target.attachToTarget", {"targetId": opened[1], "flatten": False})
    tab = PlainTab(devtools, opened[1], opened[0], attached["sessionId"])
    try:
        async with asyncio.timeout(MAX_WAIT):
            loaded = False
            while not loaded:
                with suppress(AssertionError):  # the page is another one in the next moment
                    loaded = await tab.evaluate("location.protocol !== 'about:' && document.readyState === 'complete'")
                await asyncio.sleep(0.05)
        yield tab
    finally:
        for one in opened:
            await devtools.send("Target.closeTarget", {"targetId": one})
        await devtools.detach()
