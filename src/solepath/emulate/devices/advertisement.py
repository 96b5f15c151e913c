"""How much fits in an advertisement: name and service UUIDs, since a virtual radio has no scan response."""

from __future__ import annotations

from collections.abc import Sequence

ADVERTISEMENT = 31
"""Bytes of a legacy advertisement (Bluetooth Core, vol 6 part B, 2.3.1)."""
_BASE = "-0000-1000-8000-00805f9b34fb"


def check_fits(name: str, services: Sequence[str]) -> None:
    """ValueError when the complete name and all services are more than an advertisement holds."""
    short = sum(uuid.startswith("0000") and uuid.endswith(_BASE) for uuid in services)
    long = len(services) - short
    size = 2 + len(name.encode()) + (2 + 2 * short if short else 0) + (2 + 16 * long if long else 0)
    if size > ADVERTISEMENT:
        raise ValueError(f"the name {name!r} and the services make {size} bytes, {ADVERTISEMENT} fit")
