"""What any device tells by the standard GATT services: battery level and firmware revision."""

from __future__ import annotations

from construct import Int8ul, Struct, Terminated

from ..events import Rejection
from .error import WireError
from .fields import LONGEST_VALUE, build_whole, malformed, parse_whole

_BATTERY = Struct("percent" / Int8ul, Terminated)


def parse_battery(data: bytes) -> int:
    """Battery level (2A19) in percent, 0 to 100. WireError when it is not one."""
    percent: int = parse_whole(_BATTERY, bytes(data)).percent
    if percent > 100:
        raise malformed(f"{percent} percent")
    return percent


def build_battery(percent: int) -> bytes:
    """The bytes of a battery level. ValueError unless it is 0 to 100."""
    if not 0 <= percent <= 100:
        raise ValueError(f"{percent} percent")
    return build_whole(_BATTERY, {"percent": percent})


def parse_firmware(data: bytes) -> str:
    """Firmware revision (2A26), UTF-8, as sent: a trailing NUL stays. WireError when it is none."""
    data = bytes(data)
    if not data:
        raise WireError(Rejection.TRUNCATED, "an empty firmware revision")
    if len(data) > LONGEST_VALUE:
        raise WireError(Rejection.OVERSIZED, f"{len(data)} bytes, at most {LONGEST_VALUE}")
    try:
        return data.decode("utf-8")
    except UnicodeDecodeError as error:
        raise malformed(f"not UTF-8: {error}") from error


def build_firmware(firmware: str) -> bytes:
    """The bytes of a firmware revision. ValueError when it is empty or too long."""
    data = firmware.encode("utf-8")
    if not 0 < len(data) <= LONGEST_VALUE:
        raise ValueError(f"a firmware revision of {len(data)} bytes")
    return data
