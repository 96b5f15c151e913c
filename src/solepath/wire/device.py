"""The battery level, a standard GATT value that any device may have.

The other standard value, the firmware revision (2A26), is a text (fields.py)."""

from __future__ import annotations

from construct import Int8ul

from .fields import build_whole, malformed, parse_whole


def parse_battery(data: bytes) -> int:
    """Return the battery level (2A19) in percent, 0 to 100; WireError for any other bytes."""
    percent: int = parse_whole(Int8ul, bytes(data))
    if percent > 100:
        raise malformed(f"{percent} percent")
    return percent


def build_battery(percent: int) -> bytes:
    """Return the bytes of a battery level in percent; ValueError unless it is 0 to 100."""
    if not 0 <= percent <= 100:
        raise ValueError(f"{percent} percent")
    return build_whole(Int8ul, percent)
