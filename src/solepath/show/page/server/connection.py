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

    `has_requested` says that the browser has sent a request. Before that, and after watching, the connection may last
    for another `idle` s only."""

    __slots__ = ("has_requested", "_timers", "_idle", "_output", "_is_watched")

    def __init__(self, server: web.Server, idle: float) -> None:
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
        self.has_requested = self._is_watched = False
        self._idle = idle
        self._timers: list[asyncio.TimerHandle] = []
        self._output: asyncio.WriteTransport | None = None

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """Limit the send buffer, and start the timers of the connection."""
        super().connection_made(transport)
        accepted = transport.get_extra_info("socket")
        if accepted is not None:
            accepted.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, SEND_BUFFER_SIZE)
        self._output = cast(asyncio.WriteTransport, transport)
        # the library itself never ends a connection without a request, nor one in the middle of an answer
        self._end_in(self._idle, unless_requested=True)
        self._end_in(MAX_UNWATCHED_TIME)

    def connection_lost(self, exc: BaseException | None) -> None:
        """Cancel the timers."""
        for timer in self._timers:
            timer.cancel()
        self._output = None
        super().connection_lost(exc)

    @contextmanager
    def watching(self) -> Iterator[None]:
        """Lift the limits on the duration within the context, in which a browser watches on the connection."""
        self._is_watched = True
        try:
            yield
        finally:
            self._is_watched = False
            self._end_in(self._idle)

    def _end_in(self, seconds: float, unless_requested: bool = False) -> None:
        if self._output is not None:
            self._timers.append(asyncio.get_running_loop().call_later(seconds, self._end, unless_requested))

    def _end(self, unless_requested: bool) -> None:
        if self._output is not None and not self._is_watched and not (unless_requested and self.has_requested):
            self._output.abort()  # close() would wait until the browser has read everything

    def handle_error(
        self, request: web.BaseRequest, status: int = 500, exc: BaseException | None = None, message: str | None = None
    ) -> web.StreamResponse:
        """Answer an error with a fixed text; the library's answer would repeat words of the sender."""
        if request.writer.output_size > 0:
            raise ConnectionError("a part of an answer was sent already")
        answer = web.Response(status=status, text="that cannot be answered\n", headers=HEADERS)
        answer.force_close()
        return answer


class ImmediateClose(asyncio.Protocol):
    """A protocol that closes each connection at once."""

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """Close the connection."""
        transport.close()
