"""Numbers as bytes: each in the fewest bytes that restore exactly the same number.

Four streams hold a state: floats, ints, flags and bytes. Three bits give the class of a float or an int (ZERO to RIGHT
below); a flag is a bit. All little-endian. An int of more than 53 bits, such as a generator's state, is written in
decimal digits.

numpy does it: a loop over two thousand numbers would take longer than all the rest."""

from __future__ import annotations

from struct import Struct, error, pack
from typing import Any

import numpy as np

Units = tuple[float, float]
"""Load of one count of the left insole's cells, and of the right's, N: loads are multiples of it."""
COUNTS = Struct("<4I2d")
"""Numbers of floats, ints and flags, length of the digits of large ints, bytes, and the units."""

ZERO, SINGLE, DOUBLE, AGAIN, WHOLE, DECIMAL, LEFT, RIGHT = range(8)
"""Classes of a number.

0.0; a float32; a float64; the last float64 again; an int16; one over 10,000; one times a unit."""
LARGE = -(2**63)
"""Placeholder for an int that a float would not hold."""
_SHIFTED = (1 << np.arange(0, 24, 3)).astype("f4")


def to_bytes(floats: list[float], ints: list[int], flags: list[bool], data: list[bytes], units: Units) -> bytes:
    """Return all four streams as bytes; raise ValueError or OverflowError for a number that is not finite."""
    try:
        # struct takes a third of the time that numpy needs for a list
        numbers = np.frombuffer(pack(f"<{len(floats) + len(ints)}d", *floats, *ints), "<f8")
    except error as wrong:
        raise ValueError(str(wrong)) from None
    if not np.isfinite(numbers).all():
        raise ValueError("a number is not finite")
    large = (np.abs(numbers[len(floats) :]) >= 2.0**53).nonzero()[0]
    digits = b""
    if len(large):
        digits = b" ".join([b"%d" % ints[i] for i in large])
        numbers = numbers.copy()
        numbers[len(floats) + large] = LARGE
    return b"".join(
        [
            COUNTS.pack(len(floats), len(ints), len(flags), len(digits), *units),
            *_write_numbers(numbers, units),
            np.packbits(np.frombuffer(bytes(flags), np.uint8), bitorder="little").tobytes(),
            digits,
            *data,
        ]
    )


def _scaled(k: int, count: Any, units: Units) -> Any:
    """Return the number that an int16 of a class stands for."""
    return count / 1e4 if k == DECIMAL else count * (1.0 if k == WHOLE else units[k - LEFT])


def _write_numbers(real: Any, units: Units) -> list[bytes]:
    bits = real.view("<i8")
    with np.errstate(all="ignore"):
        single = real.astype("<f4")
        is_single = single.astype("<f8").view("<i8") == bits
        # a number that is too large becomes any other, which is then not equal
        counts = single.astype("<i2")
        is_whole = counts.astype("<f4").view("<i4") == single.view("<i4")
        is_whole &= is_single
        # sums of flags take half the time of masks
        classes = DOUBLE - is_single.view(np.uint8) + np.uint8(WHOLE - SINGLE) * is_whole.view(np.uint8)
        classes *= (bits != 0).view(np.uint8)
        # one pass for all would take as long again: most numbers have their class already
        far = (classes == DOUBLE).nonzero()[0]
        far_real, far_bits = real.take(far), bits.take(far)
        far_classes, far_counts = np.full(len(far), DOUBLE, np.uint8), np.zeros(len(far), "<i2")
        scales = {DECIMAL: 1e4} | {k: 1.0 / unit for unit, k in {units[1]: RIGHT, units[0]: LEFT}.items() if unit}
        for k, scale in scales.items():
            count = np.rint(far_real * scale).astype("<i2")
            exact = _scaled(k, count.astype("<f8"), units).view("<i8") == far_bits
            np.putmask(far_classes, exact, k)
            np.putmask(far_counts, exact, count)
    doubles = (far_classes == DOUBLE).nonzero()[0]
    double_bits = far_bits.take(doubles)
    far_classes[doubles[1:][double_bits[1:] == double_bits[:-1]]] = AGAIN
    classes[far], counts[far] = far_classes, far_counts
    return [
        _pack_classes(classes),
        counts.take((classes >= WHOLE).nonzero()[0]).tobytes(),
        single.take((classes == SINGLE).nonzero()[0]).tobytes(),
        far_real.take((far_classes == DOUBLE).nonzero()[0]).tobytes(),
    ]


def _pack_classes(classes: Any) -> bytes:
    """Pack eight classes into three bytes, the first in the lowest bits; zeros fill the rest."""
    # float32 holds 24 bits, and has a fast product
    eights = np.zeros(-(-len(classes) // 8) * 8, "f4")
    eights[: len(classes)] = classes
    packed = (eights.reshape(-1, 8) @ _SHIFTED).astype("<u4")
    packed_bytes: bytes = packed.view(np.uint8).reshape(-1, 4)[:, :3].tobytes()
    return packed_bytes


def from_bytes(body: memoryview) -> tuple[list[float], list[int], list[bool], bytes]:
    """Return the arguments of `to_bytes`, with the bytes joined.

    Raises ValueError (or struct's error) for anything else. The result is never much larger than the input."""
    count, whole_count, flag_count, digits_length, *units = COUNTS.unpack_from(body)
    cursor = _Cursor(body, COUNTS.size)
    numbers = _read_numbers(cursor, cursor.in_bits(count + whole_count, 3), (units[0], units[1]))
    with np.errstate(all="ignore"):
        whole = numbers[count:].astype("<i8")
    if not np.isfinite(numbers).all() or (whole != numbers[count:]).any():
        raise ValueError("a number is not finite, or not whole")
    flags = cursor.in_bits(flag_count, 1)
    digits = cursor.take(digits_length).tobytes()
    ints: list[int] = whole.tolist()
    if digits:
        large = iter(digits.split(b" "))
        ints = [int(next(large)) if i == LARGE else i for i in ints]
        if next(large, None) is not None:
            raise ValueError("large ints are left over")
    return numbers[:count].tolist(), ints, flags.astype(np.bool_).tolist(), cursor.take(None).tobytes()


def _read_numbers(cursor: _Cursor, classes: Any, units: Units) -> Any:
    real = np.zeros(len(classes), "<f8")
    counts = cursor.array(np.dtype("<i2"), int(np.count_nonzero(classes >= WHOLE))).astype("<f8")
    of_counts = classes[classes >= WHOLE]
    with np.errstate(all="ignore"):
        for k in (WHOLE, DECIMAL, LEFT, RIGHT):
            real[classes == k] = _scaled(k, counts[of_counts == k], units)
        real[classes == SINGLE] = cursor.array(np.dtype("<f4"), int(np.count_nonzero(classes == SINGLE)))
    is_double = classes == DOUBLE
    doubles = cursor.array(np.dtype("<f8"), int(np.count_nonzero(is_double)))
    again = classes == AGAIN
    is_double |= again
    real[is_double] = doubles[(np.cumsum(~again[is_double]) - 1)]
    return real


class _Cursor:
    """Takes one part after the other; never more than there is."""

    def __init__(self, body: memoryview, at: int) -> None:
        self.body, self.at = body, at

    def take(self, length: int | None) -> memoryview:
        end = len(self.body) if length is None else self.at + length
        if end > len(self.body):
            raise ValueError("it was cut short")
        taken = self.body[self.at : end]
        self.at = end
        return taken

    def array(self, dtype: Any, count: int) -> Any:
        return np.frombuffer(self.take(count * dtype.itemsize), dtype)

    def in_bits(self, count: int, width: int) -> Any:
        bits = np.unpackbits(np.frombuffer(self.take(-(-count // 8) * width), np.uint8), bitorder="little")
        numbers = bits.reshape(-1, width) @ (1 << np.arange(width, dtype=np.uint8))
        return numbers[:count]
