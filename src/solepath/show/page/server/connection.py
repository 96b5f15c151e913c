"""Whoever has connected to the page: for how long, and what it is told where it does not speak HTTP."""

from __future__ import annotations

import asyncio
import logging
import socket
from collections.abc import Iterator
from contextlib import contextmanager
from typing import cast

from aiohttp import web

LONGEST = 30.0
"""s that a connection may last on which nobody watches, whatever it asks for and however slowly it reads."""
BACKLOG = 65_536
"""Bytes that the system holds back for whoever reads slowly: some seconds of frames."""
HEADERS = {
    "Content-Security-Policy": "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; "
    "connect-src 'self'; base-uri 'none'; frame-ancestors 'none'",
    "Cross-Origin-Resource-Policy": "same-origin",
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cache-Control": "no-store",
    "Server": "solepath",  # or the library tells its version and that of Python
}


class BrowserConnection(web.RequestHandler):
    """`asked`: it has asked for something once; before, and after watching, it may last for `idle` s only."""

    __slots__ = ("asked", "_ends", "_idle", "_to", "_watches")

    def __init__(self, server: web.Server, idle: float) -> None:
        silent = logging.getLogger("solepath.show.page.http")
        silent.disabled = True  # the library has a traceback for every request that is none
        super().__init__(
            server,
            loop=asyncio.get_running_loop(),
            keepalive_timeout=idle,
            lingering_time=0.0,
            access_log=None,  # type: ignore[arg-type] # there is none
            logger=silent,
        )
        self.asked = self._watches = False
        self._idle = idle
        self._ends: list[asyncio.TimerHandle] = []
        self._to: asyncio.WriteTransport | None = None

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        super().connection_made(transport)
        accepted = transport.get_extra_info("socket")
        if accepted is not None:
            accepted.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, BACKLOG)
        self._to = cast(asyncio.WriteTransport, transport)
        # the library sees to those only that have asked for something, and not to what is in the middle of an answer
        self._end_in(self._idle, unless_asked=True)
        self._end_in(LONGEST)

    def connection_lost(self, exc: BaseException | None) -> None:
        for end in self._ends:
            end.cancel()
        self._to = None
        super().connection_lost(exc)

    @contextmanager
    def watching(self) -> Iterator[None]:
        """A browser watches on it within, for as long as it likes."""
        self._watches = True
        try:
            yield
        finally:
            self._watches = False
            self._end_in(self._idle)

    def _end_in(self, seconds: float, unless_asked: bool = False) -> None:
        if self._to is not None:
            self._ends.append(asyncio.get_running_loop().call_later(seconds, self._end, unless_asked))

    def _end(self, unless_asked: bool) -> None:
        if self._to is not None and not self._watches and not (unless_asked and self.asked):
            self._to.abort()  # to close it would wait until all was read

    def handle_error(
        self, request: web.BaseRequest, status: int = 500, exc: BaseException | None = None, message: str | None = None
    ) -> web.StreamResponse:
        """The library's own answers tell what was wrong with words of whoever has sent it; this does not."""
        if request.writer.output_size > 0:
            raise ConnectionError("a part of an answer was sent already")
        answer = web.Response(status=status, text="that cannot be answered\n", headers=HEADERS)
        answer.force_close()
        return answer


class NoRoom(asyncio.Protocol):
    """Hangs up at once."""

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        transport.close()
