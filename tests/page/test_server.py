"""Tests the server of the page: what it sends, who may watch, and who may control."""

from __future__ import annotations

import asyncio
import json
import re
from importlib.resources import files
from urllib.parse import urlsplit

import pytest
from aiohttp import WSCloseCode, WSMsgType
from served import LOGGER, TOKEN, close_code, fetch_reply, rejection_status, scene_of, served

from solepath import LinkTrouble, Site
from solepath.show.page.messages import Command
from solepath.show.page.scene.scene import Scene
from solepath.show.page.server import server
from solepath.show.page.server.access import on_loopback, url_host
from solepath.show.page.server.connection import HEADERS
from solepath.show.page.server.server import Page


async def test_a_watcher_gets_a_message_every_second_even_when_nothing_happens() -> None:
    async with served() as (_, client, url), client.ws_connect(f"{url}ws") as watching:
        await scene_of(watching)
        assert json.loads(await watching.receive_str()) == {"type": "frame", "t": 0.0}


async def test_what_came_last_is_shown_before_the_end() -> None:
    """Such as the events of a session that is finished, after which the page closes."""
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


async def test_the_page_is_made_of_the_files_that_are_installed_and_names_no_other_server() -> None:
    static = files("solepath.show.page") / "static"
    async with served() as (_, client, url):
        for name in ("", *(one.name for one in static.iterdir())):
            async with client.get(url + name) as answer:
                assert answer.status == 200, name
                assert answer.headers.items() >= HEADERS.items()
                kind = answer.headers["Content-Type"].partition(";")[0]
                assert kind == server.CONTENT_TYPES[(name or "index.html").rpartition(".")[2]]
                text = (await answer.read()).decode()
            assert not re.search("https:(?![\"'])|//cdn", text)


@pytest.mark.parametrize(
    "path", ["../server.py", "..%2fserver.py", "%2e%2e/server.py", "/etc/passwd", "static/index.html", "index.html/"]
)
async def test_there_are_no_other_files(path: str) -> None:
    async with served() as (page, _, _):
        answer = await fetch_reply(
            page, f"GET /{path} HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n".encode()
        )
        assert answer.split(b" ")[1] in (b"404", b"400")


@pytest.mark.parametrize("method", ["POST", "PUT", "DELETE", "OPTIONS"])
async def test_files_can_only_be_got(method: str) -> None:
    async with served() as (_, client, url), client.request(method, url, data=b"x" * 100_000) as answer:
        assert answer.status == 405


@pytest.mark.parametrize(
    "sent", [b"EVIL\r\n\r\n", b"GET / HTTP/9.9 EVIL\r\n\r\n", b"POST / HTTP/1.1\r\nContent-Length: EVIL\r\n\r\n",
             b"GET / HTTP/1.1\r\nHost: localhost\r\nEVIL\r\n\r\n", b"GET / HTTP/1.1\r\nX: " + b"EVIL" * 9000],
)  # fmt: skip
async def test_what_is_no_request_is_answered_with_the_headers_of_every_answer_and_none_of_its_words(
    sent: bytes,
) -> None:
    async with served() as (page, _, _):
        for prefix in (b"", b"GET / HTTP/1.1\r\nHost: localhost\r\n\r\n"):
            _, rejection, answer = (await fetch_reply(page, prefix + sent)).partition(b" 400 Bad Request")
            assert rejection and b"EVIL" not in answer
            assert b"aiohttp" not in answer and b"Python" not in answer
            for name, value in HEADERS.items():
                assert f"\r\n{name}: {value}\r\n".encode() in answer


async def test_the_page_is_for_this_machine_by_default() -> None:
    async with Page(Scene("", ""), port=0) as page:
        assert urlsplit(page.url).hostname == "127.0.0.1"
        (listening,) = page._listening.sockets if page._listening is not None else ()
        assert listening.getsockname()[0] == "127.0.0.1"


async def test_who_has_the_token_steers() -> None:
    commands: list[Command] = []
    async with served(commands=commands.append) as (_, client, url):
        async with client.ws_connect(f"{url}ws?token={TOKEN}") as watching:
            assert (await scene_of(watching))["control"] is True
            for text in ('{"do":"pause"}', '{"do":"seek","value":3}', '{"do":"speed","value":4.0}'):
                await watching.send_str(text)
            while len(commands) < 3:
                await asyncio.sleep(0.01)
        assert commands == [Command("pause"), Command("seek", 3.0), Command("speed", 4.0)]


@pytest.mark.parametrize(("plays", "query"), [(True, ""), (False, f"?token={TOKEN}")])
async def test_who_has_no_token_or_nothing_to_play_watches_and_is_shown_out_on_trying_to_steer(
    plays: bool, query: str, caplog: pytest.LogCaptureFixture
) -> None:
    commands: list[Command] = []
    on_command = commands.append if plays else None
    async with served(commands=on_command) as (_, client, url), client.ws_connect(f"{url}ws{query}") as watching:
        assert (await scene_of(watching))["control"] is False
        await watching.send_str('{"do":"pause"}')
        assert await close_code(watching) == 1008
    assert commands == []
    assert [one.name for one in caplog.records] == [LOGGER]


@pytest.mark.parametrize("query", ["token=wrong", "token=", f"token={TOKEN}&token=wrong", "token=%ff", "token=%f0%9f"])
async def test_a_wrong_token_is_rejected(query: str, caplog: pytest.LogCaptureFixture) -> None:
    async with served() as (_, client, url):
        assert await rejection_status(client.ws_connect(f"{url}ws?{query}")) == 403
    assert len(caplog.records) == 1


@pytest.mark.parametrize("origin", ["http://evil.example", "http://127.0.0.1:1", "null", "file://", "http://[", ""])
async def test_pages_of_others_may_not_watch(origin: str, caplog: pytest.LogCaptureFixture) -> None:
    async with served() as (_, client, url):
        assert await rejection_status(client.ws_connect(f"{url}ws?token={TOKEN}", headers={"Origin": origin})) == 403
    assert len(caplog.records) == 1


@pytest.mark.parametrize(
    ("host", "status"),
    [
        ("evil.example", b"403"), ("evil.example:80", b"403"), ("127.0.0.1.evil.example", b"403"),
        ("a@localhost", b"403"), ("localhost/x", b"403"), ("", b"403"), ("localhost:x", b"403"), ("[::1", b"403"),
        ("localhost", b"200"), ("LOCALHOST:1", b"200"), ("[::1]:99", b"200"), ("192.168.1.7", b"200"),
    ],
)  # fmt: skip
async def test_a_name_that_somebody_else_could_point_here_is_no_host(host: str, status: bytes) -> None:
    async with served() as (page, _, _):
        answer = await fetch_reply(page, f"GET / HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n\r\n".encode())
        assert answer.split(b" ")[1] == status


async def test_beyond_this_machine_nobody_watches_without_the_token() -> None:
    async with served(host="0.0.0.0") as (page, client, _):
        url = f"http://127.0.0.1:{page.port}/"
        assert await rejection_status(client.ws_connect(f"{url}ws")) == 403
        async with client.ws_connect(f"{url}ws?token={TOKEN}") as watching:
            await scene_of(watching)
        assert not on_loopback(urlsplit(page.url).hostname or "") or url_host("0.0.0.0") == "127.0.0.1"
