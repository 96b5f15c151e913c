"""Where the page listens, who may see it, and who may steer it. Gait is health data: it is for this machine, or for who
has the token."""

from __future__ import annotations

import socket
from hmac import compare_digest
from ipaddress import ip_address
from urllib.parse import urlsplit

from attrs import frozen

PORT = 8765
"""Where nobody says another one."""
EVERYWHERE = ("0.0.0.0", "::")


class AccessDenied(Exception):
    """A request that gets nothing; a sentence says why. `status`: of HTTP."""

    def __init__(self, why: str, status: int = 403) -> None:
        super().__init__(why)
        self.status = status


@frozen
class PageAccess:
    """Of a page that is served at `host` (a name or an address). `token`: what whoever steers must know."""

    host: str
    token: str

    @property
    def is_public(self) -> bool:
        """Others than this machine reach the page."""
        return not on_loopback(self.host)

    def check_host(self, host: str | None) -> None:
        """`host`: the Host header of a request. A name that somebody else can let point here is refused: a page of
        theirs could read this one (DNS rebinding). Addresses point nowhere else."""
        name = None if host is None else host_of(host)
        if name is None:
            raise AccessDenied("a request does not say to which host it is", 400)
        if not (name == "localhost" or name == self.host.lower() or is_address(name)):
            raise AccessDenied("a request is to a host that this is not")

    def check_origin(self, origins: list[str], host: str) -> None:
        """`origins`: the Origin headers, which a browser sends of the page that asks. `host`: the Host header."""
        for origin in origins:
            try:
                parts = urlsplit(origin)
            except ValueError:
                raise AccessDenied("a page with an origin that is none wants to watch") from None
            if parts.scheme not in ("http", "https") or parts.netloc.lower() != host.lower():
                raise AccessDenied("a page of another origin wants to watch")

    def may_steer(self, tokens: list[str]) -> bool:
        """`tokens`: those that a watcher shows. Without one it may watch on this machine; a wrong one is refused."""
        if not tokens:
            if self.is_public:
                raise AccessDenied("somebody without a token wants to watch from another machine")
            return False
        if len(tokens) > 1 or not compare_digest(tokens[0].encode("utf-8", "replace"), self.token.encode()):
            raise AccessDenied("somebody with a wrong token wants to watch")
        return True


def host_of(header: str) -> str | None:
    """The host in a Host header, in lower case, an IPv6 address without brackets; None where there is none."""
    try:
        parts = urlsplit(f"//{header}")
        parts.port  # noqa: B018 - ValueError of what is no port
    except ValueError:
        return None
    if parts.netloc != header or parts.username is not None or parts.path or not parts.hostname:
        return None
    return parts.hostname.lower()


def is_address(name: str) -> bool:
    """Is it an IP address rather than a name?"""
    try:
        ip_address(name)
    except ValueError:
        return False
    return True


def on_loopback(host: str) -> bool:
    """Does only this machine reach it?"""
    return host.lower() == "localhost" or (is_address(host) and ip_address(host).is_loopback)


def listen(host: str, port: int | None) -> socket.socket:
    """A socket that listens at `host`, a name or an address. `port`: 0 for any free one, None for PORT or, where that
    is taken, a free one. OSError when it cannot."""
    if port is None:
        try:
            return listen(host, PORT)
        except OSError:
            return listen(host, 0)
    name = "127.0.0.1" if host.lower() == "localhost" else host
    family, _, _, _, address = socket.getaddrinfo(name, port, type=socket.SOCK_STREAM)[0]
    both = name == "::" and socket.has_dualstack_ipv6()
    return socket.create_server((str(address[0]), port), family=family, dualstack_ipv6=both, backlog=32)


def url_host(host: str) -> str:
    """The host as in a URL; of all addresses the one by which others reach this machine."""
    if host in EVERYWHERE:
        host = _outward_address()
    return f"[{host}]" if ":" in host else host


def _outward_address() -> str:
    """This machine's address towards others; nothing is sent to find it."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        try:
            probe.connect(("192.0.2.1", 9))
        except OSError:
            return "127.0.0.1"  # no network at all
        return str(probe.getsockname()[0])
