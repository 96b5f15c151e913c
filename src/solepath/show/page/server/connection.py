"""Limits the duration of connections to the page, and answers those that do not speak HTTP.

The numbers were chosen by hand and not swept."""

from __future__ import annotations

import asyncio
import logging
import socket

from aiohttp import web

from .client_errors import ClientErrors
from .open_connections import OpenConnections, peer_of

IDLE_TIMEOUT = 5.0
"""Time after which a connection without a complete request is closed, s."""
MAX_UNWATCHED_TIME = 30.0
"""Longest time from a request to the next on a connection on which nobody watches, s, however slowly it is read."""
SEND_BUFFER_SIZE = 65_536
"""Size of the system's send buffer for a slow browser, bytes: some seconds of frames."""
LOGGER = logging.getLogger("solepath.show.page")
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

    Unless a browser watches on it, it is one of the `open_connections`, and may be closed for another."""

    __slots__ = ("peer", "_open", "_client_errors", "_timer")

    def __init__(self, server: web.Server, open_connections: OpenConnections, client_errors: ClientErrors) -> None:
        silent = logging.getLogger("solepath.show.page.http")
        silent.disabled = True  # the library logs a traceback for every malformed request
        super().__init__(
            server,
            loop=asyncio.get_running_loop(),
            keepalive_timeout=IDLE_TIMEOUT,
            lingering_time=0.0,
            access_log=None,  # type: ignore[arg-type]
            logger=silent,
        )
        self.peer = ""
        self._open, self._client_errors = open_connections, client_errors
        self._timer: asyncio.TimerHandle | None = None

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """Limit the send buffer and the time to the first request."""
        super().connection_made(transport)
        transport.get_extra_info("socket").setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, SEND_BUFFER_SIZE)
        self.peer = peer_of(transport.get_extra_info("peername"))
        self.close_after(IDLE_TIMEOUT)

    def connection_lost(self, exc: BaseException | None) -> None:
        """Cancel the limit, and count the connection no more."""
        self.stay_open()
        super().connection_lost(exc)

    def close_after(self, seconds: float) -> None:
        """Count the connection as the one that did something last, and limit the time to what it does next, s."""
        self.stay_open()
        if self.transport is None:
            return
        if self._open.renew(self):
            self._client_errors.report("too many connections at once: one that did nothing is closed for a new one")
        self._timer = asyncio.get_running_loop().call_later(seconds, self.close_now)

    def stay_open(self) -> None:
        """Lift the limits: a browser watches on the connection."""
        self._open.remove(self)
        if self._timer is not None:
            self._timer.cancel()

    def close_now(self) -> None:
        """Close the connection; what the system was given to send still reaches a browser that reads."""
        if self.transport is not None:
            self.transport.abort()  # close() would wait until the browser has read everything

    def handle_error(
        self, request: web.BaseRequest, status: int = 500, exc: BaseException | None = None, message: str | None = None
    ) -> web.StreamResponse:
        """Answer an error with a fixed text; the library's answer would repeat words of the sender."""
        if status == 500 and not isinstance(exc, ConnectionError):
            LOGGER.error("the page could not answer", exc_info=exc)
        if request.writer.output_size > 0:
            raise ConnectionError("a part of an answer was sent already")
        answer = web.Response(status=status, text="that cannot be answered\n", headers=HEADERS)
        answer.force_close()
        return answer
