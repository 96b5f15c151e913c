"""Where the page listens, and how somebody reaches it."""

from __future__ import annotations

import socket

PORT = 8765
"""Where nobody says another one."""
EVERYWHERE = ("0.0.0.0", "::")


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


def reached_at(host: str) -> str:
    """The host as in a URL; of all addresses the one by which others reach this machine."""
    if host in EVERYWHERE:
        host = _outward()
    return f"[{host}]" if ":" in host else host


def _outward() -> str:
    """This machine's address towards others; nothing is sent to find it."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        try:
            probe.connect(("192.0.2.1", 9))
        except OSError:
            return "127.0.0.1"  # no network at all
        return str(probe.getsockname()[0])
