"""Numbers as bytes, exact to the bit: a state is four streams of floats, ints, flags and bytes, compressed together.

About half of the numbers of a state are 0 or equal to another one, which zlib finds."""

from __future__ import annotations

import zlib
from math import isfinite
from struct import Struct, error, pack

from .limits import MAX_DIGITS, MAX_SIZE, MAX_VALUES

HEADER = Struct("<4I")
"""Numbers of floats, ints and flags, and length of the digits of large ints, bytes."""
LARGE_INT = -(2**63)
"""Placeholder for an int of more than 63 bits, such as the state of a random number generator."""
LEVEL = 1
"""Level of compression of zlib, the fastest; the usual one, 6, saves another 6 % of a walk's state."""
LARGEST_BODY = 8 * MAX_VALUES + MAX_SIZE
"""Largest size of the streams before compression, without the header, bytes."""


def to_bytes(floats: list[float], ints: list[int], flags: list[bool], data: list[bytes]) -> bytes:
    """Return all four streams as bytes.

    Raises ValueError or OverflowError for a number that is not finite, ValueError for more than limits.py allows."""
    _check_count(len(floats), len(ints), len(flags))
    if not all(map(isfinite, floats)):
        raise ValueError("a number is not finite")
    digits = b""
    try:
        packed_ints = pack(f"<{len(ints)}q", *ints)
        if LARGE_INT in ints:
            raise OverflowError
    except (error, OverflowError):
        large = [not LARGE_INT < number < -LARGE_INT for number in ints]
        digits = b" ".join([b"%d" % number for number, is_large in zip(ints, large, strict=True) if is_large])
        kept = [LARGE_INT if is_large else number for number, is_large in zip(ints, large, strict=True)]
        packed_ints = pack(f"<{len(ints)}q", *kept)
    body = b"".join([pack(f"<{len(floats)}d", *floats), packed_ints, bytes(flags), digits, *data])
    if len(body) > LARGEST_BODY:
        raise ValueError(f"no state has more than {LARGEST_BODY} bytes")
    return zlib.compress(HEADER.pack(len(floats), len(ints), len(flags), len(digits)) + body, LEVEL)


def from_bytes(compressed: bytes | memoryview) -> tuple[list[float], list[int], list[bool], bytes]:
    """Return floats, ints, flags and joined bytes, the arguments of `to_bytes`, from its result.

    Raises ValueError, struct.error or zlib.error for any other input. Memory and time are bounded by LARGEST_BODY."""
    inflater = zlib.decompressobj()
    count, int_count, flag_count, digits_length = HEADER.unpack(inflater.decompress(compressed, HEADER.size))
    _check_count(count, int_count, flag_count)
    body = memoryview(inflater.decompress(inflater.unconsumed_tail, LARGEST_BODY + 1))
    if len(body) > LARGEST_BODY:
        raise ValueError(f"no state has more than {LARGEST_BODY} bytes")
    if not inflater.eof or inflater.unused_data:
        raise ValueError("it was cut short, or something follows it")
    at = 8 * (count + int_count) + flag_count
    numbers = Struct(f"<{count}d{int_count}q{flag_count}B").unpack_from(body)
    floats, ints, flags = list(numbers[:count]), list(numbers[count : count + int_count]), numbers[count + int_count :]
    if not all(map(isfinite, floats)):
        raise ValueError("a number is not finite")
    if flags and max(flags) > 1:
        raise ValueError("a flag is not 0 or 1")
    digits = body[at : at + digits_length].tobytes()
    if len(digits) != digits_length:
        raise ValueError("it was cut short")
    if digits or LARGE_INT in ints:
        ints = _with_large_ints(ints, digits.split(b" ", len(ints)))
    return floats, ints, list(map(bool, flags)), body[at + digits_length :].tobytes()


def _check_count(*counts: int) -> None:
    if sum(counts) > MAX_VALUES:  # whole numbers
        raise ValueError(f"no state has more than {MAX_VALUES} values")


def _with_large_ints(ints: list[int], digits: list[bytes]) -> list[int]:
    """Return the ints with the large ones, which are given as digits, in place of LARGE_INT."""
    if max([len(word.removeprefix(b"-")) for word in digits]) > MAX_DIGITS:
        raise ValueError(f"an int has more than {MAX_DIGITS} digits")
    if ints.count(LARGE_INT) != len(digits):
        raise ValueError("the number of large ints is another")
    large = iter(digits)
    return [int(next(large)) if number == LARGE_INT else number for number in ints]
