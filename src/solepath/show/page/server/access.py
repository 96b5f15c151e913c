"""Decides where the page listens, who may see it, and who may control it.

Gait is health data: a page that other machines can reach is shown only to watchers with the token. Control always needs
the token."""

from __future__ import annotations

import re
import socket
from hmac import compare_digest
from ipaddress import ip_address

from attrs import frozen

DEFAULT_PORT = 8765
"""Port that is used when none is named."""
HOST = re.compile(r"(\[.*\]|[^:]*)(:[0-9]*)?")
"""Host header: a name or an address, an IPv6 address in brackets, and a port."""
ALL_ADDRESSES = ("0.0.0.0", "::")


class AccessDenied(Exception):
    """A request that is rejected; the message says why, `status` is the HTTP status."""

    def __init__(self, reason: str, status: int = 403) -> None:
        super().__init__(reason)
        self.status = status


@frozen
class PageAccess:
    """The access to a page that is served at `host`, a name or an address; whoever knows `token` may control it."""

    host: str
    token: str

    @property
    def is_public(self) -> bool:
        """True if other machines than this one can reach the page."""
        return not on_loopback(self.host)

    def check_host(self, header: str) -> None:
        """Check the Host header of a request; raise AccessDenied for a name that is not this page's.

        Otherwise an attacker's web page, whose name the attacker lets resolve to this machine, could read this page
        (DNS rebinding). A request to an IP address involves no name, so that it is accepted."""
        parts = HOST.fullmatch(header.lower())
        name = "" if parts is None else parts[1].strip("[]")
        if not (name in ("localhost", self.host.lower()) or is_address(name)):
            raise AccessDenied("a request names another host than this page's")

    def check_origin(self, origins: list[str], host: str) -> None:
        """Check the Origin headers, in which a browser names the requesting page, against the Host header."""
        if any([origin.lower() not in (f"http://{host}".lower(), f"https://{host}".lower()) for origin in origins]):
            raise AccessDenied("a page of another origin requested to watch")

    def may_control(self, tokens: list[str]) -> bool:
        """Return whether a watcher that sends these tokens may control the page.

        A watcher without a token may watch, but not control, a page that only this machine can reach. AccessDenied is
        raised for a wrong token, and for a missing one if other machines can reach the page."""
        if not tokens:
            if self.is_public:
                raise AccessDenied("somebody without a token requested to watch from another machine")
            return False
        if len(tokens) > 1 or not compare_digest(tokens[0].encode("utf-8", "replace"), self.token.encode()):
            raise AccessDenied("somebody with a wrong token requested to watch")
        return True


def is_address(name: str) -> bool:
    """Return whether the name is an IP address."""
    try:
        ip_address(name)
    except ValueError:
        return False
    return True


def on_loopback(host: str) -> bool:
    """Return whether only this machine can reach the host."""
    return host.lower() == "localhost" or (is_address(host) and ip_address(host).is_loopback)


def listen(host: str, port: int | None) -> socket.socket:
    """Return a socket that listens at `host`, a name or an address; raise OSError when it cannot.

    Port 0 stands for any free port; None for DEFAULT_PORT or, when that is taken, any free port."""
    if port is None:
        try:
            return listen(host, DEFAULT_PORT)
        except OSError:
            return listen(host, 0)
    name = "127.0.0.1" if host.lower() == "localhost" else host
    family, _, _, _, address = socket.getaddrinfo(name, port, type=socket.SOCK_STREAM)[0]
    dual_stack = name == "::" and socket.has_dualstack_ipv6()
    return socket.create_server((str(address[0]), port), family=family, dualstack_ipv6=dual_stack, backlog=32)


def url_host(host: str) -> str:
    """Return `host` as in a URL; a wildcard address becomes the address by which other machines reach this one."""
    if host in ALL_ADDRESSES:
        host = _outward_address()
    return f"[{host}]" if ":" in host else host


def _outward_address() -> str:
    """Return the address by which other machines reach this one, found without sending anything."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        try:
            probe.connect(("192.0.2.1", 9))
        except OSError:
            return "127.0.0.1"  # no network at all
        return str(probe.getsockname()[0])
