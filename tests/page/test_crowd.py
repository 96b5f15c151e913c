"""Tests many and slow watchers of the page: the session runs as if there were none."""

from __future__ import annotations

import asyncio
import socket
from contextlib import suppress

import pytest
from aiohttp import ClientError, ClientSession
from served import (
    Connection,
    check_watching,
    close_code,
    frame_of,
    handshake,
    open_raw,
    rejection_status,
    scene_of,
    served,
)
from walks import insoles

from solepath import Session
from solepath.show.page.scene.scene import Scene
from solepath.show.page.server import connection, server, watcher
from solepath.show.page.server.server import MAX_WATCHERS, Page


async def test_the_number_of_watchers_is_limited() -> None:
    async with served() as (_, client, url):
        watching = [await client.ws_connect(f"{url}ws") for _ in range(MAX_WATCHERS)]
        assert await rejection_status(client.ws_connect(f"{url}ws")) == 503
        await watching[0].close()
        await asyncio.sleep(0.1)
        await check_watching(client, url)


LIMIT = 32
"""Number of connections to which a page is limited here."""


async def test_idle_connections_are_limited_and_closed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(server, "IDLE_TIMEOUT", 2.0)
    monkeypatch.setattr(server, "MAX_CONNECTIONS", LIMIT)
    async with served() as (page, client, url):
        idle = [await open_raw(page) for _ in range(3 * LIMIT)]
        for _, writer in idle:
            writer.write(b"GET / HTTP/1.1\r\nHost: loc")
        while len(page._open) < LIMIT:
            await asyncio.sleep(0.01)
        async with client.get(url) as answer:
            assert answer.status == 200, "there is room for a new one"
        assert len(page._open) <= LIMIT
        for reader, writer in idle:
            with suppress(ConnectionError):
                assert await reader.read() == b""
            writer.close()


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


async def test_a_browser_that_reads_may_watch_longer_than_other_connections_last(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(server, "IDLE_TIMEOUT", 0.1)
    monkeypatch.setattr(connection, "MAX_UNWATCHED_TIME", 0.2)
    monkeypatch.setattr(watcher, "MAX_FRAME_INTERVAL", 0.05)
    async with served() as (_, client, url), client.ws_connect(f"{url}ws") as watching:
        for _ in range(12):
            await watching.receive_str()


async def deaf(page: Page, room: int = 4096) -> Connection:
    """Connect a watcher that never reads."""
    reader, writer = await open_raw(page)
    writer.get_extra_info("socket").setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, room)
    writer.transport.pause_reading()
    writer.write(handshake())
    await asyncio.sleep(0.1)
    return reader, writer


async def test_watchers_do_not_change_the_events_of_a_session() -> None:
    session, alone = Session(poses=True, pressures=True), Session(poses=True, pressures=True)
    async with served() as (page, _, _):
        _, writer = await deaf(page)
        for index, packet in enumerate(insoles().packets):
            events = session.feed(packet)
            page.scene.take(packet, events)
            assert events == alone.feed(packet)
            if index % 20 == 0:
                await asyncio.sleep(0)
        writer.close()


async def test_a_browser_that_reads_slowly_is_shown_less_and_the_newest(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(watcher, "FRAME_INTERVAL", 0.001)
    async with served() as (page, _, _):
        reader, writer = await deaf(page, 65_536)
        (slow,) = page._watchers
        shown = 0
        while not slow._unread():
            shown += 1
            page.scene = Scene(f"{shown} {'x' * 20_000}", "default")
            await asyncio.sleep(0.002)
        for _ in range(50):
            page.scene = Scene(f"{shown} {'x' * 20_000}", "default")
            shown += 1
            await asyncio.sleep(0.002)
        page.scene = Scene("the newest", "default")
        writer.transport.resume_reading()
        received = b""
        while b"the newest" not in received:
            received += await reader.read(65536)
        assert received.count(b'"type":"scene"') < shown
        writer.close()


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
