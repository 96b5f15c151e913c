"""Limits the duration of connections to the page, and answers those that do not speak HTTP.

The two numbers were chosen by hand and not swept."""

from __future__ import annotations

import asyncio
import logging
import socket
from collections.abc import Iterator
from contextlib import contextmanager
from typing import cast

from aiohttp import web

from .client_errors import ClientErrors
from .open_connections import OpenConnections, peer_of

MAX_UNWATCHED_TIME = 30.0
"""Longest duration of a connection on which nobody watches, s; it does not depend on requests or reading speed."""
SEND_BUFFER_SIZE = 65_536
"""Size of the system's send buffer for a slow browser, bytes: some seconds of frames."""
HEADERS = {
    "Content-Security-Policy": "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; "
    "connect-src 'self'; base-uri 'none'; frame-ancestors 'none'",
    "Cross-Origin-Resource-Policy": "same-origin",
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cache-Control": "no-store",
    "Server": "solepath",  # without this the library sends its version and that of Python
}


class BrowserConnection(web.RequestHandler):
    """A connection of a browser, with limits on its duration.

    Before its first request, and after watching, it may last for another `idle` s only. Unless a browser watches on it,
    it is one of the `open_connections`, and may be closed for another."""

    __slots__ = ("peer", "_open", "_client_errors", "_timers", "_idle", "_output", "_has_requested", "_is_watched")

    def __init__(
        self, server: web.Server, idle: float, open_connections: OpenConnections, client_errors: ClientErrors
    ) -> None:
        silent = logging.getLogger("solepath.show.page.http")
        silent.disabled = True  # the library logs a traceback for every malformed request
        super().__init__(
            server,
            loop=asyncio.get_running_loop(),
            keepalive_timeout=idle,
            lingering_time=0.0,
            access_log=None,  # type: ignore[arg-type]
            logger=silent,
        )
        self.peer = ""
        self._open, self._client_errors = open_connections, client_errors
        self._has_requested = self._is_watched = False
        self._idle = idle
        self._timers: list[asyncio.TimerHandle] = []
        self._output: asyncio.WriteTransport | None = None

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """Limit the send buffer, count the connection, and start its timers."""
        super().connection_made(transport)
        accepted = transport.get_extra_info("socket")
        if accepted is not None:
            accepted.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, SEND_BUFFER_SIZE)
        self._output = cast(asyncio.WriteTransport, transport)
        self.peer = peer_of(transport.get_extra_info("peername"))
        self._renew()
        # the library itself never ends a connection in the middle of an answer
        self._end_in(self._idle, unless_requested=True)
        self._end_in(MAX_UNWATCHED_TIME)

    def connection_lost(self, exc: BaseException | None) -> None:
        """Cancel the timers, and count the connection no more."""
        for timer in self._timers:
            timer.cancel()
        self._output = None
        self._open.remove(self)
        super().connection_lost(exc)

    def handle_request(self) -> None:
        """Note that the browser has sent a whole request."""
        self._has_requested = True
        self._renew()

    @contextmanager
    def watching(self) -> Iterator[None]:
        """Lift the limits within the context, in which a browser watches on the connection."""
        self._is_watched = True
        self._open.remove(self)
        try:
            yield
        finally:
            self._is_watched = False
            self._renew()
            self._end_in(self._idle)

    def close_for_another(self) -> None:
        """Close the connection at once; what was sent still reaches a browser that reads."""
        if self._output is None:
            return
        if self._output.get_write_buffer_size() > 0:
            self._output.abort()  # close() would wait until the browser has read everything
        else:
            self._output.close()

    def _renew(self) -> None:
        if self._output is not None and self._open.renew(self):
            self._client_errors.report("too many connections at once: one that did nothing is closed for a new one")

    def _end_in(self, seconds: float, unless_requested: bool = False) -> None:
        if self._output is not None:
            self._timers.append(asyncio.get_running_loop().call_later(seconds, self._end, unless_requested))

    def _end(self, unless_requested: bool) -> None:
        if self._output is not None and not self._is_watched and not (unless_requested and self._has_requested):
            self._output.abort()

    def handle_error(
        self, request: web.BaseRequest, status: int = 500, exc: BaseException | None = None, message: str | None = None
    ) -> web.StreamResponse:
        """Answer an error with a fixed text; the library's answer would repeat words of the sender."""
        if request.writer.output_size > 0:
            raise ConnectionError("a part of an answer was sent already")
        answer = web.Response(status=status, text="that cannot be answered\n", headers=HEADERS)
        answer.force_close()
        return answer
