"""Numbers as bytes: each in the fewest bytes that give the very same number again.

Four streams hold a state: floats, ints, flags and bytes. Three bits tell what a float is (ZERO to AGAIN below), two
bits and an unsigned byte, an int16, an int32 or an int64 an int; a flag is a bit. All little-endian. An int of more
than 53 bits, such as a generator's state, is told in decimal digits.

numpy does it: a loop over two thousand floats would take longer than all the rest.
"""

from __future__ import annotations

from struct import Struct, error, pack
from typing import Any

import numpy as np

Units = tuple[float, float]
"""What a count of the left insole's cells weighs, and one of the right's, N: loads are multiples of it."""
COUNTS = Struct("<4I2d")
"""How many floats, ints and flags there are, how many bytes tell large ints, and the units."""

ZERO, SINGLE, DOUBLE, AGAIN, WHOLE, DECIMAL, LEFT, RIGHT = range(8)
"""0.0; a float32; a float64; the last float64 again; an int16; one over 10,000; one times a unit."""
LARGE = -(2**63)
"""Stands for an int that a float would not hold."""
_SHIFTED = {width: 1 << np.arange(0, 8 * width, width, dtype="<u4") for width in (2, 3)}
_INTS = (np.dtype("u1"), np.dtype("<i2"), np.dtype("<i4"), np.dtype("<i8"))


def to_bytes(floats: list[float], ints: list[int], flags: list[bool], data: list[bytes], units: Units) -> bytes:
    """All four as bytes. ValueError or OverflowError for what is no finite number."""
    real, rough = _array(floats), _array(ints)
    if not np.isfinite(real).all():
        raise ValueError("a number is not finite")
    is_large = np.abs(rough) >= 2.0**53
    told = b" ".join([b"%d" % ints[i] for i in np.flatnonzero(is_large)])
    return b"".join(
        [
            COUNTS.pack(len(floats), len(ints), len(flags), len(told), *units),
            *_floats(real, units),
            *_ints((np.where(is_large, LARGE, rough) if told else rough).astype("<i8")),
            np.packbits(np.frombuffer(bytes(flags), np.uint8), bitorder="little").tobytes(),
            told,
            *data,
        ]
    )


def _array(numbers: list[Any]) -> Any:
    """struct takes a third of the time that numpy needs for a list."""
    try:
        return np.frombuffer(pack(f"<{len(numbers)}d", *numbers), "<f8")
    except error as wrong:
        raise ValueError(str(wrong)) from None


def _scaled(k: int, count: Any, units: Units) -> Any:
    """What an int16 of a class stands for."""
    return count / 1e4 if k == DECIMAL else count * (1.0 if k == WHOLE else units[k - LEFT])


def _floats(real: Any, units: Units) -> list[bytes]:
    bits = real.view("<i8")
    classes = np.full(len(real), DOUBLE, np.uint8)
    with np.errstate(all="ignore"):
        single = real.astype("<f4")
        np.putmask(classes, single.astype("<f8").view("<i8") == bits, SINGLE)
        counts = np.zeros(len(real), "<i2")
        scales = {DECIMAL: 1e4, LEFT: 1.0 / units[0] if units[0] else 0.0, WHOLE: 1.0}
        if units[1] and units[1] != units[0]:
            scales[RIGHT] = 1.0 / units[1]
        for k, scale in scales.items():
            # what is too large becomes anything, and is not equal then
            count = (real if k == WHOLE else np.rint(real * scale)).astype("<i2")
            told = _scaled(k, count.astype("<f8"), units).view("<i8") == bits
            np.putmask(classes, told, k)
            np.copyto(counts, count, where=told)
    np.putmask(classes, bits == 0, ZERO)
    doubles = np.flatnonzero(classes == DOUBLE)
    told = bits[doubles]
    classes[doubles[1:][told[1:] == told[:-1]]] = AGAIN
    return [
        _in_bits(classes, 3),
        counts[classes >= WHOLE].tobytes(),
        single[classes == SINGLE].tobytes(),
        real[classes == DOUBLE].tobytes(),
    ]


def _ints(whole: Any) -> list[bytes]:
    classes = np.zeros(len(whole), np.uint8)
    few = np.flatnonzero((whole < 0) | (whole > 255))
    larger = whole[few]
    size = np.where(larger < 0, ~larger, larger)
    classes[few] = of_few = 1 + (size >= 2**15) + (size >= 2**31)
    told = [larger[of_few == k].astype(_INTS[k]).tobytes() for k in (1, 2, 3)]
    return [_in_bits(classes, 2), whole[classes == 0].astype(np.uint8).tobytes(), *told]


def _in_bits(numbers: Any, width: int) -> bytes:
    """Eight numbers of so many bits in as many bytes, the first in the lowest bits; zeros fill it up."""
    eights = np.zeros(-(-len(numbers) // 8) * 8, np.uint8)
    eights[: len(numbers)] = numbers
    packed = eights.reshape(-1, 8) @ _SHIFTED[width]
    told: bytes = packed.astype("<u4", copy=False).view(np.uint8).reshape(-1, 4)[:, :width].tobytes()
    return told


def from_bytes(body: memoryview) -> tuple[list[float], list[int], list[bool], bytes]:
    """What `to_bytes` was given, the bytes in one. ValueError (or struct's error) for anything else; what it makes of
    it is never much larger than it is."""
    count, whole_count, flag_count, told_length, *units = COUNTS.unpack_from(body)
    cursor = _Cursor(body, COUNTS.size)
    real = _real(cursor, cursor.in_bits(count, 3), (units[0], units[1]))
    if not np.isfinite(real).all():
        raise ValueError("a number is not finite")
    classes = cursor.in_bits(whole_count, 2)
    whole = np.zeros(whole_count, "<i8")
    for k, dtype in enumerate(_INTS):
        of_class = classes == k
        whole[of_class] = cursor.array(dtype, int(np.count_nonzero(of_class)))
    flags = cursor.in_bits(flag_count, 1)
    told = cursor.take(told_length).tobytes()
    ints: list[int] = whole.tolist()
    if told:
        large = iter(told.split(b" "))
        ints = [int(next(large)) if i == LARGE else i for i in ints]
        if next(large, None) is not None:
            raise ValueError("large ints are left over")
    return real.tolist(), ints, flags.astype(np.bool_).tolist(), cursor.take(None).tobytes()


def _real(cursor: _Cursor, classes: Any, units: Units) -> Any:
    real = np.zeros(len(classes), "<f8")
    counts = cursor.array(_INTS[1], int(np.count_nonzero(classes >= WHOLE))).astype("<f8")
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
        bits = np.unpackbits(self.array(_INTS[0], -(-count // 8) * width), bitorder="little")
        numbers = bits.reshape(-1, width) @ (1 << np.arange(width, dtype=np.uint8))
        return numbers[:count]
