"""The server of the page: who may watch and steer, what it sends, and that nobody who watches can harm the session."""

from __future__ import annotations

import asyncio
import base64
import json
import logging
import os
import socket
import struct
from collections.abc import AsyncIterator, Awaitable, Callable, Coroutine
from contextlib import asynccontextmanager, suppress
from importlib.resources import files
from typing import Any
from urllib.parse import urlsplit

import pytest
from aiohttp import (
    ClientError,
    ClientSession,
    ClientWebSocketResponse,
    WSCloseCode,
    WSMsgType,
    WSServerHandshakeError,
)
from hypothesis import given, settings
from hypothesis import strategies as st
from walks import insoles

from solepath import Foot, LinkTrouble, Session, Site
from solepath.show.page.messages import Command, CommandError, parse_command
from solepath.show.page.scene.scene import Scene
from solepath.show.page.server import connection, offences, server, watcher
from solepath.show.page.server.access import Access, AccessDenied, host_of, on_loopback, reached_at
from solepath.show.page.server.connection import HEADERS
from solepath.show.page.server.server import MOST_CONNECTIONS, MOST_WATCHERS, Page

LOGGER = "solepath.show.page"
TOKEN = "a-token-of-a-test"


def run(main: Coroutine[Any, Any, None]) -> None:
    async def timed() -> None:
        async with asyncio.timeout(30.0):
            await main

    asyncio.run(timed())


@asynccontextmanager
async def served(**given: Any) -> AsyncIterator[tuple[Page, ClientSession, str]]:
    """A page, somebody who asks, and its address."""
    scene = given.pop("scene", None) or Scene("a walk", "default")
    given = {"port": 0, "token": TOKEN, **given}
    async with ClientSession() as client, Page(scene, **given) as page:
        yield page, client, page.url.partition("#")[0]


async def scene_of(watching: ClientWebSocketResponse) -> dict[str, Any]:
    told = json.loads(await watching.receive_str())
    assert isinstance(told, dict) and told["type"] == "scene"
    return told


async def closed(watching: ClientWebSocketResponse) -> int | None:
    """The code with which the server closes."""
    while True:
        message = await watching.receive()
        if message.type is not WSMsgType.TEXT:
            return watching.close_code


async def refused(watching: Awaitable[ClientWebSocketResponse]) -> int:
    """The status with which a socket is refused."""
    with pytest.raises(WSServerHandshakeError) as caught:
        await watching
    return caught.value.status


async def raw(page: Page) -> tuple[asyncio.StreamReader, asyncio.StreamWriter]:
    """A connection on which nothing was said yet."""
    return await asyncio.open_connection("127.0.0.1", page.port)


def handshake(host: str, more: str = "") -> bytes:
    key = base64.b64encode(os.urandom(16)).decode()
    return (
        f"GET /ws HTTP/1.1\r\nHost: {host}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
        f"Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: {key}\r\n{more}\r\n"
    ).encode()


# --- what it sends ---------------------------------------------------------------------------------------------------


def test_a_watcher_sees_the_walk() -> None:
    async def main() -> None:
        session = Session(poses=True, pressures=True)
        async with served() as (page, client, url), client.ws_connect(f"{url}ws") as watching:
            scene = await scene_of(watching)
            assert scene["frame"]["feet"] == {"left": None, "right": None}
            for index, packet in enumerate(insoles().packets):
                page.scene.take(packet, session.feed(packet))
                if index % 50 == 0:
                    await asyncio.sleep(0.01)
            steps = points = frames = 0
            while steps < page.scene.observer.feet[Foot.LEFT].strides:
                news = json.loads(await watching.receive_str())
                frames += news["type"] == "frame"
                if news["type"] == "scene":  # the soles are known now
                    points = 0
                points += len(news.get("tracks", {}).get("left", []))
                steps = (news.get("frame", news).get("feet", {}).get("left") or {}).get("steps", steps)
            assert steps > 2 and points == steps + 1 and frames > 2

    run(main())


def test_a_watcher_hears_something_every_second_even_when_nothing_happens() -> None:
    async def main() -> None:
        async with served() as (_, client, url), client.ws_connect(f"{url}ws") as watching:
            await scene_of(watching)
            assert json.loads(await watching.receive_str()) == {"type": "frame", "t": 0.0}

    run(main())


def test_what_came_last_is_shown_before_the_end() -> None:
    """As what a session says when it is finished, after which the page goes."""

    async def main() -> None:
        async with served() as (page, client, url):
            watching = await client.ws_connect(f"{url}ws")
            await scene_of(watching)
            trouble = LinkTrouble(t=1.0, known_at=1.0, site=Site.LEFT_FOOT, what="the last that was said")
            page.scene.take(None, [trouble])
            ending = asyncio.create_task(page.__aexit__(None, None, None))
            texts = []
            while (message := await watching.receive()).type is WSMsgType.TEXT:
                texts.append(message.data)
            await ending
            assert "the last that was said" in texts[-1] and watching.close_code == WSCloseCode.GOING_AWAY
            await watching.close()

    run(main())


def test_another_scene_is_sent_whole_as_after_a_seek() -> None:
    async def main() -> None:
        async with served() as (page, client, url), client.ws_connect(f"{url}ws") as watching:
            await scene_of(watching)
            page.scene = Scene("another", "default")
            assert (await scene_of(watching))["title"] == "another"

    run(main())


def test_the_page_is_made_of_the_files_that_are_installed() -> None:
    async def main() -> None:
        names = {one.name for one in (files("solepath.show.page.server") / "static").iterdir()}
        assert "index.html" in names
        async with served() as (_, client, url):
            for name in ("", *names):
                async with client.get(url + name) as answer:
                    assert answer.status == 200, name
                    assert answer.headers["Content-Security-Policy"].startswith("default-src 'none'; script-src 'self'")
                    assert answer.headers["X-Content-Type-Options"] == "nosniff"
                    assert answer.headers["Cache-Control"] == "no-store"
                    assert answer.headers["Referrer-Policy"] == "no-referrer"
                    assert answer.headers["Cross-Origin-Resource-Policy"] == "same-origin"
                    async with client.head(url + name) as head:
                        assert (head.status, await head.read()) == (200, b"")
                        assert head.headers["Content-Length"] == answer.headers["Content-Length"]
                    kind = answer.headers["Content-Type"].partition(";")[0]
                    assert kind == server.KINDS[f".{(name or 'index.html').rpartition('.')[2]}"]
            text = "".join((files("solepath.show.page.server") / "static" / name).read_text() for name in names)
            for elsewhere in ("https:", "//cdn"):
                assert elsewhere not in text.replace('"https:"', "").replace("'https:'", "")

    run(main())


@pytest.mark.parametrize(
    "path", ["../server.py", "..%2fserver.py", "%2e%2e/server.py", "/etc/passwd", "static/index.html", "index.html/"]
)
def test_there_are_no_other_files(path: str) -> None:
    async def main() -> None:
        async with served() as (page, _, _):
            reader, writer = await raw(page)
            writer.write(f"GET /{path} HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n".encode())
            assert (await reader.read()).split(b" ")[1] in (b"404", b"400")
            writer.close()

    run(main())


@pytest.mark.parametrize("method", ["POST", "PUT", "DELETE", "OPTIONS"])
def test_files_can_only_be_got(method: str) -> None:
    async def main() -> None:
        async with served() as (_, client, url), client.request(method, url, data=b"x" * 100_000) as answer:
            assert answer.status == 405

    run(main())


def test_only_a_get_becomes_a_socket() -> None:
    async def main() -> None:
        async with served() as (page, _, _):
            for method in (b"POST", b"HEAD", b"PUT"):
                reader, writer = await raw(page)
                writer.write(handshake("localhost").replace(b"GET", method, 1))
                assert (await reader.readline()).split(b" ")[1] in (b"400", b"405")
                writer.close()

    run(main())


@pytest.mark.parametrize(
    "sent", [b"EVIL\r\n\r\n", b"GET / HTTP/9.9 EVIL\r\n\r\n", b"POST / HTTP/1.1\r\nContent-Length: EVIL\r\n\r\n",
             b"GET / HTTP/1.1\r\nHost: localhost\r\nEVIL\r\n\r\n", b"GET / HTTP/1.1\r\nX: " + b"EVIL" * 9000],
)  # fmt: skip
def test_what_is_no_request_is_answered_with_the_headers_of_every_answer_and_none_of_its_words(sent: bytes) -> None:
    async def main() -> None:
        async with served() as (page, _, _):
            for begun in (b"", b"GET / HTTP/1.1\r\nHost: localhost\r\n\r\n"):
                reader, writer = await raw(page)
                writer.write(begun + sent)
                _, refusal, told = (await reader.read()).partition(b" 400 Bad Request")
                writer.close()
                assert refusal and b"EVIL" not in told
                assert b"aiohttp" not in told and b"Python" not in told
                for name, value in HEADERS.items():
                    assert f"\r\n{name}: {value}\r\n".encode() in told

    run(main())


# --- who may watch, and who may steer --------------------------------------------------------------------------------


def test_it_is_for_this_machine_unless_told_otherwise() -> None:
    async def main() -> None:
        async with Page(Scene("", ""), port=0) as page:
            assert urlsplit(page.url).hostname == "127.0.0.1"
            (listening,) = page._listening.sockets if page._listening is not None else ()
            assert listening.getsockname()[0] == "127.0.0.1"

    run(main())


def test_every_page_has_a_token_of_its_own() -> None:
    async def main() -> None:
        async with Page(Scene("", ""), port=0) as one, Page(Scene("", ""), port=0) as other:
            tokens = {page.url.partition("#token=")[2] for page in (one, other)}
            assert len(tokens) == 2 and all(len(token) >= 20 for token in tokens)

    run(main())


def test_who_has_the_token_steers() -> None:
    async def main() -> None:
        asked: list[Command] = []
        async with served(commands=asked.append) as (_, client, url):
            async with client.ws_connect(f"{url}ws?token={TOKEN}") as watching:
                assert (await scene_of(watching))["control"] is True
                for told in ('{"do":"pause"}', '{"do":"seek","value":3}', '{"do":"speed","value":4.0}'):
                    await watching.send_str(told)
                while len(asked) < 3:
                    await asyncio.sleep(0.01)
            assert asked == [Command("pause"), Command("seek", 3.0), Command("speed", 4.0)]

    run(main())


def test_who_has_no_token_watches_and_is_shown_out_on_trying_to_steer(caplog: pytest.LogCaptureFixture) -> None:
    async def main() -> None:
        asked: list[Command] = []
        async with served(commands=asked.append) as (_, client, url), client.ws_connect(f"{url}ws") as watching:
            assert (await scene_of(watching))["control"] is False
            await watching.send_str('{"do":"pause"}')
            assert await closed(watching) == 1008
        assert asked == []
        assert [one.name for one in caplog.records] == [LOGGER]

    run(main())


def test_a_page_with_nothing_to_play_is_not_steered() -> None:
    async def main() -> None:
        async with served() as (_, client, url), client.ws_connect(f"{url}ws?token={TOKEN}") as watching:
            assert (await scene_of(watching))["control"] is False
            await watching.send_str('{"do":"pause"}')
            assert await closed(watching) == 1008

    run(main())


@pytest.mark.parametrize("query", ["token=wrong", "token=", f"token={TOKEN}&token=wrong", "token=%ff", "token=%f0%9f"])
def test_a_wrong_token_is_refused(query: str, caplog: pytest.LogCaptureFixture) -> None:
    async def main() -> None:
        async with served() as (_, client, url):
            assert await refused(client.ws_connect(f"{url}ws?{query}")) == 403
        assert len(caplog.records) == 1

    run(main())


@pytest.mark.parametrize("origin", ["http://evil.example", "http://127.0.0.1:1", "null", "file://", "http://[", ""])
def test_pages_of_others_may_not_watch(origin: str, caplog: pytest.LogCaptureFixture) -> None:
    async def main() -> None:
        async with served() as (_, client, url):
            assert await refused(client.ws_connect(f"{url}ws?token={TOKEN}", headers={"Origin": origin})) == 403
        assert len(caplog.records) == 1

    run(main())


def test_its_own_page_may_watch() -> None:
    async def main() -> None:
        async with served() as (page, client, url):
            for host in ("127.0.0.1", "localhost"):
                own = f"http://{host}:{page.port}"
                async with client.ws_connect(f"{url}ws", headers={"Origin": own, "Host": own[7:]}) as watching:
                    await scene_of(watching)

    run(main())


@pytest.mark.parametrize(
    ("host", "status"),
    [
        ("evil.example", b"403"), ("evil.example:80", b"403"), ("127.0.0.1.evil.example", b"403"),
        ("a@localhost", b"400"), ("localhost/x", b"400"), ("", b"400"), ("localhost:x", b"400"), ("[::1", b"400"),
        ("localhost", b"200"), ("LOCALHOST:1", b"200"), ("[::1]:99", b"200"), ("192.168.1.7", b"200"),
    ],
)  # fmt: skip
def test_a_name_that_somebody_else_could_point_here_is_no_host(host: str, status: bytes) -> None:
    async def main() -> None:
        async with served() as (page, _, _):
            reader, writer = await raw(page)
            writer.write(f"GET / HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n\r\n".encode())
            assert (await reader.read()).split(b" ")[1] == status
            writer.close()

    run(main())


@settings(deadline=None)
@given(st.text())
def test_any_host_is_told_or_refused(text: str) -> None:
    host = host_of(text)
    assert host is None or host == host.lower()
    try:
        Access("127.0.0.1", TOKEN).check_host(text)
        Access("127.0.0.1", TOKEN).check_origin([text], "127.0.0.1:1")
    except AccessDenied as why:
        assert why.status in (400, 403)


def test_beyond_this_machine_nobody_watches_without_the_token() -> None:
    async def main() -> None:
        async with served(host="0.0.0.0") as (page, client, _):
            url = f"http://127.0.0.1:{page.port}/"
            assert await refused(client.ws_connect(f"{url}ws")) == 403
            async with client.ws_connect(f"{url}ws?token={TOKEN}") as watching:
                await scene_of(watching)
            assert not on_loopback(urlsplit(page.url).hostname or "") or reached_at("0.0.0.0") == "127.0.0.1"

    run(main())


def test_ipv6_of_this_machine_serves_as_well() -> None:
    async def main() -> None:
        try:
            with socket.create_server(("::1", 0), family=socket.AF_INET6):
                pass
        except OSError:
            pytest.skip("no IPv6 here")
        async with served(host="::1") as (page, client, url):
            assert url == f"http://[::1]:{page.port}/"
            async with client.ws_connect(f"{url}ws", headers={"Origin": url.rstrip("/")}) as watching:
                await scene_of(watching)

    run(main())


def test_a_port_that_is_taken_is_said_or_another_one_found() -> None:
    async def main() -> None:
        async with served() as (page, _, _):
            with pytest.raises(OSError):
                async with Page(Scene("", ""), port=page.port):
                    pass
        async with Page(Scene("", "")) as one, Page(Scene("", "")) as other:
            assert one.port != other.port

    run(main())


# --- malformed -------------------------------------------------------------------------------------------------------


@settings(deadline=None, max_examples=100)
@given(st.one_of(st.text(), st.dictionaries(
    st.sampled_from(["do", "value", "to"]),
    st.none() | st.booleans() | st.floats() | st.integers() | st.sampled_from(["play", "seek", "speed"]),
).map(json.dumps)))  # fmt: skip
def test_any_text_is_a_command_or_none(text: str) -> None:
    try:
        command = parse_command(text)
    except CommandError as error:
        assert str(error) and "\n" not in str(error)
    else:
        assert command.do in ("play", "pause", "speed", "seek")
        told = {"do": command.do} if command.value is None else {"do": command.do, "value": command.value}
        assert parse_command(json.dumps(told)) == command


@pytest.mark.parametrize(
    "text",
    [
        "", "{", "null", "[]", '"play"', "{}", '{"do":"stop"}', '{"do":["play"]}', '{"do":"play","value":1}',
        '{"do":"play","do":"play"}', '{"do":"seek"}', '{"do":"seek","value":null}', '{"do":"seek","value":true}',
        '{"do":"seek","value":"1"}', '{"do":"seek","value":NaN}', '{"do":"seek","value":1e999}',
        '{"do":"speed","value":0}', '{"do":"speed","value":32.01}', '{"do":"seek","value":Infinity}',
        '{"do":"seek","value":1' + "0" * 999 + "}", '{"do":"speed","value":-1}', "[" * 5000,
    ],
)  # fmt: skip
def test_what_is_no_command_is_refused(text: str) -> None:
    with pytest.raises(CommandError):
        parse_command(text)


def frame_of(opcode: int, payload: bytes, *, masked: bool = True, fin: int = 0x80) -> bytes:
    """A frame of a WebSocket as a client sends it."""
    size = len(payload)
    head = bytes([fin | opcode])
    mask = 0x80 if masked else 0
    head += bytes([mask | size]) if size < 126 else bytes([mask | 126]) + size.to_bytes(2, "big")
    return head + (bytes(4) if masked else b"") + payload


@pytest.mark.parametrize(
    ("sent", "code"),
    [
        (frame_of(2, b"bytes"), 1003),
        (frame_of(1, b"\xff\xfe"), 1007),
        (frame_of(1, b"no json"), 1007),
        (frame_of(1, b'{"do":"seek","value":NaN}'), 1007),
        (frame_of(1, b'{"do":"dance"}'), 1008),
        (frame_of(1, b" " * 4096), 1007),
        (frame_of(1, b" " * 4097), 1009),
        (frame_of(3, b"reserved"), 1002),
        (frame_of(1, b"", fin=0xC0), 1002),
    ],
)
def test_what_is_malformed_is_answered_with_a_close_and_one_line(
    sent: bytes, code: int, caplog: pytest.LogCaptureFixture
) -> None:
    async def main() -> None:
        async with served(commands=lambda command: None) as (page, client, url):
            reader, writer = await raw(page)
            writer.write(handshake("localhost"))
            await reader.readuntil(b"\r\n\r\n")
            writer.write(sent)
            assert await reader.readuntil(b"\x88") and code.to_bytes(2, "big") in await reader.read(3)
            writer.close()
            async with client.ws_connect(f"{url}ws") as watching:
                await scene_of(watching)
        assert [one.name for one in caplog.records] == [LOGGER]

    run(main())


@settings(deadline=None, max_examples=12)
@given(st.lists(st.one_of(
    st.binary(max_size=200),
    st.builds(frame_of, st.integers(0, 15), st.binary(max_size=125)),
), max_size=6))  # fmt: skip
def test_any_bytes_end_one_connection_at_the_most(sent: list[bytes]) -> None:
    async def main() -> None:
        problems: list[dict[str, Any]] = []
        asyncio.get_running_loop().set_exception_handler(lambda loop, context: problems.append(context))
        async with served() as (page, client, url):
            for beginning in (b"", handshake("localhost")):
                reader, writer = await raw(page)
                writer.write(beginning + b"".join(sent))
                writer.write_eof()
                await reader.read()
                writer.close()
            async with client.ws_connect(f"{url}ws") as watching:
                await scene_of(watching)
        assert problems == []

    run(main())


def test_who_is_gone_before_the_handshake_ends_is_no_trouble(caplog: pytest.LogCaptureFixture) -> None:
    async def main() -> None:
        async with served() as (page, client, url):
            host = f"127.0.0.1:{page.port}"
            for _ in range(20):
                somebody = socket.create_connection(("127.0.0.1", page.port))
                await asyncio.sleep(0.01)  # accepted
                somebody.sendall(handshake(host))
                somebody.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
                somebody.close()
                await asyncio.sleep(0.01)
            async with client.ws_connect(f"{url}ws") as watching:
                await scene_of(watching)
        assert not caplog.records

    run(main())


def test_somebody_who_repeats_an_offence_does_not_fill_the_log(caplog: pytest.LogCaptureFixture) -> None:
    async def main() -> None:
        async with served() as (_, client, url):
            for _ in range(100):
                assert await refused(client.ws_connect(f"{url}ws?token=wrong")) == 403
        assert len(caplog.records) <= offences.AT_ONCE + 1

    run(main())


def test_no_part_of_the_library_logs_what_a_client_sends(caplog: pytest.LogCaptureFixture) -> None:
    odd = (b"GET /ws", b"\x16\x03\x01\x02", b"POST / HTTP/1.1\r\nContent-Length: x\r\n\r\n", b"GET / HTTP/9.9\r\n\r\n")

    async def main() -> None:
        async with served() as (page, client, url):
            for sent in (*odd, handshake("localhost", "Sec-WebSocket-Protocol: EVIL\r\n")):
                reader, writer = await raw(page)
                writer.write(sent)
                writer.write_eof()
                await reader.read()
                writer.close()
            assert await refused(client.ws_connect(f"{url}ws", protocols=["EVIL"])) == 400
            async with client.get(f"{url}ws") as answer:
                assert answer.status == 400
        assert {one.name for one in caplog.records} == {LOGGER}
        assert "EVIL" not in caplog.text

    run(main())


def test_what_was_not_told_is_counted(caplog: pytest.LogCaptureFixture) -> None:
    told = offences.Offences(logging.getLogger(LOGGER))
    for _ in range(offences.AT_ONCE + 5):
        told.tell("somebody did it")
    assert len(caplog.records) == offences.AT_ONCE
    told._at -= offences.EVERY
    told.tell("somebody did it")
    assert caplog.records[-1].getMessage() == "somebody did it (5 more were not told)"


# --- too many, too slow ----------------------------------------------------------------------------------------------


def test_so_many_may_watch_and_no_more() -> None:
    async def main() -> None:
        async with served() as (_, client, url):
            watching = [await client.ws_connect(f"{url}ws") for _ in range(MOST_WATCHERS)]
            assert await refused(client.ws_connect(f"{url}ws")) == 503
            await watching[0].close()
            await asyncio.sleep(0.1)
            async with client.ws_connect(f"{url}ws") as another:
                await scene_of(another)

    run(main())


def test_connections_that_say_nothing_are_bounded_and_closed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(server, "IDLE", 0.5)

    async def main() -> None:
        async with served() as (page, client, url):
            idle = [await raw(page) for _ in range(MOST_CONNECTIONS)]
            for _, writer in idle:
                writer.write(b"GET / HTTP/1.1\r\nHost: loc")
            reader, writer = await raw(page)
            assert await reader.read() == b"", "there is no room"
            for reader, writer in idle:
                assert await reader.read() == b""
                writer.close()
            async with client.get(url) as answer:
                assert answer.status == 200

    run(main())


GET = b"GET /style.css HTTP/1.1\r\nHost: localhost\r\n\r\n"


@pytest.mark.parametrize("asked", [(GET * 2000,), (handshake("localhost"), frame_of(1, b"{"))], ids=["files", "socket"])
def test_whoever_asks_and_does_not_read_takes_the_place_of_nobody_for_long(
    asked: tuple[bytes, ...], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(server, "IDLE", 0.5)
    monkeypatch.setattr(connection, "LONGEST", 0.7)
    monkeypatch.setattr(server, "MOST_CONNECTIONS", MOST_WATCHERS)

    async def main() -> None:
        async with served(scene=Scene("x" * 120_000, "default")) as (page, client, url):
            deaf = []
            for _ in range(MOST_WATCHERS):
                one = socket.socket()
                one.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
                one.setblocking(False)
                await asyncio.get_running_loop().sock_connect(one, ("127.0.0.1", page.port))
                deaf.append(one)
            for part in asked:
                for one in deaf:
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
            for one in deaf:
                one.close()

    run(main())


def test_a_browser_that_reads_watches_for_longer_than_others_may_ask(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(server, "IDLE", 0.1)
    monkeypatch.setattr(connection, "LONGEST", 0.2)
    monkeypatch.setattr(watcher, "HEARTBEAT", 0.05)

    async def main() -> None:
        async with served() as (_, client, url), client.ws_connect(f"{url}ws") as watching:
            for _ in range(12):
                await watching.receive_str()

    run(main())


def walked(watch: Callable[[Page], Awaitable[None]] | None) -> list[Any]:
    """The events of a walk, with somebody watching in this way."""
    events: list[Any] = []

    async def main() -> None:
        session = Session(poses=True, pressures=True)
        async with served() as (page, _, _):
            if watch is not None:
                await watch(page)
            for index, packet in enumerate(insoles().packets):
                said = session.feed(packet)
                page.scene.take(packet, said)
                events.extend(said)
                if index % 20 == 0:
                    await asyncio.sleep(0)

    run(main())
    return events


async def hold(page: Page, room: int = 4096) -> None:
    """Connects and never reads."""
    reader, writer = await raw(page)
    writer.get_extra_info("socket").setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, room)
    writer.transport.pause_reading()
    writer.write(handshake("localhost"))
    await asyncio.sleep(0.1)
    HELD.append((reader, writer))


HELD: list[tuple[asyncio.StreamReader, asyncio.StreamWriter]] = []


def test_a_session_says_the_same_whoever_watches() -> None:
    alone = walked(None)
    assert walked(hold) == alone
    HELD.clear()


def test_a_browser_that_reads_slowly_is_shown_less_and_the_newest(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(watcher, "INTERVAL", 0.001)

    async def main() -> None:
        async with served() as (page, _, _):
            await hold(page, 65_536)
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
            reader, writer = HELD.pop()
            writer.transport.resume_reading()
            told = b""
            while b"the newest" not in told:
                told += await reader.read(65536)
            assert told.count(b'"type":"scene"') < shown
            writer.close()

    run(main())


def test_a_browser_that_reads_nothing_gets_nothing_more_and_is_let_go(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setattr(watcher, "PATIENCE", 0.5)
    monkeypatch.setattr(watcher, "INTERVAL", 0.001)

    async def main() -> None:
        async with served(scene=Scene("x" * 20_000, "default")) as (page, client, url):
            reader, writer = await raw(page)
            own = writer.get_extra_info("socket")
            own.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
            writer.transport.pause_reading()
            writer.write(handshake("localhost"))
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

    run(main())


def test_a_page_that_ends_says_so_and_does_not_wait_for_who_reads_nothing() -> None:
    async def main() -> None:
        async with ClientSession() as client:
            async with Page(Scene("", ""), port=0) as page:
                await hold(page)
                idle = await raw(page)
                watching = await client.ws_connect(f"{page.url.partition('#')[0]}ws")
                await scene_of(watching)
                answering = asyncio.create_task(closed(watching))
            assert await answering == 1001  # which the page takes for an end in order
            assert await idle[0].read() == b""
            HELD.clear()

    run(main())
