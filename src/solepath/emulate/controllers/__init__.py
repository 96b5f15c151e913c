"""Emulated devices over real Bluetooth protocols, in this process or over TCP. Needs the extra `loopback`."""

from .server import virtual_link
from .tcp import reach, serve

__all__ = ["reach", "serve", "virtual_link"]
