"""Writing of recordings of packets, which are JSON Lines as in protocol/recording.md."""

from __future__ import annotations

import io
import json
import os
from collections.abc import Mapping
from contextlib import suppress
from math import isfinite
from pathlib import Path
from stat import S_ISREG
from typing import Any

from ..saving.lock import LOCKED, take_lock
from ..types import Packet
from .bad_rows import LONGEST_LINE
from .errors import RecordingError, os_error_text
from .packets import FORMAT, VERSION, header_fault

ENCODER = json.JSONEncoder(allow_nan=False)
MAX_TRIES = 100
"""Number of times that a file which another program removes meanwhile is opened again."""


class PacketWriter:
    """Writes packets as a recording, and passes each line to the operating system before `write` returns.

        with PacketWriter("walk.jsonl", {"began": "2026-11-21T09:30:00Z", "began_t": 12.5}) as writer:
            writer.write(packet)

    A file with content is not replaced: RecordingError is raised at once. With `replace=True` it is replaced when the
    first packet is written, so that it stays as it was if none comes. A new or empty file gets its header at once. From
    the start to `close` the file is locked: a second writer of the same file raises RecordingError and changes nothing.

    `count`: number of packets in the file. If the process is killed, written packets are safe, and the lock is free.
    RecordingError when the file cannot be opened or written, for example on a full disk. Then the file ends with its
    last complete packet, and writing may continue when there is space again. ValueError for a packet or header that a
    recording cannot hold (a time that is not finite, a line that is too long), TypeError for values that JSON does not
    have (bytes, dates); the file is then unchanged. Text that is not valid Unicode (half of a surrogate pair, as in the
    name of a file or device) is written as a JSON escape and read back as it was."""

    def __init__(self, path: Path | str, header: Mapping[str, Any] = {}, *, replace: bool = False) -> None:
        """Open and lock the file.

        `header`: further keys for the first line, for example `began` and `began_t` (protocol/recording.md), or the
        result of `read_header` for another recording. ValueError when it names another format or version."""
        self.count = 0
        self._path = Path(path)
        fields = {"format": FORMAT, "version": VERSION, **header}
        fault = header_fault(fields)
        if fault is not None:
            raise ValueError(f"a header that {fault}")
        self._header: bytes | None = _format_line(fields)
        """First line, as long as it is not written."""
        self._size = 0
        """Size of the complete lines in the file, bytes."""
        self._torn = False
        """True when an incomplete line is in the file and could not be removed."""
        self._is_new = not self._path.exists()
        self._file, self._had_content = open_target(
            self._path, "" if replace else "PacketWriter(..., replace=True) does"
        )
        if not self._had_content:
            try:
                self._write_header()
            except BaseException:
                self.discard()
                raise

    @property
    def replaces(self) -> bool:
        """True while the file has earlier content, which the first packet replaces."""
        return self._had_content

    def write(self, packet: Packet) -> None:
        """Write one packet."""
        line = format_packet(packet)
        self._write_header()
        self._write_line(line)
        self.count += 1

    def _write_header(self) -> None:
        """Replace the earlier content of the file by the header, if that was not done before."""
        if self._header is None:
            return
        if self._had_content:
            try:
                self._file.truncate(0)
            except OSError as error:
                raise RecordingError(self._path, os_error_text(error)) from error
            self._had_content = False
        self._write_line(self._header)
        self._header = None

    def _write_line(self, encoded: bytes) -> None:
        if self._torn:
            raise RecordingError(self._path, f"ends in the middle of a line; {self._describe_saved()}")
        bytes_written = 0
        try:
            while bytes_written < len(encoded):
                bytes_written += self._file.write(encoded[bytes_written:]) or 0
        except OSError as error:
            self._remove_torn_line()
            raise RecordingError(self._path, f"{os_error_text(error)}; {self._describe_saved()}") from error
        except BaseException:  # for example KeyboardInterrupt between two parts of a line
            self._remove_torn_line()
            raise
        self._size += bytes_written

    def _remove_torn_line(self) -> None:
        try:
            if self._file.tell() != self._size:
                self._file.truncate(self._size)
                self._file.seek(self._size)
        except OSError:  # a pipe cannot be truncated
            self._torn = True

    def _describe_saved(self) -> str:
        return f"the {self.count} packets before that are safe" if self.count != 1 else "the packet before that is safe"

    def close(self) -> None:
        """Close the file and release its lock; a file that had no content gets its header.

        RecordingError when the system reports only now that data could not be written."""
        if self._file.closed:
            return
        try:
            if not self._had_content:
                self._write_header()
        finally:
            try:
                self._file.close()
            except OSError as error:
                what = f"{os_error_text(error)} on closing; the last packets may be missing"
                raise RecordingError(self._path, what) from error

    def discard(self) -> None:
        """Close the file and leave what was there: the header is removed again, and so is a file that was made for it.

        After the first packet it is as `close`, and also when another program has changed the file or its name."""
        if self._file.closed:
            return
        if self.count or self._had_content:
            self.close()
            return
        with suppress(OSError), self._file:  # a pipe cannot be truncated
            status = os.fstat(self._file.fileno())
            if S_ISREG(status.st_mode) and status.st_size == self._size:
                self._file.truncate(0)
                if self._is_new and os.path.samestat(status, self._path.stat()):
                    self._path.unlink()  # Windows removes no open file: an empty one is left, which anybody may replace

    def __enter__(self) -> PacketWriter:
        return self

    def __exit__(self, *error: object) -> None:
        self.close()


def format_packet(packet: Packet) -> bytes:
    """Return the line of a packet; TypeError for another object, ValueError when it cannot be recorded."""
    if not isinstance(packet, Packet):
        raise TypeError(f"a recording is written of packets, not {type(packet).__name__}")
    if not isfinite(packet.t):
        raise ValueError(f"a packet at {packet.t} s cannot be recorded")
    fields = {"t": float(packet.t), "site": packet.site.value, "channel": packet.channel, "data": packet.data.hex()}
    if packet.device:
        fields["device"] = packet.device
    return _format_line(fields)


def _format_line(fields: dict[str, Any]) -> bytes:
    encoded = ENCODER.encode(fields).encode("utf-8") + b"\n"
    if len(encoded) > LONGEST_LINE:
        raise ValueError(f"a line of {len(encoded)} bytes is too long for a recording")
    return encoded


def open_target(path: Path, hint: str = "") -> tuple[io.FileIO, bool]:
    """Return the file of a writer, open and locked, and whether it has content; RecordingError when it cannot be used.

    `hint` says what replaces a file with content; "" for a writer that does."""
    try:
        file, has_content = open_locked(path)
    except OSError as error:
        raise RecordingError(path, os_error_text(error)) from error
    if has_content and hint:
        file.close()
        raise RecordingError(path, f"exists, and is not replaced; {hint}")
    return file, has_content


def open_locked(path: Path) -> tuple[io.FileIO, bool]:
    """Return the file, open for writing and locked, and whether it has content; a pipe or device is not locked.

    OSError when it cannot be opened, RecordingError when another program has locked it."""
    for _ in range(MAX_TRIES):
        # unbuffered, so that a failed write is an error at once and `close` has no data to lose
        file = io.FileIO(str(path), "wb", opener=_open_untruncated)
        try:
            status = os.fstat(file.fileno())
            if not S_ISREG(status.st_mode):
                return file, False
            if not take_lock(file.fileno()):
                raise RecordingError(path, LOCKED)
            size = os.fstat(file.fileno()).st_size  # of now, since the other program may have written until the lock
            with suppress(FileNotFoundError):
                # a program that recorded nothing removes its file; a lock of that file would protect nothing
                if os.path.samestat(status, path.stat()):
                    return file, size > 0
        except BaseException:
            file.close()
            raise
        file.close()
    raise RecordingError(path, "is removed by another program again and again")


def _open_untruncated(path: str, flags: int) -> int:
    return os.open(path, flags & ~os.O_TRUNC, 0o666)
