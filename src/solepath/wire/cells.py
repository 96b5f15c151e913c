"""Twelve-bit values packed least significant bit first, the format of pressure cells in a frame.

Value i occupies the bits 12 i .. 12 i + 11 of the block, where bit b is bit (b mod 8) of byte b // 8. Two values share
three bytes; an odd count leaves the high nibble of the last byte zero."""

from __future__ import annotations

import struct
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

from construct import FormatFieldError, StreamError

from .fields import Definition, malformed

if TYPE_CHECKING:
    from typing import IO

MAX_VALUE = 4095
"""Largest value of 12 bits."""

_LOW_NIBBLE = bytes(b & 15 for b in range(256))
_HIGH_NIBBLE = bytes(b >> 4 for b in range(256))
_LOW_NIBBLE_RAISED = bytes((b & 15) << 4 for b in range(256))


def packed_size(count: int) -> int:
    """Return the number of bytes that `count` values take."""
    return (12 * count + 7) // 8


def unpack12(data: bytes, count: int) -> tuple[int, ...]:
    """Return `count` values from the `packed_size(count)` bytes of `data`.

    WireError when the unused nibble is not zero."""
    # A pair lies in the bytes x, y, z as x | low(y) << 8 and high(y) | z << 4. All pairs are spread into 16-bit
    # words at once by slices and translation tables: 3 us for 96 cells, where a loop over cells takes 15 us.
    if count & 1:
        if data[-1] > 15:
            raise malformed(f"the unused nibble after {count} values is not zero")
        data += b"\0"
    x, y, z = data[0::3], data[1::3], data[2::3]
    pairs = len(x)
    second = int.from_bytes(y.translate(_HIGH_NIBBLE), "little") | int.from_bytes(
        z.translate(_LOW_NIBBLE_RAISED), "little"
    )
    words = bytearray(4 * pairs)
    words[0::4] = x
    words[1::4] = y.translate(_LOW_NIBBLE)
    words[2::4] = second.to_bytes(pairs, "little")
    words[3::4] = z.translate(_HIGH_NIBBLE)
    return struct.unpack_from(f"<{count}H", words)


def pack12(values: Sequence[int]) -> bytes:
    """Return the `packed_size(len(values))` bytes of `values`, each 0 to 4095. ValueError when one is not."""
    bits = 0
    for value in reversed(values):
        if not 0 <= value <= MAX_VALUE:
            raise ValueError(f"{value} does not fit in 12 bits")
        bits = bits << 12 | value
    return bits.to_bytes(packed_size(len(values)), "little")


class Packed12(Definition):
    """A block of 12-bit values; `count` reads their number from the context."""

    def __init__(self, count: Callable[[Any], int]) -> None:
        super().__init__()
        self._count = count

    def _parse(self, stream: IO[bytes], context: Any, path: str) -> tuple[int, ...]:
        count = self._count(context)
        data = stream.read(packed_size(count))
        if len(data) != packed_size(count):
            raise StreamError(f"{count} values need {packed_size(count)} bytes, has {len(data)}", path=path)
        return unpack12(data, count)

    def _build(self, obj: Any, stream: IO[bytes], context: Any, path: str) -> Any:
        if len(obj) != self._count(context):
            raise FormatFieldError(f"{len(obj)} values where {self._count(context)} belong", path=path)
        stream.write(pack12(obj))
        return obj
