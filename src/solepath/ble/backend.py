"""Which Bluetooth to use: bleak's own choice for this machine, or another pair of classes behind its `backend=`."""

from __future__ import annotations

from attrs import frozen
from bleak.backends.client import BaseBleakClient
from bleak.backends.scanner import BaseBleakScanner


@frozen
class Backend:
    """Classes that bleak is given as `backend=` for clients and scanners; None leaves the choice to bleak."""

    client: type[BaseBleakClient] | None = None
    scanner: type[BaseBleakScanner] | None = None


NATIVE = Backend()
"""The Bluetooth of this machine."""
