"""The standard GATT values that any device may have: battery level and firmware revision."""

from __future__ import annotations

from construct import Int8ul, Struct, Terminated

from .fields import build_text, build_whole, malformed, parse_text, parse_whole

_BATTERY = Struct("percent" / Int8ul, Terminated)


def parse_battery(data: bytes) -> int:
    """Return the battery level (2A19) in percent, 0 to 100; WireError for any other bytes."""
    percent: int = parse_whole(_BATTERY, bytes(data)).percent
    if percent > 100:
        raise malformed(f"{percent} percent")
    return percent


def build_battery(percent: int) -> bytes:
    """Return the bytes of a battery level in percent; ValueError unless it is 0 to 100."""
    if not 0 <= percent <= 100:
        raise ValueError(f"{percent} percent")
    return build_whole(_BATTERY, {"percent": percent})


def parse_firmware(data: bytes) -> str:
    """Return the firmware revision (2A26) as sent, with a trailing NUL if it has one; WireError if it is no UTF-8."""
    return parse_text(data)


def build_firmware(firmware: str) -> bytes:
    """Return the bytes of a firmware revision; ValueError when it is empty or too long."""
    return build_text(firmware)
