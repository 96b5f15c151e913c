"""The btsnoop file: a header, then records of HCI packets, each with the time at which it was logged.

The format is that of RFC 1761 with other datalinks, as Symbian, BlueZ and Android write it. It is big-endian, unlike
the packets in it."""

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
YEAR_1970 = 0x00DCDDB30F2F8000
"""Time from the start of the year 0, from which btsnoop counts, to that of 1970, us."""
MAX_RECORD_SIZE = 0x1_0000 + 64
"""Size of a record at most, bytes: the longest ACL packet and its headers. No HCI packet is longer."""

FILE_HEADER = Struct("magic" / Const(MAGIC), "version" / Int32ub, "datalink" / Int32ub)
HEADER_SIZE = 16


class Datalink(Enum):
    """Format of the packets in the records."""

    H1 = 1001
    """No wrapping: the record's flags give the kind of packet."""
    H4 = 1002
    """One byte in front gives the kind: Android, bumble, hcidump."""
    MONITOR = 2001
    """The record's flags hold the adapter and an opcode: BlueZ's btmon."""


class RecordKind(Enum):
    """Kind of a record's content."""

    COMMAND = 1
    ACL = 2
    EVENT = 4
    OTHER = 0
    """Voice, isochronous data, or the logger's own remarks."""


@frozen
class HciRecord:
    """One HCI packet of the log.

    `t`: us since 1970, UTC, by the logger's clock. `sent`: by the host to its controller. `whole`: False when the
    logger kept only the start of the packet."""

    t: int
    adapter: int
    kind: RecordKind
    sent: bool
    data: bytes
    whole: bool


@frozen
class RecordHeader:
    """The header of a record.

    `original`, `included`: size of the packet, and of its part in the file, bytes. `drops`: records lost since the log
    started."""

    original: int
    included: int
    flags: int
    drops: int
    t: int


RECORD_HEADER = Fields(">IIIIq", RecordHeader)
RECORD_HEADER_SIZE = 24

_RECEIVED, _COMMAND_OR_EVENT = 1, 2
_MONITOR = {
    2: (RecordKind.COMMAND, True),
    3: (RecordKind.EVENT, False),
    4: (RecordKind.ACL, True),
    5: (RecordKind.ACL, False),
}
"""Kind of a record and whether it was sent, by btmon's opcode."""


def is_btsnoop(path: Path) -> bool:
    """Return whether the file starts as a btsnoop log does.

    RecordingError when it cannot be read, or only once: reading the start of a pipe would remove it."""
    reject_pipe(path)
    with open_file(path) as file:
        return file.read(len(MAGIC)) == MAGIC


def reject_pipe(path: Path) -> None:
    """Raise RecordingError for a file that exists but can be read only once."""
    if path.exists() and not path.is_file() and not path.is_dir():
        raise RecordingError(path, "is a pipe or a device; it is read more than once, so it has to be a file")


def read_records(
    path: Path, *, report: Report, flaws: Counter[str], progress: Callable[[int], None] | None = None
) -> Iterator[HciRecord]:
    """Yield the records of a log in order.

    `report` gets a sentence about a torn last record; `flaws` counts what the logger left out. RecordingError, after
    everything before it, for a file that is no btsnoop log and for an impossible record."""
    with open_file(path) as file:
        datalink = _datalink(path, file.read(HEADER_SIZE))
        number, read, drops = 0, HEADER_SIZE, 0
        while start := file.read(RECORD_HEADER_SIZE):
            number += 1
            torn = f"{printable(str(path))}: record {number}: cut off in the middle; everything before it is used"
            if len(start) < RECORD_HEADER_SIZE:
                report(torn)
                return
            header: RecordHeader = RECORD_HEADER.parse(start)
            if header.included > min(MAX_RECORD_SIZE, header.original):
                what = f"is damaged: it claims {header.included} of {header.original} bytes"
                raise RecordingError(path, what, f"record {number}")
            data = file.read(header.included)
            if len(data) < header.included:
                report(torn)
                return
            read += RECORD_HEADER_SIZE + len(data)
            if progress is not None:
                progress(read)
            if header.drops > drops:
                flaws["records that the logger says it dropped"] += header.drops - drops
            drops = header.drops
            yield _unwrap(datalink, header, data)


def _datalink(path: Path, start: bytes) -> Datalink:
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
        known = ", ".join(f"{one.value} ({one.name})" for one in Datalink)
        raise RecordingError(path, f"is btsnoop of datalink {header.datalink}; this release reads {known}") from None


def _unwrap(datalink: Datalink, header: RecordHeader, data: bytes) -> HciRecord:
    adapter, kind, sent = 0, RecordKind.OTHER, not header.flags & _RECEIVED
    match datalink:
        case Datalink.H4:
            kind = _H4.get(data[0], RecordKind.OTHER) if data else RecordKind.OTHER
            data = data[1:]
        case Datalink.H1 if header.flags & _COMMAND_OR_EVENT:
            kind = RecordKind.COMMAND if sent else RecordKind.EVENT
        case Datalink.H1:
            kind = RecordKind.ACL
        case Datalink.MONITOR:
            adapter = header.flags >> 16
            kind, sent = _MONITOR.get(header.flags & 0xFFFF, (RecordKind.OTHER, False))
    return HciRecord(header.t - YEAR_1970, adapter, kind, sent, data, header.included == header.original)


_H4 = {kind.value: kind for kind in RecordKind if kind is not RecordKind.OTHER}
