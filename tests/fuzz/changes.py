"""Random changes of bytes, numbers and records, the same for the same `Random`."""

from __future__ import annotations

from collections.abc import Sequence
from math import inf, nan
from random import Random
from typing import Any

import attrs

BORDERS = (0, 1, 2, 0x7E, 0x7F, 0x80, 0x81, 0xFE, 0xFF)
"""Bytes at the ends of ranges."""
WIDTHS = (7, 8, 12, 15, 16, 24, 31, 32, 63, 64)
"""Numbers of bits whose powers of two are ends of ranges."""
NUMBERS = (
    nan,
    inf,
    -inf,
    0.0,
    -0.0,
    5e-324,
    1e-9,
    1.0,
    -1.0,
    9.81,
    1e3,
    1e8,
    1e11,
    -1e11,
    1e19,
    1e300,
    -1e300,
    10**400,
)
"""Numbers at which code may fail; the last one is too large for a float."""


def changed_bytes(data: bytes, random: Random, others: Sequence[bytes] = ()) -> bytes:
    """Return the bytes with one to four changes: bits, borders, pieces left out, repeated, added or of others."""
    changed = bytearray(data)
    for _ in range(random.choice((1, 1, 1, 2, 4))):
        at = random.randrange(len(changed) + 1)
        size = random.choice((1, 1, 2, 4, 16, 64))
        kind = random.randrange(8)
        if kind == 0 and changed:
            changed[at - 1] ^= 1 << random.randrange(8)
        elif kind == 1 and changed:
            changed[at - 1] = random.choice(BORDERS)
        elif kind == 2:
            del changed[at : at + size]
        elif kind == 3:
            changed[at:at] = changed[at : at + size]
        elif kind == 4:
            changed[at:at] = random.randbytes(size)
        elif kind == 5:
            del changed[at:]
        elif kind == 6 and others:
            other = random.choice(others)
            changed[at:] = other[min(at, len(other)) :]
        else:
            changed[at : at + size] = bytes([random.choice(BORDERS)]) * size
    return bytes(changed)


def changed_whole_number(value: int, random: Random) -> int:
    """Return a whole number near to `value`, or at the end of a range."""
    border = 1 << random.choice(WIDTHS)
    return random.choice((value + 1, value - 1, -value, 0, border, border - 1, -border, random.randrange(border)))


def changed_value(value: Any, random: Random) -> Any:
    """Return the value with a change somewhere in it: a number, a flag, an item, or a field of a record."""
    if isinstance(value, bool):
        return not value
    if isinstance(value, int):
        return changed_whole_number(value, random)
    if isinstance(value, float):
        return random.choice(NUMBERS)
    if isinstance(value, str):
        return random.choice(("", value[:-1], value + "x", "\ud800", "\0", "é" * 40, value * 50))
    if isinstance(value, bytes):
        return changed_bytes(value, random)
    if isinstance(value, list | tuple):
        return type(value)(_changed_items(list(value), random))
    if isinstance(value, dict):
        return _changed_members(value, random)
    if attrs.has(type(value)):
        names = [attribute.name for attribute in attrs.fields(type(value)) if attribute.init]
        name = random.choice(names)
        return attrs.evolve(value, **{name: changed_value(getattr(value, name), random)})
    return value if random.randrange(4) else None


def _changed_items(items: list[Any], random: Random) -> list[Any]:
    kind = random.randrange(8)
    if not items or kind == 0:
        return items + items[-1:] * random.choice((1, 2, 100))
    at = random.randrange(len(items))
    if kind == 1:
        return items[:at] + items[at + 1 :]
    if kind == 2:
        return items[:at]
    items[at] = changed_value(items[at], random)
    return items


def _changed_members(members: dict[Any, Any], random: Random) -> dict[Any, Any]:
    if not members:
        return {"x": 1}
    name = random.choice(list(members))
    kind = random.randrange(10)
    if kind == 0:
        return {other: value for other, value in members.items() if other != name}
    if kind == 1:
        return {**members, f"{name}x": members[name]}
    if kind == 2:
        return {**members, name: random.choice(("", [], {}, None, True, 0, -1.5, "x", [[]], {"is": []}))}
    return {**members, name: changed_value(members[name], random)}
