"""Limits the connections of browsers that have not shown the token, so that nobody can keep its owner out.

A browser shows the token when it asks to watch; before that, its requests look like those of anybody. Therefore a new
connection is always accepted. If there are too many, another one is closed for it: of the peer that has most, the one
that did nothing for the longest time. Thus a peer with few connections keeps them. A browser that shares its address
with others, as behind one router, is answered if its request comes before MAX_CONNECTIONS others of them. To close a
random connection would not be better: a page takes a dozen requests, and each connection would have to last.
Connections that watch are counted apart (server.py)."""

from __future__ import annotations

from ipaddress import IPv6Address, ip_address
from typing import Protocol

MAX_CONNECTIONS = 192
"""Largest number of open connections at one time, apart from those that watch.

A browser 0.25 s away, a slow mobile network, is answered beside 700 new connections a second from its own address. More
would need more files than systems let a program open: 256 on macOS."""
ACCEPTED_AT_ONCE = 12
"""Largest number of connections that are accepted in one round of the event loop.

A request that came with its connection is answered within five rounds, before MAX_CONNECTIONS others can come."""
NETWORK_PREFIX = 64
"""Number of leading bits of an IPv6 address that the peer does not choose itself (RFC 4291, section 2.5.1)."""


class Closable(Protocol):
    """A connection that can be closed."""

    @property
    def peer(self) -> str:
        """Peer to which the connection counts."""

    def close_now(self) -> None:
        """Close the connection at once."""


class OpenConnections:
    """The open connections by peer, in the order in which they last did something, at most `limit` of them."""

    def __init__(self, limit: int) -> None:
        self._limit = limit
        self._by_peer: dict[str, dict[Closable, int]] = {}
        """Connections of each peer, the longest idle one first, each with the turn in which it did something."""
        self._turn = 0

    def __len__(self) -> int:
        return sum(map(len, self._by_peer.values()))

    def renew(self, connection: Closable) -> bool:
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

    def remove(self, connection: Closable) -> None:
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
