"""Tests that nobody without the token keeps its owner out, whatever many peers do at the same time.

The addresses 127.0.0.x of this machine stand for several machines."""

from __future__ import annotations

import asyncio
import sys
from contextlib import suppress
from importlib.resources import files

import pytest
from aiohttp import ClientSession, TCPConnector
from served import TOKEN, Connection, check_watching, close_code, handshake, rejection_status, scene_of, served

from solepath.show.page.server.connection import MAX_CONNECTIONS, peer_of
from solepath.show.page.server.server import MAX_WATCHERS, Page

PEERS = ("127.0.0.2", "127.0.0.3", "127.0.0.4", "127.0.0.5")
IDLE, RECONNECTIONS = 200, 400
GET = b"GET / HTTP/1.1\r\nHost: localhost\r\n\r\n"
NAMES = sorted(one.name for one in (files("solepath.show.page") / "static").iterdir())


async def visit(page: Page) -> None:
    """Load the whole page as the owner does, and watch; any failure raises."""
    url = f"http://127.0.0.1:{page.port}/"
    async with ClientSession(connector=TCPConnector(limit_per_host=6)) as client, asyncio.TaskGroup() as loading:

        async def load(name: str) -> None:
            async with client.get(url + name) as answer:
                assert answer.status == 200
                await answer.read()

        for name in ("", *NAMES):
            loading.create_task(load(name))
    async with ClientSession() as client:
        await check_watching(client, url, params={"token": TOKEN})


async def knock(page: Page, peer: str, sent: bytes) -> Connection | None:
    """Open a connection from this address and send the bytes; None if the page closes it first."""
    with suppress(ConnectionError):
        reader, writer = await asyncio.open_connection("127.0.0.1", page.port, local_addr=(peer, 0))
        writer.write(sent)
        return reader, writer
    return None


MORE_PEERS = ((PEERS, GET * 20), (("127.0.0.1",), handshake()))


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="only 127.0.0.1 is this machine")
@pytest.mark.parametrize(
    ("peers", "sent"),
    [(PEERS[:1], b""), *(pytest.param(*one, marks=pytest.mark.soak) for one in MORE_PEERS)],
    ids=["1", "4", "own"],
)
async def test_idle_connections_and_reconnections_keep_nobody_out(peers: tuple[str, ...], sent: bytes) -> None:
    async with served(host="0.0.0.0" if len(peers) > 1 else "127.0.0.1") as (page, _, _):
        idle = [await knock(page, peers[number % len(peers)], sent) for number in range(IDLE)]

        async def reconnect(peer: str) -> None:
            for _ in range(RECONNECTIONS // len(peers)):
                idle.append(await knock(page, peer, sent))
                if (old := idle.pop(0)) is not None:
                    old[1].close()

        storm = asyncio.gather(*map(reconnect, peers))
        visits = 0
        while not storm.done() or not visits:
            await visit(page)
            visits += 1
        await storm
        assert len(page._open) <= MAX_CONNECTIONS
        await visit(page)
        for one in filter(None, idle):
            one[1].close()


async def test_watchers_without_the_token_make_room_for_one_who_has_it() -> None:
    async with served() as (page, client, url):
        watching = [await client.ws_connect(f"{url}ws") for _ in range(MAX_WATCHERS)]
        closing = asyncio.gather(*map(close_code, watching))
        with_token = [await client.ws_connect(f"{url}ws?token={TOKEN}") for _ in range(MAX_WATCHERS)]
        for one in with_token:
            assert (await scene_of(one))["type"] == "scene"
        assert await closing == [1013] * MAX_WATCHERS
        assert await rejection_status(client.ws_connect(f"{url}ws")) == 503
        assert await rejection_status(client.ws_connect(f"{url}ws?token={TOKEN}")) == 503
        assert len(page._watchers) == MAX_WATCHERS


@pytest.mark.parametrize(
    ("address", "peer"),
    [
        (("192.0.2.1", 5), "192.0.2.1"),
        (("::ffff:192.0.2.1", 5, 0, 0), "192.0.2.1"),
        (("2001:db8:1:2:3:4:5:6", 5, 0, 0), "2001:db8:1:2::/64"),
        (("fe80::1%eth0", 5, 0, 2), "fe80::/64"),
        (None, ""),
        ("", ""),
    ],
)
def test_a_peer_is_an_address_or_the_network_of_one(address: object, peer: str) -> None:
    assert peer_of(address) == peer
