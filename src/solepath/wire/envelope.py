"""The envelope of every record of the insole protocol: magic, version and type at the start, CRC-16 at the end.

It is used by the parsers of frames, fragments and INFO, by device setup, and by the search for records in a capture."""

from __future__ import annotations

from binascii import crc_hqx

from ..events import Rejection
from .error import WireError
from .fields import LONGEST_VALUE, malformed

MAGIC = 0xF5
"""First byte of every record."""
FRAME_TYPE = 0x10
"""Second byte of a frame: version 1, type 0."""
INFO_TYPE = 0x11
"""Second byte of an INFO record: version 1, type 1."""

CRC_SIZE, CRC_START = 2, 0xFFFF
"""Size in bytes and start value of the CRC.

CRC-16/CCITT-FALSE: polynomial 0x1021, start 0xFFFF, not reflected, no final XOR; "123456789" gives 0x29B1."""


def check_start(data: bytes, kind: int, header_size: int) -> None:
    """Raise WireError unless `data` starts with the magic and the type `kind` and has a whole header."""
    if len(data) > 0 and data[0] != MAGIC:
        raise malformed(f"begins with {data[0]:#04x}, not {MAGIC:#04x}")
    if len(data) > 1 and data[1] != kind:
        raise malformed(f"version {data[1] >> 4} type {data[1] & 15}, not version {kind >> 4} type {kind & 15}")
    if len(data) < header_size:
        raise WireError(Rejection.TRUNCATED, f"{len(data)} bytes, the header has {header_size}")


def check_end(data: bytes, size: int) -> None:
    """Raise WireError unless `data` has the `size` that its header states and a correct CRC."""
    if len(data) < size:
        raise WireError(Rejection.TRUNCATED, f"{len(data)} of {size} bytes")
    if len(data) > size or size > LONGEST_VALUE:
        raise WireError(Rejection.OVERSIZED, f"{len(data)} bytes where {min(size, LONGEST_VALUE)} belong")
    stated, computed = int.from_bytes(data[-CRC_SIZE:], "little"), crc_hqx(data[:-CRC_SIZE], CRC_START)
    if stated != computed:
        raise WireError(Rejection.CHECKSUM, f"CRC {stated:#06x}, computed {computed:#06x}")


def seal(body: bytes) -> bytes:
    """Return `body` followed by its CRC; ValueError when that is longer than an attribute value may be."""
    if len(body) + CRC_SIZE > LONGEST_VALUE:
        raise ValueError(f"{len(body) + CRC_SIZE} bytes, an attribute value has at most {LONGEST_VALUE}")
    return body + crc_hqx(body, CRC_START).to_bytes(CRC_SIZE, "little")
