"""Serves a page, and sends requests to it."""

from __future__ import annotations

import asyncio
import base64
import json
import os
from collections.abc import AsyncIterator, Awaitable
from contextlib import asynccontextmanager
from typing import Any

import pytest
from aiohttp import ClientSession, ClientWebSocketResponse, WSMsgType, WSServerHandshakeError

from solepath.show.page.scene.scene import Scene
from solepath.show.page.server.server import Page

LOGGER = "solepath.show.page"
TOKEN = "a-token-of-a-test"
Connection = tuple[asyncio.StreamReader, asyncio.StreamWriter]


@asynccontextmanager
async def served(**given: Any) -> AsyncIterator[tuple[Page, ClientSession, str]]:
    """Yield a page, a client, and the page's address."""
    scene = given.pop("scene", None) or Scene("a walk", "default")
    given = {"port": 0, "token": TOKEN, **given}
    async with ClientSession() as client, Page(scene, **given) as page:
        yield page, client, page.url.partition("#")[0]


async def scene_of(watching: ClientWebSocketResponse) -> dict[str, Any]:
    message = json.loads(await watching.receive_str())
    assert isinstance(message, dict) and message["type"] == "scene"
    return message


async def check_watching(client: ClientSession, url: str, **given: Any) -> None:
    """Check that a watcher gets the scene; `given` are options of the socket."""
    async with client.ws_connect(f"{url}ws", **given) as watching:
        await scene_of(watching)


async def close_code(watching: ClientWebSocketResponse) -> int | None:
    """Return the code with which the server closes the socket."""
    while True:
        message = await watching.receive()
        if message.type is not WSMsgType.TEXT:
            return watching.close_code


async def rejection_status(watching: Awaitable[ClientWebSocketResponse]) -> int:
    """Return the HTTP status with which a socket is rejected."""
    with pytest.raises(WSServerHandshakeError) as caught:
        await watching
    return caught.value.status


async def open_raw(page: Page) -> Connection:
    """Open a connection, and send nothing."""
    return await asyncio.open_connection("127.0.0.1", page.port)


async def fetch_reply(page: Page, sent: bytes) -> bytes:
    """Return the whole answer to these bytes on a new connection."""
    reader, writer = await open_raw(page)
    writer.write(sent)
    answer = await reader.read()
    writer.close()
    return answer


def handshake() -> bytes:
    return (
        f"GET /ws HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
        f"Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: {base64.b64encode(os.urandom(16)).decode()}\r\n\r\n"
    ).encode()


def frame_of(opcode: int, payload: bytes, *, fin: int = 0x80) -> bytes:
    """Return a frame of a WebSocket as a client sends it."""
    size = len(payload)
    long = bytes([0x80 | size]) if size < 126 else bytes([0x80 | 126]) + size.to_bytes(2, "big")
    return bytes([fin | opcode]) + long + bytes(4) + payload
