"""Tests many and slow watchers of the page: the session runs as if there were none."""

from __future__ import annotations

import asyncio
import socket

import pytest
from aiohttp import ClientSession
from served import Connection, close_code, handshake, open_raw, scene_of, served

from solepath.show.page.scene.scene import Scene
from solepath.show.page.server import watcher
from solepath.show.page.server.server import Page


async def deaf(page: Page, room: int = 4096) -> Connection:
    """Connect a watcher that never reads."""
    reader, writer = await open_raw(page)
    writer.get_extra_info("socket").setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, room)
    writer.transport.pause_reading()
    writer.write(handshake())
    await asyncio.sleep(0.1)
    return reader, writer


async def test_a_browser_that_reads_nothing_gets_nothing_more_and_is_let_go(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setattr(watcher, "READ_TIMEOUT", 0.5)
    monkeypatch.setattr(watcher, "FRAME_INTERVAL", 0.001)
    async with served(scene=Scene("x" * 20_000, "default")) as (page, client, url):
        _, writer = await deaf(page)
        async with client.ws_connect(f"{url}ws") as other:
            await scene_of(other)
            while len(page._watchers) == 2:
                page.scene = Scene("x" * 20_000, "default")
                held = [one._transport.get_write_buffer_size() for one in page._watchers if one._transport]
                assert max(held) < 200_000
                await asyncio.sleep(0.001)
                await scene_of(other)
            page.scene = Scene("still here", "default")
            while (await scene_of(other))["title"] != "still here":
                pass
        writer.close()
    assert [one.getMessage() for one in caplog.records] == ["a browser that had read nothing for 0 s was let go"]


async def test_a_page_closes_its_sockets_and_does_not_wait_for_a_browser_that_reads_nothing() -> None:
    async with ClientSession() as client:
        async with Page(Scene("", ""), port=0) as page:
            _, unread = await deaf(page)
            idle = await open_raw(page)
            watching = await client.ws_connect(f"{page.url.partition('#')[0]}ws")
            await scene_of(watching)
            answering = asyncio.create_task(close_code(watching))
        assert await answering == 1001  # which the page takes for an end in order
        assert await idle[0].read() == b""
        unread.close()
