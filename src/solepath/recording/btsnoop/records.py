"""Reading of a btsnoop file: a header, then records of HCI packets, each with the time at which it was logged.

The format is that of RFC 1761 with other datalinks, as Symbian, BlueZ and Android write it. Its numbers are big-endian,
while those in the packets are little-endian."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator
from enum import Enum
from pathlib import Path
from typing import Any

from attrs import frozen
from construct import Const, Int32ub, Struct

from ...wire.error import WireError
from ...wire.fields import Fields, parse_whole
from ..errors import RecordingError, Report, open_file, printable

MAGIC = b"btsnoop\0"
VERSION = 1
TIME_OF_1970 = 0x00DCDDB30F2F8000
"""Time of the start of 1970, us; btsnoop counts from the start of the year 0."""
MAX_RECORD_SIZE = 0x1_0000 + 64
"""Largest size of the packet in a record, bytes: 65,535 bytes of ACL data, with room for the headers before them."""

FILE_HEADER = Struct("magic" / Const(MAGIC), "version" / Int32ub, "datalink" / Int32ub)
HEADER_SIZE = 16


class Datalink(Enum):
    """Format of the records, which says where a record has the kind of its packet."""

    H1 = 1001
    """The record's flags give the kind of packet."""
    H4 = 1002
    """The packet's first byte gives its kind, as Android, bumble and hcidump write it."""
    MONITOR = 2001
    """The record's flags give the adapter and an opcode, as BlueZ's btmon writes it."""


class RecordKind(Enum):
    """Kind of the packet in a record; the value is the first byte of an H4 packet of this kind, except for OTHER."""

    COMMAND = 1
    ACL = 2
    EVENT = 4
    OTHER = 0
    """Voice, isochronous data, or a message of the logger."""


@frozen
class HciRecord:
    """One HCI packet of the log."""

    t: int
    """Time on the logger's clock, us since 1970, UTC."""
    adapter: int
    """Number of the host's Bluetooth adapter."""
    kind: RecordKind
    sent: bool
    """True if the host sent the packet to its controller."""
    data: bytes
    whole: bool
    """False if the logger kept only the start of the packet."""


@frozen
class RecordHeader:
    """The header of a record."""

    original_size: int
    """Size of the packet, bytes."""
    included_size: int
    """Size of the part of the packet that the file holds, bytes."""
    flags: int
    """Bits for the direction and the kind of the packet."""
    drops: int
    """Number of records that the logger lost since the log started."""
    t: int
    """Time on the logger's clock, us since the year 0."""


RECORD_HEADER = Fields(">IIIIq", RecordHeader)
RECORD_HEADER_SIZE = 24

_RECEIVED_FLAG, _COMMAND_OR_EVENT_FLAG = 1, 2
_KIND_BY_MONITOR_OPCODE = {
    2: (RecordKind.COMMAND, True),
    3: (RecordKind.EVENT, False),
    4: (RecordKind.ACL, True),
    5: (RecordKind.ACL, False),
}
"""Kind of the packet, and True if the host sent it, by btmon's opcode."""


def is_btsnoop(path: Path) -> bool:
    """Return whether the file starts as a btsnoop log does, which no pipe can be; RecordingError when unreadable."""
    if _is_pipe(path):
        return False  # bytes that are read from a pipe here could not be read again
    with open_file(path) as file:
        return file.read(len(MAGIC)) == MAGIC


def reject_pipe(path: Path) -> None:
    """Raise RecordingError if `path` is a pipe or a device, because logs are read more than once."""
    if _is_pipe(path):
        raise RecordingError(path, "is a pipe or a device; it is read more than once, so it has to be a file")


def _is_pipe(path: Path) -> bool:
    """Return whether there is something at `path` that is neither a file nor a folder."""
    return path.exists() and not path.is_file() and not path.is_dir()


def read_records(
    path: Path, *, report: Report, flaws: Counter[str], progress: Callable[[int], None] | None = None
) -> Iterator[HciRecord]:
    """Yield the records of a log in order.

    `report` receives a sentence about an incomplete last record. `flaws` counts records that the logger dropped. A file
    that is no btsnoop log raises RecordingError; a damaged record raises it after all records before were yielded."""
    with open_file(path) as file:
        datalink = _read_datalink(path, file.read(HEADER_SIZE))
        number, bytes_read, drops = 0, HEADER_SIZE, 0
        while start := file.read(RECORD_HEADER_SIZE):
            number += 1
            torn = f"{printable(str(path))}: record {number}: cut off in the middle; everything before it is used"
            if len(start) < RECORD_HEADER_SIZE:
                report(torn)
                return
            header: RecordHeader = RECORD_HEADER.parse(start)
            if header.included_size > min(MAX_RECORD_SIZE, header.original_size):
                what = f"is damaged: it claims {header.included_size} of {header.original_size} bytes"
                raise RecordingError(path, what, f"record {number}")
            data = file.read(header.included_size)
            if len(data) < header.included_size:
                report(torn)
                return
            bytes_read += RECORD_HEADER_SIZE + len(data)
            if progress is not None:
                progress(bytes_read)
            if header.drops > drops:
                flaws["records that the logger says it dropped"] += header.drops - drops
            drops = header.drops
            yield _unwrap(datalink, header, data)


def _read_datalink(path: Path, start: bytes) -> Datalink:
    if not start:
        raise RecordingError(path, "is empty")
    try:
        header: Any = parse_whole(FILE_HEADER, start)
    except WireError:
        raise RecordingError(path, "does not begin as a btsnoop log") from None
    if header.version != VERSION:
        raise RecordingError(path, f"is btsnoop of version {header.version}; this release reads version {VERSION}")
    try:
        return Datalink(header.datalink)
    except ValueError:
        supported = ", ".join(f"{one.value} ({one.name})" for one in Datalink)
        raise RecordingError(
            path, f"is btsnoop of datalink {header.datalink}; this release reads {supported}"
        ) from None


def _unwrap(datalink: Datalink, header: RecordHeader, data: bytes) -> HciRecord:
    adapter, kind, sent = 0, RecordKind.OTHER, not header.flags & _RECEIVED_FLAG
    match datalink:
        case Datalink.H4:
            kind = _KIND_BY_H4_BYTE.get(data[0], RecordKind.OTHER) if data else RecordKind.OTHER
            data = data[1:]
        case Datalink.H1 if header.flags & _COMMAND_OR_EVENT_FLAG:
            kind = RecordKind.COMMAND if sent else RecordKind.EVENT
        case Datalink.H1:
            kind = RecordKind.ACL
        case Datalink.MONITOR:
            adapter = header.flags >> 16
            kind, sent = _KIND_BY_MONITOR_OPCODE.get(header.flags & 0xFFFF, (RecordKind.OTHER, False))
    return HciRecord(header.t - TIME_OF_1970, adapter, kind, sent, data, header.included_size == header.original_size)


_KIND_BY_H4_BYTE = {kind.value: kind for kind in RecordKind if kind is not RecordKind.OTHER}
