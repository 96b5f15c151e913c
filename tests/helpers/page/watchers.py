"""Watches the page that a command serves, as a browser would."""

from __future__ import annotations

import asyncio
import json
import re
import subprocess
from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import asynccontextmanager
from typing import TYPE_CHECKING, Any

from programs import TAKES

if TYPE_CHECKING:
    import aiohttp

ANYWHERE = ("--view", "127.0.0.1:0")


def address(process: subprocess.Popen[str]) -> str:
    """Return the address of the page that the command prints."""
    assert process.stdout is not None
    for line in process.stdout:
        if found := re.search(r"the page: (http://\S+#token=\S+)$", line):
            return found[1]
    raise AssertionError("no page was served")


class Watcher:
    """The state of a page as in a browser; it can send commands."""

    def __init__(self, socket: aiohttp.ClientWebSocketResponse) -> None:
        self.socket = socket
        self.scene: dict[str, Any] = {}
        self.frame: dict[str, Any] = {}
        self.scenes = 0

    async def until(self, holds: Callable[[dict[str, Any]], bool]) -> None:
        """Wait until a condition holds for the present frame."""
        async with asyncio.timeout(TAKES):
            while not self.scene or not holds(self.frame):
                message = json.loads(await self.socket.receive_str())
                if message["type"] == "scene":
                    self.scene, self.frame, self.scenes = message, message["frame"], self.scenes + 1
                else:
                    self.frame |= message

    async def send_command(self, do: str, *value: float) -> None:
        await self.socket.send_str(json.dumps({"do": do} | ({"value": value[0]} if value else {})))


@asynccontextmanager
async def watching(url: str) -> AsyncIterator[Watcher]:
    import aiohttp

    page, _, token = url.partition("/#token=")
    async with aiohttp.ClientSession() as client, client.ws_connect(f"{page}/ws?token={token}") as socket:
        yield Watcher(socket)


def watch(url: str, what: Callable[[Watcher], Awaitable[None]]) -> None:
    async def main() -> None:
        async with watching(url) as watcher:
            await what(watcher)

    asyncio.run(main())
