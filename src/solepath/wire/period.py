"""The period byte of every SensorTag sensor (protocol/cc2650.md, protocol/cc2541.md)."""

from __future__ import annotations

from construct import Int8ul, Struct, Terminated

from .fields import build_whole, malformed, parse_whole

_PERIOD = Struct("hundredths" / Int8ul, Terminated)


def parse_period(data: bytes) -> float:
    """Seconds between notifications, 0.01 to 2.55. WireError when `data` is not a period.

    Stock firmware takes nothing under 0.1 s; modified firmware does, so it is not refused here.
    """
    hundredths: int = parse_whole(_PERIOD, bytes(data)).hundredths
    if hundredths == 0:
        raise malformed("a period of zero")
    return hundredths / 100


def build_period(period: float) -> bytes:
    """The period byte nearest to `period`, s. ValueError when it is not within 0.01 to 2.55."""
    if not 0.005 < period < 2.555:
        raise ValueError(f"a period of {period} s, 0.01 to 2.55 can be said")
    return build_whole(_PERIOD, {"hundredths": round(period * 100)})
