"""Formats that both SensorTags share (protocol/cc2650.md, protocol/cc2541.md): a period, and sensor on or off."""

from __future__ import annotations

from typing import Any

from construct import ExprAdapter, Int8ul, Mapping, OneOf, Struct


def _seconds(hundredths: int, _: Any) -> float:
    return hundredths / 100


def _hundredths(seconds: float, _: Any) -> int:
    return round(seconds * 100)


PERIOD = Struct("period" / ExprAdapter(OneOf(Int8ul, range(1, 256)), _seconds, _hundredths))
"""Seconds between notifications, 0.01 to 2.55; building rounds to the nearest.

Stock firmware takes nothing under 0.1 s; modified firmware does, so it is not rejected here."""
ON_OFF = Mapping(Int8ul, {False: 0, True: 1})
"""One byte: 0 off, 1 on, nothing else."""
