"""Numbers as bytes: each number in the fewest bytes that restore it exactly.

A state has four streams: floats, ints, flags and bytes. Three bits give the class of a float or an int (ZERO to RIGHT
below); a flag is one bit. All values are little-endian. An int of more than 53 bits, such as the state of a random
number generator, is written in decimal digits.

The code uses numpy, because a loop over two thousand numbers would take longer than all other work."""

from __future__ import annotations

from struct import Struct, error, pack
from typing import Any

import numpy as np

from .limits import MAX_DIGITS, MAX_VALUES

Units = tuple[float, float]
"""Load per count of a cell of the left and of the right insole, N; loads are multiples of it."""
HEADER = Struct("<4I2d")
"""Header: numbers of floats, ints and flags, length of the digits of large ints in bytes, and the units."""

ZERO, SINGLE, DOUBLE, AGAIN, WHOLE, DECIMAL, LEFT, RIGHT = range(8)
"""Classes of a number.

They are, in this order: 0.0; a float32; a float64; the last float64 again; an int16; an int16 divided by 10,000; an
int16 times the left unit; an int16 times the right unit."""
LARGE_INT = -(2**63)
"""Placeholder for an int of more than 53 bits, which a float cannot represent exactly."""
_CLASS_FACTORS = (1 << np.arange(0, 24, 3)).astype("f4")


def to_bytes(floats: list[float], ints: list[int], flags: list[bool], data: list[bytes], units: Units) -> bytes:
    """Return all four streams as bytes.

    Raises ValueError or OverflowError for a number that is not finite, ValueError for more than limits.py allows."""
    _check_count(len(floats), len(ints), len(flags))
    try:
        # struct takes a third of the time that numpy needs for a list
        numbers = np.frombuffer(pack(f"<{len(floats) + len(ints)}d", *floats, *ints), "<f8")
    except error as struct_error:
        raise ValueError(str(struct_error)) from None
    if not np.isfinite(numbers).all():
        raise ValueError("a number is not finite")
    large = (np.abs(numbers[len(floats) :]) >= 2.0**53).nonzero()[0]
    digits = b""
    if len(large):
        digits = b" ".join([b"%d" % ints[i] for i in large])
        numbers = numbers.copy()
        numbers[len(floats) + large] = LARGE_INT
    return b"".join(
        [
            HEADER.pack(len(floats), len(ints), len(flags), len(digits), *units),
            *_write_numbers(numbers, units),
            np.packbits(np.frombuffer(bytes(flags), np.uint8), bitorder="little").tobytes(),
            digits,
            *data,
        ]
    )


def _decode_counts(k: int, count: Any, units: Units) -> Any:
    """Return the numbers of class `k` that the int16 `count` stand for."""
    return count / 1e4 if k == DECIMAL else count * (1.0 if k == WHOLE else units[k - LEFT])


def _write_numbers(real: Any, units: Units) -> list[bytes]:
    bits = real.view("<i8")
    with np.errstate(all="ignore"):
        single = real.astype("<f4")
        is_single = single.astype("<f8").view("<i8") == bits
        # a number that is too large for int16 changes its value, so the comparison fails
        counts = single.astype("<i2")
        is_int16 = counts.astype("<f4").view("<i4") == single.view("<i4")
        is_int16 &= is_single
        # sums of flags take half the time of masks
        classes = DOUBLE - is_single.view(np.uint8) + np.uint8(WHOLE - SINGLE) * is_int16.view(np.uint8)
        classes *= (bits != 0).view(np.uint8)
        # only the remaining numbers are tested further, because testing all would double the time
        remaining = (classes == DOUBLE).nonzero()[0]
        remaining_real, remaining_bits = real.take(remaining), bits.take(remaining)
        remaining_classes, remaining_counts = np.full(len(remaining), DOUBLE, np.uint8), np.zeros(len(remaining), "<i2")
        scales = {DECIMAL: 1e4} | {k: 1.0 / unit for unit, k in {units[1]: RIGHT, units[0]: LEFT}.items() if unit}
        for k, scale in scales.items():
            count = np.rint(remaining_real * scale).astype("<i2")
            exact = _decode_counts(k, count.astype("<f8"), units).view("<i8") == remaining_bits
            np.putmask(remaining_classes, exact, k)
            np.putmask(remaining_counts, exact, count)
    doubles = (remaining_classes == DOUBLE).nonzero()[0]
    double_bits = remaining_bits.take(doubles)
    remaining_classes[doubles[1:][double_bits[1:] == double_bits[:-1]]] = AGAIN
    classes[remaining], counts[remaining] = remaining_classes, remaining_counts
    return [
        _pack_classes(classes),
        counts.take((classes >= WHOLE).nonzero()[0]).tobytes(),
        single.take((classes == SINGLE).nonzero()[0]).tobytes(),
        remaining_real.take((remaining_classes == DOUBLE).nonzero()[0]).tobytes(),
    ]


def _pack_classes(classes: Any) -> bytes:
    """Pack eight classes into three bytes, the first class in the lowest bits; zeros fill the last bytes."""
    # float32 represents 24 bits exactly, and its matrix product is fast
    padded = np.zeros(-(-len(classes) // 8) * 8, "f4")
    padded[: len(classes)] = classes
    packed = (padded.reshape(-1, 8) @ _CLASS_FACTORS).astype("<u4")
    packed_bytes: bytes = packed.view(np.uint8).reshape(-1, 4)[:, :3].tobytes()
    return packed_bytes


def from_bytes(body: memoryview) -> tuple[list[float], list[int], list[bool], bytes]:
    """Return floats, ints, flags and joined bytes, the arguments of `to_bytes`, from its result.

    Raises ValueError (or struct.error) for any other input. A value takes at least a bit of the input, and there are at
    most MAX_VALUES, so that memory and time are bounded."""
    count, int_count, flag_count, digits_length, *units = HEADER.unpack_from(body)
    _check_count(count, int_count, flag_count)
    cursor = _Cursor(body, HEADER.size)
    numbers = _read_numbers(cursor, cursor.take_bits(count + int_count, 3), (units[0], units[1]))
    with np.errstate(all="ignore"):
        integers = numbers[count:].astype("<i8")
    if not np.isfinite(numbers).all() or (integers != numbers[count:]).any():
        raise ValueError("a number is not finite, or not whole")
    flags = cursor.take_bits(flag_count, 1)
    digits = cursor.take(digits_length).tobytes()
    ints: list[int] = integers.tolist()
    if digits:
        ints = _with_large_ints(ints, digits.split(b" ", len(ints)))
    return numbers[:count].tolist(), ints, flags.astype(np.bool_).tolist(), cursor.take(None).tobytes()


def _check_count(*counts: int) -> None:
    if sum(counts) > MAX_VALUES:  # whole numbers
        raise ValueError(f"no state has more than {MAX_VALUES} values")


def _with_large_ints(ints: list[int], digits: list[bytes]) -> list[int]:
    """Return the ints with the large ones, which are given as digits, in place of LARGE_INT."""
    if max(map(len, digits)) > MAX_DIGITS + 1:
        raise ValueError(f"an int has more than {MAX_DIGITS} digits")
    if ints.count(LARGE_INT) != len(digits):
        raise ValueError("the number of large ints is another")
    large = iter(digits)
    return [int(next(large)) if i == LARGE_INT else i for i in ints]


def _read_numbers(cursor: _Cursor, classes: Any, units: Units) -> Any:
    real = np.zeros(len(classes), "<f8")
    counts = cursor.take_array(np.dtype("<i2"), int(np.count_nonzero(classes >= WHOLE))).astype("<f8")
    count_classes = classes[classes >= WHOLE]
    with np.errstate(all="ignore"):
        for k in (WHOLE, DECIMAL, LEFT, RIGHT):
            real[classes == k] = _decode_counts(k, counts[count_classes == k], units)
        real[classes == SINGLE] = cursor.take_array(np.dtype("<f4"), int(np.count_nonzero(classes == SINGLE)))
    is_double = classes == DOUBLE
    doubles = cursor.take_array(np.dtype("<f8"), int(np.count_nonzero(is_double)))
    is_again = classes == AGAIN
    is_double |= is_again
    real[is_double] = doubles[(np.cumsum(~is_again[is_double]) - 1)]
    return real


class _Cursor:
    """Reads consecutive parts of a body; raises ValueError at its end."""

    def __init__(self, body: memoryview, at: int) -> None:
        self.body, self.at = body, at

    def take(self, length: int | None) -> memoryview:
        end = len(self.body) if length is None else self.at + length
        if end > len(self.body):
            raise ValueError("it was cut short")
        taken = self.body[self.at : end]
        self.at = end
        return taken

    def take_array(self, dtype: Any, count: int) -> Any:
        return np.frombuffer(self.take(count * dtype.itemsize), dtype)

    def take_bits(self, count: int, width: int) -> Any:
        bits = np.unpackbits(np.frombuffer(self.take(-(-count // 8) * width), np.uint8), bitorder="little")
        numbers = bits.reshape(-1, width) @ (1 << np.arange(width, dtype=np.uint8))
        return numbers[:count]
