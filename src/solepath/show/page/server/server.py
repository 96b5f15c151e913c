"""Serves the page: a few files, and the session's scene over one WebSocket (protocol/page.md).

    async with Page(scene) as page:
        print(page.url)
        ...                             # scene.take(packet, events), from the same event loop

It needs aiohttp (the extra `view`). The limits below were chosen by hand and not swept."""

from __future__ import annotations

import asyncio
import logging
import secrets
from collections.abc import Callable
from importlib.resources import files
from importlib.resources.abc import Traversable
from typing import cast

from aiohttp import web

from ..messages import Command
from ..scene.scene import Scene
from .access import AccessDenied, PageAccess, listen, url_host
from .client_errors import ClientErrors
from .connection import HEADERS, BrowserConnection
from .open_connections import ACCEPTED_AT_ONCE, MAX_CONNECTIONS, OpenConnections
from .watcher import Watcher

MAX_WATCHERS = 8
"""Largest number of browsers that watch at one time."""
IDLE_TIMEOUT = 5.0
"""Time after which a connection without a complete request is closed, s."""
WAITING_CONNECTIONS = 128
"""Number of new connections that the system holds until the page accepts them."""
METHODS = ("GET", "HEAD")
CONTENT_TYPES = {".html": "text/html", ".css": "text/css", ".js": "text/javascript", ".svg": "image/svg+xml"}


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
        self.client_errors = ClientErrors(logging.getLogger("solepath.show.page"))
        self._host = host.removeprefix("[").removesuffix("]")
        self._port = port
        self._access = PageAccess(self._host, secrets.token_urlsafe(16) if token is None else token)
        self._files = _files(files("solepath.show.page") / "static")
        self._watchers: dict[Watcher, None] = {}
        """Watchers, in the order in which they came."""
        self._open = OpenConnections(MAX_CONNECTIONS)
        self._server: web.Server | None = None
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
        self._server = web.Server(self._answer)
        loop = asyncio.get_running_loop()
        self._listening = await loop.create_server(self._connect, sock=socket, backlog=ACCEPTED_AT_ONCE)
        socket.listen(WAITING_CONNECTIONS)  # the loop takes its backlog for both numbers
        return self

    async def __aexit__(self, *error: object) -> None:
        if self._listening is not None:
            self._listening.close()
        if self._server is not None:
            self._server.pre_shutdown()
            await asyncio.gather(*[watcher.end() for watcher in self._watchers], return_exceptions=True)
            await self._server.shutdown(1.0)

    def _connect(self) -> asyncio.BaseProtocol:
        """Return the protocol for a new connection."""
        if self._server is None:
            raise RuntimeError("the page is not served yet")
        return BrowserConnection(self._server, IDLE_TIMEOUT, self._open, self.client_errors)

    async def _answer(self, request: web.BaseRequest) -> web.StreamResponse:
        connection = cast(BrowserConnection, request.protocol)
        connection.handle_request()
        try:
            host = request.headers.get("Host")
            self._access.check_host(host)
            if request.method not in METHODS:
                return web.Response(status=405, headers={**HEADERS, "Allow": ", ".join(METHODS)})
            if request.path == "/ws":
                return await self._watched(request, connection, host or "")
            return self._file(request)
        except AccessDenied as denied:
            self.client_errors.report(f"{denied}: turned away")
            return web.Response(status=denied.status, text=f"{denied}\n", headers=HEADERS)
        except ConnectionError:
            return web.Response(headers=HEADERS)  # the client has gone, so nobody gets it
        except Exception:
            logging.getLogger("solepath.show.page").exception("the page could not answer")
            return web.Response(status=500, headers=HEADERS)

    def _file(self, request: web.BaseRequest) -> web.Response:
        file = self._files.get("index.html" if request.path == "/" else request.path.removeprefix("/"))
        if file is None:
            return web.Response(status=404, text="there is no such file\n", headers=HEADERS)
        body, content_type = file
        return web.Response(body=body, content_type=content_type, charset="utf-8", headers=HEADERS)

    async def _watched(self, request: web.BaseRequest, connection: BrowserConnection, host: str) -> web.StreamResponse:
        if request.method != "GET":
            raise AccessDenied("a request for the socket is none for a WebSocket", 400)
        if "Sec-WebSocket-Protocol" in request.headers:
            raise AccessDenied("somebody requested another protocol", 400)
        self._access.check_origin(request.headers.getall("Origin", []), host)
        may_control = self._access.may_control(request.query.getall("token", []))
        if len(self._watchers) >= MAX_WATCHERS:
            self._make_room(may_control)
        watcher = Watcher(self, may_control)
        self._watchers[watcher] = None
        try:
            with connection.watching():
                return await watcher.watch(request)
        finally:
            self._watchers.pop(watcher, None)

    def _make_room(self, has_token: bool) -> None:
        """Disconnect the oldest watcher without the token for one who has it; raise AccessDenied if that cannot be."""
        others = [watcher for watcher in self._watchers if not watcher.may_control]
        if not (has_token and others):
            raise AccessDenied(f"more than {MAX_WATCHERS} browsers requested to watch", 503)
        self.client_errors.report("a browser without the token made room for one that has it")
        self._watchers.pop(others[0])
        others[0].make_room()


def _files(folder: Traversable) -> dict[str, tuple[bytes, str]]:
    """Return content and content type of each file of the page by its name; nothing else can be requested."""
    contents = {}
    for file in folder.iterdir():
        content_type = CONTENT_TYPES.get(f".{file.name.rpartition('.')[2]}")
        if content_type is not None and file.is_file():
            contents[file.name] = (file.read_bytes(), content_type)
    return contents
