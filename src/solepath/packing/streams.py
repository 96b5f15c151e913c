"""Numbers as bytes: each in the fewest bytes that give the very same number again.

Four streams hold a state: floats, ints, flags and bytes. A float is told by two bits and what they ask for: nothing
for 0.0, an int16, a float32 or a float64; an int by two bits and an unsigned byte, an int16, an int32 or an int64; a
flag is a bit. All little-endian. An int of more than 53 bits, such as a generator's state, is told in decimal digits.

numpy does it: a loop over two thousand floats would take longer than all the rest.
"""

from __future__ import annotations

from struct import Struct, error, pack
from typing import Any

import numpy as np

COUNTS = Struct("<4I")
"""How many floats, ints and flags there are, and how many bytes tell large ints."""
LARGE = -(2**63)
"""Stands for an int that a float would not hold."""
_FLOATS = (np.dtype("<i2"), np.dtype("<f4"), np.dtype("<f8"))
_INTS = (np.dtype("u1"), np.dtype("<i2"), np.dtype("<i4"), np.dtype("<i8"))
_PLACES = np.array([1, 4, 16, 64], np.uint8)
_UNPACKED = np.array([[byte >> shift & 3 for shift in (0, 2, 4, 6)] for byte in range(256)], np.uint8)


def to_bytes(floats: list[float], ints: list[int], flags: list[bool], data: list[bytes]) -> bytes:
    """All four as bytes. ValueError, TypeError or OverflowError for what is no finite number."""
    real, rough = _array(floats), _array(ints)
    if not np.isfinite(real).all():
        raise ValueError("a number is not finite")
    is_large = np.abs(rough) >= 2.0**53
    whole = rough.astype("<i8") if not is_large.any() else np.where(is_large, LARGE, rough).astype("<i8")
    told = b" ".join([b"%d" % ints[i] for i in np.flatnonzero(is_large)])
    return b"".join(
        [
            COUNTS.pack(len(floats), len(ints), len(flags), len(told)),
            *_floats(real),
            *_ints(whole),
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
        raise TypeError(str(wrong)) from None


def _floats(real: Any) -> list[bytes]:
    bits = real.view("<i8")
    with np.errstate(all="ignore"):
        short, single = real.astype(_FLOATS[0]), real.astype(_FLOATS[1])
    is_short = short.astype("<f8").view("<i8") == bits
    is_single = single.astype("<f8").view("<i8") == bits
    is_zero = bits == 0
    classes = np.where(is_short, 1, 3 - is_single).astype(np.uint8)
    classes[is_zero] = 0
    is_short &= ~is_zero
    return [
        _two_bits(classes),
        short[is_short].tobytes(),
        single[classes == 2].tobytes(),
        real[classes == 3].tobytes(),
    ]


def _ints(whole: Any) -> list[bytes]:
    low, high = (int(whole.min()), int(whole.max())) if len(whole) else (0, 0)
    classes = np.zeros(len(whole), np.uint8)
    parts = [b"", b"", b"", b""]
    if low < 0 or high > 255:
        classes[(whole < 0) | (whole > 255)] = 1
        classes[(whole < -(2**15)) | (whole >= 2**15)] = 2
        classes[(whole < -(2**31)) | (whole >= 2**31)] = 3
        for k in (1, 2, 3):
            parts[k] = whole[classes == k].astype(_INTS[k]).tobytes()
        parts[0] = whole[classes == 0].astype(_INTS[0]).tobytes()
    else:
        parts[0] = whole.astype(_INTS[0]).tobytes()
    return [_two_bits(classes), *parts]


def _two_bits(classes: Any) -> bytes:
    short = -len(classes) % 4
    if short:
        classes = np.concatenate([classes, np.zeros(short, np.uint8)])
    packed: bytes = (classes.reshape(-1, 4) @ _PLACES).tobytes()
    return packed


def from_bytes(body: memoryview) -> tuple[list[float], list[int], list[bool], bytes]:
    """What `to_bytes` was given, the bytes in one. ValueError (or struct's error) for anything else; what it makes of
    it is never much larger than it is."""
    count, whole_count, flag_count, told_length = COUNTS.unpack_from(body)
    cursor = _Cursor(body, COUNTS.size)
    classes = cursor.classes(count)
    real = np.zeros(count, "<f8")
    for k, dtype in enumerate(_FLOATS, 1):
        of_class = classes == k
        real[of_class] = cursor.array(dtype, int(np.count_nonzero(of_class)))
    if not np.isfinite(real).all():
        raise ValueError("a number is not finite")
    classes = cursor.classes(whole_count)
    whole = np.zeros(whole_count, "<i8")
    for k, dtype in enumerate(_INTS):
        of_class = classes == k
        whole[of_class] = cursor.array(dtype, int(np.count_nonzero(of_class)))
    flags = np.unpackbits(cursor.array(_INTS[0], -(-flag_count // 8)), bitorder="little")
    told = cursor.take(told_length).tobytes()
    ints: list[int] = whole.tolist()
    if told:
        large = iter(told.split(b" "))
        ints = [int(next(large)) if i == LARGE else i for i in ints]
        if next(large, None) is not None:
            raise ValueError("large ints are left over")
    return real.tolist(), ints, flags[:flag_count].astype(np.bool_).tolist(), cursor.take(None).tobytes()


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

    def classes(self, count: int) -> Any:
        return _UNPACKED[self.array(_INTS[0], -(-count // 4))].reshape(-1)[:count]
