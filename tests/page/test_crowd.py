"""Tests many and slow watchers of the page: the session runs as if there were none."""

from __future__ import annotations

import asyncio
import socket
from contextlib import suppress

import pytest
from aiohttp import ClientError, ClientSession
from served import Connection, close_code, frame_of, handshake, open_raw, scene_of, served

from solepath.show.page.scene.scene import Scene
from solepath.show.page.server import connection, server, watcher
from solepath.show.page.server.server import MAX_WATCHERS, Page

GET = b"GET /style.css HTTP/1.1\r\nHost: localhost\r\n\r\n"


@pytest.mark.parametrize("requests", [(GET * 2000,), (handshake(), frame_of(1, b"{"))], ids=["files", "socket"])
async def test_a_client_that_requests_and_does_not_read_is_closed_soon(
    requests: tuple[bytes, ...], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(server, "IDLE_TIMEOUT", 0.5)
    monkeypatch.setattr(connection, "MAX_UNWATCHED_TIME", 0.7)
    monkeypatch.setattr(server, "MAX_CONNECTIONS", MAX_WATCHERS)
    async with served(scene=Scene("x" * 120_000, "default")) as (page, client, url):
        silent = []
        for _ in range(MAX_WATCHERS):
            one = socket.socket()
            one.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
            one.setblocking(False)
            await asyncio.get_running_loop().sock_connect(one, ("127.0.0.1", page.port))
            silent.append(one)
        for part in requests:
            for one in silent:
                with suppress(TimeoutError):
                    async with asyncio.timeout(0.05):
                        await asyncio.get_running_loop().sock_sendall(one, part)
            await asyncio.sleep(0.1)
        while True:
            try:
                async with client.get(url) as answer:
                    assert answer.status == 200
                    break
            except ClientError:
                await asyncio.sleep(0.1)
        for one in silent:
            one.close()


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
