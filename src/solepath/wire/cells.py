"""Twelve-bit values packed least significant bit first, the format of pressure cells in a frame.

Value i has the bits 12 i to 12 i + 11 of the block, where bit b is bit (b mod 8) of byte b // 8. Two values take three
bytes. If the number of values is odd, the high nibble (four bits) of the last byte is zero."""

from __future__ import annotations

import struct
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

from .fields import LONGEST_VALUE, Definition, malformed

if TYPE_CHECKING:
    from typing import IO

FIRST_OF_PAIR = int.from_bytes(b"\xff\x0f\0\0" * LONGEST_VALUE, "little")
SECOND_OF_PAIR = int.from_bytes(b"\0\xf0\xff\0" * LONGEST_VALUE, "little")
"""Bits of the first and of the second value of each pair in four bytes, three of which are the packed ones."""


def packed_size(count: int) -> int:
    """Return the number of bytes that `count` values take."""
    return (12 * count + 7) // 8


def unpack12(data: bytes, count: int) -> tuple[int, ...]:
    """Return `count` values from the `packed_size(count)` bytes of `data`; WireError if an unused nibble is not 0."""
    # All pairs are spread to four bytes, and their second values to the upper two of them, by a few operations on whole
    # blocks, which takes 3 us for 96 cells; a loop over the cells takes 15 us.
    if count & 1:
        if data[-1] > 15:
            raise malformed(f"the unused nibble after {count} values is not zero")
        data += b"\0"
    pairs = bytearray(len(data) // 3 * 4)
    pairs[0::4], pairs[1::4], pairs[2::4] = data[0::3], data[1::3], data[2::3]
    bits = int.from_bytes(pairs, "little")
    words = bits & FIRST_OF_PAIR | (bits & SECOND_OF_PAIR) << 4
    return struct.unpack_from(f"<{count}H", words.to_bytes(len(pairs), "little"))


def pack12(values: Sequence[int]) -> bytes:
    """Return the `packed_size(len(values))` bytes of `values`; ValueError unless each is a whole number, 0 to 4095."""
    try:
        digits = struct.pack(f">{len(values)}H", *reversed(values)).hex().encode()  # four a value, the last value first
    except struct.error as error:
        raise ValueError(f"values that are not whole numbers of 12 bits: {error}") from error
    if digits[0::4].strip(b"0"):
        raise ValueError(f"{max(values)} does not fit in 12 bits")
    packed = bytearray(3 * len(values))
    packed[0::3], packed[1::3], packed[2::3] = digits[1::4], digits[2::4], digits[3::4]
    return int(packed or b"0", 16).to_bytes(packed_size(len(values)), "little")


class Packed12(Definition):
    """A construct for a block of 12-bit values; `count` returns their number from construct's context.

    The record around it checks first that it has all of its bytes."""

    def __init__(self, count: Callable[[Any], int]) -> None:
        super().__init__()
        self.count = count

    def _parse(self, stream: IO[bytes], context: Any, path: str) -> tuple[int, ...]:
        count = self.count(context)
        return unpack12(stream.read(packed_size(count)), count)

    def _build(self, obj: Any, stream: IO[bytes], context: Any, path: str) -> Any:
        stream.write(pack12(obj))
        return obj
