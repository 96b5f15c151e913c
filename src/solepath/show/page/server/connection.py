"""Limits the connections of browsers, in number and duration, and answers those that do not speak HTTP.

Nobody without the token can keep its owner out. A browser shows the token when it asks to watch; before that, its
requests look like those of anybody. Therefore a new connection is always accepted. If there are too many, another one
is closed for it: of the peer that has most, the one that did nothing for the longest time. Thus a peer with few
connections keeps them. A browser that shares its address with others, as behind one router, is answered if its request
comes before MAX_CONNECTIONS others of them. To close a random connection would not be better: a page takes a dozen
requests, and each connection would have to last. Connections that watch are counted apart (server.py). The numbers
were chosen by hand and not swept."""

from __future__ import annotations

import asyncio
import logging
import socket
from ipaddress import IPv6Address, ip_address

from aiohttp import web

from .client_errors import ClientErrors

MAX_CONNECTIONS = 192
"""Largest number of open connections at one time, apart from those that watch.

A browser 0.25 s away, a slow mobile network, is answered beside 700 new connections a second from its own address. More
would need more files than systems let a program open: 256 on macOS."""
ACCEPTED_AT_ONCE = 12
"""Largest number of connections that are accepted in one round of the event loop.

A request that came with its connection is answered within five rounds, before MAX_CONNECTIONS others can come."""
NETWORK_PREFIX = 64
"""Number of leading bits of an IPv6 address that the peer does not choose itself (RFC 4291, section 2.5.1)."""
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


class OpenConnections:
    """The open connections by peer, in the order in which they last did something, at most `limit` of them."""

    def __init__(self, limit: int) -> None:
        self._limit = limit
        self._by_peer: dict[str, dict[BrowserConnection, int]] = {}
        """Connections of each peer, the longest idle one first, each with the turn in which it did something."""
        self._turn = 0

    def __len__(self) -> int:
        return sum(map(len, self._by_peer.values()))

    def renew(self, connection: BrowserConnection) -> bool:
        """Add a connection, or move it behind all others; return whether another was closed for it."""
        own = self._by_peer.setdefault(connection.peer, {})
        own.pop(connection, None)
        self._turn += 1
        own[connection] = self._turn
        if len(self) <= self._limit:
            return False
        largest = max(self._by_peer.values(), key=lambda those: (len(those), -next(iter(those.values()))))
        oldest = next(iter(largest))
        self.remove(oldest)
        oldest.close_now()
        return True

    def remove(self, connection: BrowserConnection) -> None:
        """Remove a connection, if it is there."""
        own = self._by_peer.get(connection.peer, {})
        own.pop(connection, None)
        if not own:
            self._by_peer.pop(connection.peer, None)


def peer_of(address: object) -> str:
    """Return the peer to which a connection from `address` counts: an IPv4 address, or the network of an IPv6 one."""
    host = address[0] if isinstance(address, tuple) and address else ""
    try:
        parsed = ip_address(str(host).partition("%")[0])
    except ValueError:
        return str(host)
    if not isinstance(parsed, IPv6Address):
        return str(parsed)
    if parsed.ipv4_mapped is not None:
        return str(parsed.ipv4_mapped)
    return f"{IPv6Address(int(parsed) >> NETWORK_PREFIX << NETWORK_PREFIX)}/{NETWORK_PREFIX}"
