"""The battery level, a standard GATT value that any device may have.

The other standard value, the firmware revision (2A26), is a text (fields.py)."""

from __future__ import annotations

from functools import partial

from construct import Int8ul, OneOf

from .fields import build_whole, parse_whole

_PERCENT = OneOf(Int8ul, range(101))

parse_battery: partial[int] = partial(parse_whole, _PERCENT)
"""Return the battery level (2A19) in percent, 0 to 100; WireError for any other bytes."""
build_battery = partial(build_whole, _PERCENT)
"""Return the bytes of a battery level in percent; ValueError unless it is 0 to 100."""
