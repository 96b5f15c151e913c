"""Serves the page: a few files, and the session's scene over one WebSocket (protocol/page.md).

    async with Page(scene) as page:
        print(page.url)
        ...                             # scene.take(packet, events), from the same event loop

It needs aiohttp (the extra `view`). The limits below were chosen by hand and not swept."""

from __future__ import annotations

import asyncio
import secrets
from collections.abc import Awaitable, Callable
from pathlib import Path
from typing import cast

from aiohttp import web

from ..messages import Command
from ..scene.scene import Scene
from .access import AccessDenied, PageAccess, listen, url_host
from .client_errors import ClientErrors
from .connection import (
    ACCEPTED_AT_ONCE,
    HEADERS,
    IDLE_TIMEOUT,
    LOGGER,
    MAX_CONNECTIONS,
    MAX_UNWATCHED_TIME,
    BrowserConnection,
    OpenConnections,
)
from .watcher import Watcher

MAX_WATCHERS = 8
"""Largest number of browsers that watch at one time."""
WAITING_CONNECTIONS = 128
"""Number of new connections that the system holds until the page accepts them."""
FILES = Path(__file__).parents[1] / "static"
CONTENT_TYPES = {"html": "text/html", "css": "text/css", "js": "text/javascript", "svg": "image/svg+xml"}


class Page:
    """Serves `scene` while the context lasts.

    `host` is where the page listens; if other machines can reach it, watchers need the token. `port` 0 means any free
    port; None means 8765 or, when that is taken, any free port. `token` is random when it is None. `commands` is called
    with each command of a watcher who has the token, and raises CommandError for one that it does not take, which ends
    the connection; None stands for a page without commands.

    A watcher gets the changes 1 to 30 times a second, less often when it reads slowly; there are at most MAX_WATCHERS.
    A watcher without the token makes room for one who has it, and an idle connection for a new one: nobody without the
    token can keep its owner out, except by hundreds of connections a second from the owner's own address.

    Entering the context raises OSError when the page cannot listen at `host` and `port`. Before that, `port` and `url`
    raise RuntimeError. Page and `scene` are for one event loop. When `scene` is replaced, as after a seek, watchers get
    the whole new scene."""

    def __init__(
        self,
        scene: Scene,
        *,
        host: str = "127.0.0.1",
        port: int | None = None,
        token: str | None = None,
        commands: Callable[[Command], None] | None = None,
    ) -> None:
        self.scene = scene
        self.commands = commands
        self.client_errors = ClientErrors(LOGGER)
        self._host = host.removeprefix("[").removesuffix("]")
        self._port = port
        self._access = PageAccess(self._host, secrets.token_urlsafe(16) if token is None else token)
        self._files = {path.name: path.read_bytes() for path in FILES.iterdir() if path.suffix[1:] in CONTENT_TYPES}
        """Content of the page's files, which may be slow to read; nothing else can be requested."""
        self._watchers: dict[Watcher, None] = {}
        """Watchers, in the order in which they came."""
        self._open = OpenConnections(MAX_CONNECTIONS)
        self._runner: web.AppRunner | None = None
        self._listening: asyncio.Server | None = None

    @property
    def port(self) -> int:
        """Port on which the page listens."""
        if self._port is None:
            raise RuntimeError("the page is not served yet")
        return self._port

    @property
    def url(self) -> str:
        """Address for a browser, with the token in the fragment, which a browser does not send."""
        return f"http://{url_host(self._host)}:{self.port}/#token={self._access.token}"

    async def __aenter__(self) -> Page:
        socket = listen(self._host, self._port)
        self._port = socket.getsockname()[1]
        app = web.Application(middlewares=[self._check])
        app.router.add_get("/ws", self._watch)
        app.router.add_get("/{name:.*}", self._file)
        app.on_response_prepare.append(_add_headers)
        runner = self._runner = web.AppRunner(app, shutdown_timeout=1.0)
        await runner.setup()

        def connect() -> BrowserConnection:
            return BrowserConnection(cast(web.Server, runner.server), self._open, self.client_errors)

        loop = asyncio.get_running_loop()
        self._listening = await loop.create_server(connect, sock=socket, backlog=ACCEPTED_AT_ONCE)
        socket.listen(WAITING_CONNECTIONS)  # the loop takes its backlog for both numbers
        return self

    async def __aexit__(self, *error: object) -> None:
        if self._listening is not None and self._runner is not None:
            self._listening.close()
            await asyncio.gather(*[watcher.end() for watcher in self._watchers], return_exceptions=True)
            await self._runner.cleanup()

    @web.middleware
    async def _check(
        self, request: web.Request, handler: Callable[[web.Request], Awaitable[web.StreamResponse]]
    ) -> web.StreamResponse:
        """Answer a request to this page; a denied one is logged."""
        cast(BrowserConnection, request.protocol).close_after(MAX_UNWATCHED_TIME)
        try:
            self._access.check_host(request.headers.get("Host", ""))
            return await handler(request)
        except AccessDenied as denied:
            self.client_errors.report(f"{denied}: turned away")
            return web.Response(status=denied.status, text=f"{denied}\n")

    async def _file(self, request: web.Request) -> web.StreamResponse:
        name = request.match_info["name"] or "index.html"
        if name not in self._files:
            raise web.HTTPNotFound
        content_type = CONTENT_TYPES[name.rpartition(".")[2]]
        return web.Response(body=self._files[name], content_type=content_type, charset="utf-8")

    async def _watch(self, request: web.Request) -> web.StreamResponse:
        if "Sec-WebSocket-Protocol" in request.headers:
            raise AccessDenied("somebody requested another protocol", 400)
        self._access.check_origin(request.headers.getall("Origin", []), request.headers["Host"])
        may_control = self._access.may_control(request.query.getall("token", []))
        if len(self._watchers) >= MAX_WATCHERS:
            self._make_room(may_control)
        watcher, connection = Watcher(self, may_control), cast(BrowserConnection, request.protocol)
        self._watchers[watcher] = None
        connection.stay_open()
        try:
            return await watcher.watch(request)
        finally:
            self._watchers.pop(watcher, None)
            connection.close_after(IDLE_TIMEOUT)

    def _make_room(self, has_token: bool) -> None:
        """Disconnect the oldest watcher without the token for one who has it; raise AccessDenied if that cannot be."""
        others = [watcher for watcher in self._watchers if not watcher.may_control]
        if not (has_token and others):
            raise AccessDenied(f"more than {MAX_WATCHERS} browsers requested to watch", 503)
        self.client_errors.report("a browser without the token made room for one that has it")
        self._watchers.pop(others[0])
        others[0].make_room()


async def _add_headers(request: web.BaseRequest, response: web.StreamResponse) -> None:
    response.headers.update(HEADERS)
