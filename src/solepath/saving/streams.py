"""Numbers as bytes, exact to the bit: a state is four streams of floats, ints, flags and bytes, compressed together.

About half of the numbers of a state are 0 or equal to another one, which zlib finds."""

from __future__ import annotations

import zlib
from collections.abc import Iterator, Sequence
from io import BytesIO
from itertools import islice
from math import isfinite
from operator import index
from struct import Struct, pack, unpack
from typing import Any, NamedTuple

from .limits import MAX_DIGITS, MAX_SIZE, MAX_VALUES, Classes, SnapshotError

HEADER = Struct("<4I")
"""Numbers of floats, ints and flags, and length of the ints' digits, bytes."""
LEVEL = 1
"""Level of compression of zlib, the fastest; the usual one, 6, saves another 6 % of a walk's state."""
LARGEST_BODY = 8 * MAX_VALUES + MAX_SIZE
"""Largest size of the streams before compression, without the header, bytes."""


class Lists(NamedTuple):
    """The streams to which a value is written."""

    floats: list[Any]
    ints: list[Any]
    flags: list[Any]
    data: list[Any]


class Streams(NamedTuple):
    """The streams from which a value is read, and what returns the class of an open record by its name."""

    floats: Iterator[float]
    ints: Iterator[int]
    flags: Iterator[bool]
    data: BytesIO
    classes: Any
    """A function of the type `Classes`."""

    def end(self) -> None:
        """Raise SnapshotError unless all values were read."""
        if [*islice(self.floats, 1), *islice(self.ints, 1), *islice(self.flags, 1), *self.data.read(1)]:
            raise SnapshotError("more is packed than a session holds")


def to_bytes(lists: Lists) -> bytes:
    """Return all four streams as bytes.

    Raises ValueError for a number that is not finite and for more than limits.py allows, and TypeError, OverflowError
    or struct.error for what is no number."""
    floats, ints, flags, data = lists
    digits = [b"%d" % index(number) for number in ints]
    text = b" ".join(digits)
    body = b"".join([pack(f"<{len(floats)}d", *floats), bytes(flags), text, *data])
    _check(floats, digits, len(flags), len(body))
    return zlib.compress(HEADER.pack(len(floats), len(ints), len(flags), len(text)) + body, LEVEL)


def from_bytes(compressed: bytes | memoryview, classes: Classes) -> Streams:
    """Return the streams that `to_bytes` turned into `compressed`.

    Raises ValueError, struct.error or zlib.error for any other input. Memory and time are bounded by LARGEST_BODY."""
    inflater = zlib.decompressobj()
    count, int_count, flag_count, text_size = HEADER.unpack(inflater.decompress(compressed, HEADER.size))
    _check_count(count + int_count + flag_count)
    body = BytesIO(inflater.decompress(inflater.unconsumed_tail, LARGEST_BODY + 1))
    floats = unpack(f"<{count}d", body.read(8 * count))
    flags, text = body.read(flag_count), body.read(text_size)
    digits = text.split(None, int_count)
    _check(floats, digits, len(flags), len(body.getbuffer()))
    if not inflater.eof or inflater.unused_data or (len(flags), len(digits)) != (flag_count, int_count):
        raise ValueError("it was cut short, or something follows it")
    if flags.strip(b"\0\1"):
        raise ValueError("a flag is not 0 or 1")
    return Streams(iter(floats), iter([*map(int, digits)]), map(bool, flags), body, classes)


def _check_count(count: int) -> None:
    if count > MAX_VALUES:
        raise ValueError(f"no state has more than {MAX_VALUES} values")


def _check(floats: Sequence[float], digits: list[bytes], flag_count: int, size: int) -> None:
    _check_count(len(floats) + len(digits) + flag_count)
    if size > LARGEST_BODY:
        raise ValueError(f"no state has more than {LARGEST_BODY} bytes")
    if not all(map(isfinite, floats)):
        raise ValueError("a number is not finite")
    if max(map(len, digits), default=0) > MAX_DIGITS:
        raise ValueError(f"an int has more than {MAX_DIGITS} digits")
