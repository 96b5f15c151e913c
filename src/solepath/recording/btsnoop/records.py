"""Reading of captures of HCI packets as records, each with the time at which it was logged.

A btsnoop file is a header, then records: the format is that of RFC 1761 with other datalinks, as Symbian, BlueZ and
Android write it. Its numbers are big-endian, while those in the packets are little-endian. Another kind of capture is
another function that yields HciRecord; nothing else here knows of files."""

from __future__ import annotations

import struct
from collections import Counter
from collections.abc import Callable, Iterator
from enum import Enum
from pathlib import Path

from attrs import frozen

from ..errors import RecordingError, Report, open_file, printable

MAGIC = b"btsnoop\0"
VERSION = 1
TIME_OF_1970 = 0x00DCDDB30F2F8000
"""Time of the start of 1970, us; btsnoop counts from the start of the year 0."""
MAX_RECORD_SIZE = 0x1_0000 + 64
"""Largest size of the packet in a record, bytes: 65,535 bytes of ACL data, with room for the headers before them."""
FILE_HEADER = struct.Struct(">8sII")
"""Magic, version, datalink."""
RECORD_HEADER = struct.Struct(">IIIIq")
"""Size of the packet and of the part that the file holds, flags, records lost so far, time since the year 0, us."""


class Datalink(Enum):
    """Format of the records, which says where a record has the kind of its packet."""

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

    @classmethod
    def _missing_(cls, value: object) -> RecordKind:
        return cls.OTHER


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


_RECEIVED_FLAG = 1
_MONITOR_OPCODES = {
    2: (RecordKind.COMMAND, True),
    3: (RecordKind.EVENT, False),
    4: (RecordKind.ACL, True),
    5: (RecordKind.ACL, False),
}
"""Kind of the packet, and True if the host sent it, by btmon's opcode."""


def is_btsnoop(path: Path) -> bool:
    """Return whether the file starts as a btsnoop log does, which no pipe can be; RecordingError when unreadable."""
    if is_pipe(path):
        return False  # bytes that are read from a pipe here could not be read again
    with open_file(path) as file:
        return file.read(len(MAGIC)) == MAGIC


def reject_pipe(path: Path) -> None:
    """Raise RecordingError if `path` is a pipe or a device, because logs are read more than once."""
    if is_pipe(path):
        raise RecordingError(path, "is a pipe or a device; it is read more than once, so it has to be a file")


def is_pipe(path: Path) -> bool:
    """Return whether there is something at `path` that is neither a file nor a folder."""
    return path.exists() and not path.is_file() and not path.is_dir()


def read_records(
    path: Path, *, report: Report, flaws: Counter[str], progress: Callable[[int], None] | None = None
) -> Iterator[HciRecord]:
    """Yield the records of a log in order.

    `report` receives a sentence about an incomplete last record. `flaws` counts records that the logger dropped. A file
    that is no btsnoop log raises RecordingError; a damaged record raises it after all records before were yielded."""
    with open_file(path) as file:
        datalink = _parse_datalink(path, file.read(FILE_HEADER.size))
        number = drops_before = 0
        while start := file.read(RECORD_HEADER.size):
            number += 1
            is_cut = len(start) < RECORD_HEADER.size
            size, included, flags, drops, t = RECORD_HEADER.unpack(start) if not is_cut else (0, 0, 0, 0, 0)
            if included > min(MAX_RECORD_SIZE, size):
                raise RecordingError(path, f"is damaged: it claims {included} of {size} bytes", f"record {number}")
            data = file.read(included)
            if is_cut or len(data) < included:
                report(f"{printable(str(path))}: record {number}: cut off in the middle; everything before it is used")
                return
            if progress is not None:
                progress(file.tell())
            if drops > drops_before:
                flaws["records that the logger says it dropped"] += drops - drops_before
            drops_before = drops
            yield _unwrap(datalink, t - TIME_OF_1970, flags, data, included == size)


def _parse_datalink(path: Path, start: bytes) -> Datalink:
    magic, version, datalink = FILE_HEADER.unpack(start.ljust(FILE_HEADER.size)[: FILE_HEADER.size])
    if len(start) < FILE_HEADER.size or magic != MAGIC:
        raise RecordingError(path, "does not begin as a btsnoop log" if start else "is empty")
    found = next((one for one in Datalink if one.value == datalink and version == VERSION), None)
    if found is None:
        readable = ", ".join(f"{one.value} ({one.name})" for one in Datalink)
        what = f"is btsnoop of datalink {datalink}, version {version}"
        raise RecordingError(path, f"{what}; this release reads {readable}, version {VERSION}")
    return found


def _unwrap(datalink: Datalink, t: int, flags: int, data: bytes, whole: bool) -> HciRecord:
    if datalink is Datalink.MONITOR:
        return HciRecord(t, flags >> 16, *_MONITOR_OPCODES.get(flags & 0xFFFF, (RecordKind.OTHER, False)), data, whole)
    return HciRecord(t, 0, RecordKind(data[0] if data else 0), not flags & _RECEIVED_FLAG, data[1:], whole)
