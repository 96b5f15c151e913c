"""Recordings of packets: JSON Lines as in protocol/recording.md, written line by line and read back.

Reading delivers everything before the first damage, then raises an error with one sentence on the damage and its place.
"""

from __future__ import annotations

import io
import json
from collections.abc import Callable, Iterator, Mapping
from datetime import UTC, datetime
from math import isfinite
from pathlib import Path
from sys import float_info
from typing import Any, BinaryIO

from ..types import Packet, Site
from .errors import RecordingError, Report, open_file, os_error_text, printable, warn

FORMAT = "solepath-packets"
"""Value of the key "format" in the header."""
VERSION = 1
"""Version of the format that this release reads and writes."""
LONGEST_LINE = 65_536
"""Longest line, bytes; protocol/recording.md: "No line is longer than 65,536 bytes"."""


def read_header(path: Path | str) -> dict[str, Any]:
    """Return the first line of a recording. RecordingError when it is not the header of one."""
    path = Path(path)
    with open_file(path) as file:
        for number, _, line in _read_lines(file):
            try:
                fields = _parse_object(line)
                _check_header(fields)
            except _LineFlaw as flaw:
                raise RecordingError(path, str(flaw), f"line {number}") from None
            return fields
    raise RecordingError(path, "is empty")


def read_start_time(header: Mapping[str, Any]) -> tuple[datetime, float | None] | None:
    """Return the time of day (UTC) from a header, and the packets' time `t` (s) at that moment.

    `t` is None where the moment is that of the first packet. The result is None where the header has no start, or one
    that cannot be used."""
    text, t = header.get("began"), header.get("began_t")
    if not isinstance(text, str) or type(t) not in (int, float, type(None)):
        return None
    try:
        moment = datetime.fromisoformat(text)
        at = None if t is None else float(t)
        if moment.tzinfo is None or (at is not None and not isfinite(at)):
            return None
        return moment.astimezone(UTC), at
    except (ValueError, OverflowError):
        return None


def read_packets(
    path: Path | str, *, report: Report = warn, progress: Callable[[int], None] | None = None
) -> Iterator[Packet]:
    """Return an iterator over the packets of a recording in the order in which they arrived; it reads as it goes.

    `report` gets one sentence about a torn last line. `progress` gets the number of bytes read so far, line by line.
    RecordingError, after the packets before the damage, for anything else that protocol/recording.md does not allow."""
    path = Path(path)
    with open_file(path) as file:
        header_seen = False
        for number, read, line in _read_lines(file):
            where = f"line {number}"
            if progress is not None:
                progress(read)
            try:
                fields = _parse_object(line)
                if not header_seen:
                    _check_header(fields)
                    header_seen = True
                    continue
                packet = _parse_packet(fields)
            except _NotAnObject as flaw:
                # an object ends with its brace, so a line that was cut off is never an object
                if header_seen and not line.endswith(b"\n") and len(line) <= LONGEST_LINE:
                    report(f"{printable(str(path))}: {where}: cut off in the middle; everything before it is used")
                    return
                hint = "" if header_seen else "; samples have names that end in .npz or .csv"
                raise RecordingError(path, f"{flaw}{hint}", where) from None
            except _LineFlaw as flaw:
                raise RecordingError(path, str(flaw), where) from None
            yield packet
        if not header_seen:
            raise RecordingError(path, "is empty")


def _read_lines(file: BinaryIO) -> Iterator[tuple[int, int, bytes]]:
    """Yield the lines that are not blank, each with its number and the number of bytes read with it."""
    read = number = 0
    while line := file.readline(LONGEST_LINE + 1):
        number, read = number + 1, read + len(line)
        if line.strip():
            yield number, read, line


class _LineFlaw(Exception):
    """Error with a description of the flaw of one line."""


class _NotAnObject(_LineFlaw):
    """Error for a line that is not a JSON object."""


def _parse_object(line: bytes) -> dict[str, Any]:
    if len(line) > LONGEST_LINE:
        raise _NotAnObject(f"is longer than {LONGEST_LINE} bytes, so this is not a recording of packets")
    try:
        value = json.loads(line.decode("utf-8"), parse_constant=_reject_constant)
    except UnicodeDecodeError:
        raise _NotAnObject("is not text, so this is not a recording of packets") from None
    except (ValueError, RecursionError):
        raise _NotAnObject("is not JSON") from None
    if not isinstance(value, dict):
        raise _NotAnObject(f"is not a JSON object but {_short(value)}")
    return value


def _reject_constant(name: str) -> None:
    raise _NotAnObject(f"{name} is not JSON")


def _check_header(header: dict[str, Any]) -> None:
    if header.get("format") != FORMAT:
        raise _LineFlaw(f'is not the header of a recording: "format" is not "{FORMAT}"')
    version = header.get("version")
    if type(version) is not int or version != VERSION:
        raise _LineFlaw(f"is of version {_short(version)}; this release reads version {VERSION}")


def _parse_packet(fields: dict[str, Any]) -> Packet:
    for key in ("t", "site", "channel", "data"):
        if key not in fields:
            raise _LineFlaw(f'"{key}" is missing')
    t, site, channel, data = fields["t"], fields["site"], fields["channel"], fields["data"]
    if type(t) not in (int, float):
        raise _LineFlaw(f'"t" is not a number but {_short(t)}')
    if not abs(t) <= float_info.max:
        raise _LineFlaw('"t" is not a finite number')
    if not isinstance(site, str) or site not in _SITES:
        raise _LineFlaw(f'"site" is not one of {", ".join(_SITES)} but {_short(site)}')
    if not isinstance(channel, str):
        raise _LineFlaw(f'"channel" is not text but {_short(channel)}')
    if not isinstance(data, str) or len(data) % 2 or not _HEX.issuperset(data):
        raise _LineFlaw(f'"data" is not pairs of hexadecimal digits but {_short(data)}')
    device = fields.get("device", "")
    if not isinstance(device, str):
        raise _LineFlaw(f'"device" is not text but {_short(device)}')
    return Packet(t=float(t), site=_SITES[site], channel=channel, data=bytes.fromhex(data), device=device)


_SITES = {site.value: site for site in Site}
_HEX = frozenset("0123456789abcdefABCDEF")


def _short(value: Any) -> str:
    return printable(json.dumps(value), 40)


def _format_line(fields: dict[str, Any]) -> bytes:
    encoded = json.dumps(fields, allow_nan=False).encode("utf-8") + b"\n"
    if len(encoded) > LONGEST_LINE:
        raise ValueError(f"a line of {len(encoded)} bytes is too long for a recording")
    return encoded


class PacketWriter:
    """Writes packets as a recording; each line goes to the operating system before the next packet is taken.

        with PacketWriter("walk.jsonl", {"began": "2026-11-21T09:30:00Z", "began_t": 12.5}) as writer:
            writer.write(packet)

    An existing file is replaced. `count`: number of packets in the file. A process that is killed loses nothing that
    was written. RecordingError when the file cannot be opened or written (disk full); then it ends with its last whole
    packet, and once there is room again writing may go on. ValueError for a packet that no recording can hold (a time
    that is not finite, a line that would be too long) and for such a header; it leaves the file as it was."""

    def __init__(self, path: Path | str, header: Mapping[str, Any] = {}) -> None:
        """Open the file and write its header.

        `header`: further keys for the first line: `began` and `began_t` (protocol/recording.md), a note; or the whole
        result of `read_header` for another recording. ValueError when it names another format or version."""
        self.count = 0
        self._path = Path(path)
        own = {"format": FORMAT, "version": VERSION}
        try:
            _check_header({**own, **header})
        except _LineFlaw as flaw:
            raise ValueError(f"a header that {flaw}") from None
        first = _format_line({**own, **header})
        self._size = 0
        """Size of the whole lines, bytes."""
        self._torn = False
        """True when half a line is in the file and could not be removed."""
        try:
            # unbuffered: a failed write shows at once, and no data are left for close to lose
            self._file: io.FileIO = self._path.open("wb", buffering=0)
        except OSError as error:
            raise RecordingError(self._path, os_error_text(error)) from error
        try:
            self._put(first)
        except BaseException:
            self._file.close()
            raise

    def write(self, packet: Packet) -> None:
        """Write one packet."""
        if not isfinite(packet.t):
            raise ValueError(f"a packet at {packet.t} s cannot be recorded")
        line = {"t": packet.t, "site": packet.site.value, "channel": packet.channel, "data": packet.data.hex()}
        if packet.device:
            line["device"] = packet.device
        self._put(_format_line(line))
        self.count += 1

    def _put(self, encoded: bytes) -> None:
        if self._torn:
            raise RecordingError(self._path, f"ends in the middle of a line; {self._saved_count()}")
        done = 0
        try:
            while done < len(encoded):
                done += self._file.write(encoded[done:]) or 0
        except OSError as error:
            self._truncate()
            raise RecordingError(self._path, f"{os_error_text(error)}; {self._saved_count()}") from error
        except BaseException:  # such as KeyboardInterrupt between two halves of a line
            self._truncate()
            raise
        self._size += done

    def _truncate(self) -> None:
        """Remove a partly written line, so that the file ends with its last whole line."""
        try:
            if self._file.tell() != self._size:
                self._file.truncate(self._size)
                self._file.seek(self._size)
        except OSError:  # a pipe
            self._torn = True

    def _saved_count(self) -> str:
        return f"the {self.count} packets before that are safe" if self.count != 1 else "the packet before that is safe"

    def close(self) -> None:
        """Close the file. RecordingError when the system finds only now that it could not keep the data."""
        try:
            self._file.close()
        except OSError as error:
            raise RecordingError(
                self._path, f"{os_error_text(error)} on closing; the last packets may be missing"
            ) from error

    def __enter__(self) -> PacketWriter:
        return self

    def __exit__(self, *error: object) -> None:
        self.close()
