"""Records of HCI packets, each with the time at which it was logged, of every kind of capture (../captures.py)."""

from __future__ import annotations

import struct
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import suppress
from enum import Enum
from functools import partial
from pathlib import Path
from typing import BinaryIO

from attrs import define, frozen

from ..captures import (
    LONGEST_MAGIC,
    MONITOR,
    NAMED_LINKS,
    PHDR,
    READ_LINKS,
    Captured,
    DamageError,
    UnreadError,
    is_capture,
    read_capture,
)
from ..errors import RecordingError, Report, open_file, printable
from ..unpacking import names_in, open_member, open_unpacked

LOG_NAMES = ("btsnoo", ".pklg", ".pcap", ".cfa")
"""Parts of the names of logs in a phone's bug report."""
REPORT_NAMES = ("fs/", "bugreport", "dumpstate", "dumpsys")
"""Starts of the names of files in an Android bug report."""
SWITCH_ON = (
    "in the developer options of the phone, set the Bluetooth HCI snoop log to Enabled (not Filtered), switch "
    "Bluetooth off and on, walk, and take the bug report then"
)
"""What brings a Bluetooth log into a bug report."""
RECORD_HCI = (
    "capture HCI on the phone or computer that receives: its btsnoop log, PacketLogger of Apple, btmon, or Wireshark "
    "on bluetooth0"
)
"""What to do when a capture is not of HCI."""


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
    sent: bool | None
    """True if the host sent the packet to its controller; None if the capture does not say it."""
    data: bytes
    whole: bool
    """False if the logger kept only the start of the packet."""


_MONITOR_OPCODES = {
    2: (RecordKind.COMMAND, True),
    3: (RecordKind.EVENT, False),
    4: (RecordKind.ACL, True),
    5: (RecordKind.ACL, False),
}
"""Kind of the packet, and True if the host sent it, by btmon's opcode."""


def is_log(path: Path) -> bool:
    """Return whether the file is a capture, or has one in it, which no pipe can be; RecordingError when unreadable."""
    if is_pipe(path):
        return False  # bytes that are read from a pipe here could not be read again
    return bool(_logs_in(path))


def _logs_in(path: Path) -> list[Callable[[], BinaryIO]]:
    """Return what opens each log of a file: the file itself, or logs in a bug report."""
    if path.suffix.lower() != ".zip":
        openers: list[Callable[[], BinaryIO]] = [partial(open_unpacked, path)]
    else:
        names = names_in(path)
        found = [name for name in names if any(part in Path(name).name.lower() for part in LOG_NAMES)]
        openers = [partial(open_member, path, name) for name in found]
    logs = [one for one in openers if is_capture(_start(one))]
    if not logs and path.suffix.lower() == ".zip" and any(name.lower().startswith(REPORT_NAMES) for name in names):
        raise RecordingError(path, "is a bug report without a Bluetooth log", repair=SWITCH_ON)
    return logs


def _start(opener: Callable[[], BinaryIO]) -> bytes:
    with opener() as file:
        return file.read(LONGEST_MAGIC)


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
    """Yield the records of a log in order; those of several logs of a bug report, which follow each other, as one.

    `report` receives a sentence about an incomplete last record. `flaws` counts records that the logger dropped, and
    those that are no HCI. A file that is no capture raises RecordingError; a damaged record raises it after all records
    before were yielded."""
    logs = [_Log(path, one, report, flaws, progress) for one in _logs_in(path)]
    if not logs:
        raise RecordingError(
            path, "does not begin as a Bluetooth capture" if _start(partial(open_file, path)) else "is empty"
        )
    newest: int | None = None
    for log in sorted(logs, key=_Log.first_time) if len(logs) > 1 else logs:
        end = newest
        for record in log.read():
            if end is None or record.t > end:  # a log that was filtered repeats another one
                newest = record.t
                yield record


@define
class _Log:
    """One log of a file; the arguments are those of `read_records`."""

    path: Path
    opener: Callable[[], BinaryIO]
    report: Report
    flaws: Counter[str]
    progress: Callable[[int], None] | None
    number: int = 0
    """Number of records that were read."""

    def first_time(self) -> int:
        """Return the time of the first record, us since 1970; 0 without one."""
        with self.opener() as file, suppress(DamageError, UnreadError, EOFError, struct.error, IndexError):
            return next((one.t for one in read_capture(file)), 0)
        return 0

    def read(self) -> Iterator[HciRecord]:
        """Yield the records of the log that are HCI."""
        links, drops = Counter[int](), 0
        with self.opener() as file:
            try:
                for self.number, one in enumerate(read_capture(file), 1):
                    if one.drops > drops:
                        self.flaws["records that the logger says it dropped"] += one.drops - drops
                    drops = one.drops
                    if self.progress is not None:
                        self.progress(file.tell())
                    links[one.link] += 1
                    if one.link in READ_LINKS:
                        yield _unwrap(one)
            except (DamageError, struct.error, IndexError) as error:  # struct's are of blocks that are too short
                raise RecordingError(self.path, f"is damaged: {error}", f"record {self.number + 1}") from None
            except UnreadError as error:
                raise RecordingError(self.path, str(error)) from None
            except EOFError:
                where = f"record {self.number + 1}: cut off in the middle; everything before it is used"
                self.report(f"{printable(str(self.path))}: {where}")
        others = {link: count for link, count in links.items() if link not in READ_LINKS}
        if others and not links.keys() & READ_LINKS:
            which = ", ".join(f"{link}{NAMED_LINKS.get(link, '')}" for link in others)
            raise RecordingError(self.path, f"is a capture of link type {which}, not of HCI", repair=RECORD_HCI)
        for link, count in others.items():
            self.flaws[f"records of link type {link}{NAMED_LINKS.get(link, '')}, which are not HCI"] += count


def _unwrap(one: Captured) -> HciRecord:
    data, whole = one.data, len(one.data) >= one.size
    if one.link == MONITOR:
        adapter, opcode = int.from_bytes(data[:2], "big"), int.from_bytes(data[2:4], "big")
        return HciRecord(one.t, adapter, *_MONITOR_OPCODES.get(opcode, (RecordKind.OTHER, False)), data[4:], whole)
    sent = one.sent
    if one.link == PHDR:
        sent, data = data[3:4] != b"\1", data[4:]
    return HciRecord(one.t, 0, RecordKind(data[0] if data else 0), sent, data[1:], whole)
