"""Connections to the page: how long they may last, and the answer to one that does not speak HTTP."""

from __future__ import annotations

import asyncio
import logging
import socket
from collections.abc import Iterator
from contextlib import contextmanager
from typing import cast

from aiohttp import web

LONGEST = 30.0
"""Time that a connection may last on which nobody watches, whatever it requests and however slowly it reads, s."""
BACKLOG = 65_536
"""Bytes that the system buffers for a slow reader: some seconds of frames."""
HEADERS = {
    "Content-Security-Policy": "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; "
    "connect-src 'self'; base-uri 'none'; frame-ancestors 'none'",
    "Cross-Origin-Resource-Policy": "same-origin",
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cache-Control": "no-store",
    "Server": "solepath",  # else the library sends its version and that of Python
}


class BrowserConnection(web.RequestHandler):
    """A connection of a browser, with limits on its time.

    `has_requested` says that it has sent a request. Before that, and after watching, it may last for `idle` s only."""

    __slots__ = ("has_requested", "_timers", "_idle", "_output", "_watches")

    def __init__(self, server: web.Server, idle: float) -> None:
        silent = logging.getLogger("solepath.show.page.http")
        silent.disabled = True  # the library logs a traceback for every malformed request
        super().__init__(
            server,
            loop=asyncio.get_running_loop(),
            keepalive_timeout=idle,
            lingering_time=0.0,
            access_log=None,  # type: ignore[arg-type] # there is none
            logger=silent,
        )
        self.has_requested = self._watches = False
        self._idle = idle
        self._timers: list[asyncio.TimerHandle] = []
        self._output: asyncio.WriteTransport | None = None

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """Limit the send buffer, and start the timers of the connection."""
        super().connection_made(transport)
        accepted = transport.get_extra_info("socket")
        if accepted is not None:
            accepted.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, BACKLOG)
        self._output = cast(asyncio.WriteTransport, transport)
        # the library ends only connections that have sent a request, and none in the middle of an answer
        self._end_in(self._idle, unless_requested=True)
        self._end_in(LONGEST)

    def connection_lost(self, exc: BaseException | None) -> None:
        """Cancel the timers."""
        for end in self._timers:
            end.cancel()
        self._output = None
        super().connection_lost(exc)

    @contextmanager
    def watching(self) -> Iterator[None]:
        """Let the connection last for as long as it likes within the context, in which a browser watches on it."""
        self._watches = True
        try:
            yield
        finally:
            self._watches = False
            self._end_in(self._idle)

    def _end_in(self, seconds: float, unless_requested: bool = False) -> None:
        if self._output is not None:
            self._timers.append(asyncio.get_running_loop().call_later(seconds, self._end, unless_requested))

    def _end(self, unless_requested: bool) -> None:
        if self._output is not None and not self._watches and not (unless_requested and self.has_requested):
            self._output.abort()  # close() would wait until all was read

    def handle_error(
        self, request: web.BaseRequest, status: int = 500, exc: BaseException | None = None, message: str | None = None
    ) -> web.StreamResponse:
        """Answer an error with a fixed text; the library's own answer repeats words of the sender."""
        if request.writer.output_size > 0:
            raise ConnectionError("a part of an answer was sent already")
        answer = web.Response(status=status, text="that cannot be answered\n", headers=HEADERS)
        answer.force_close()
        return answer


class ImmediateClose(asyncio.Protocol):
    """Protocol that closes each connection at once."""

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """Close the connection."""
        transport.close()
