"""Formats of both SensorTags (protocol/cc2650.md, protocol/cc2541.md): a period, and a sensor switched on or off."""

from __future__ import annotations

from construct import ExprAdapter, Int8ul, Mapping, OneOf, Struct

from .fields import Definition


def hundredths(number: Definition) -> Definition:
    """Return a construct for a number that counts hundredths."""
    return ExprAdapter(number, lambda count, _: count / 100, lambda value, _: round(value * 100))


PERIOD = Struct("period" / hundredths(OneOf(Int8ul, range(1, 256))))
"""Time between notifications, 0.01 to 2.55 s; building rounds it to 0.01 s.

Stock firmware does not accept less than 0.1 s. Modified firmware does, so a shorter period is not rejected here."""
ON_OFF = Mapping(Int8ul, {False: 0, True: 1})
"""One byte: 0 for off, 1 for on; other values are rejected."""
