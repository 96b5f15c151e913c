"""Writing and reading of recordings of packets, which are JSON Lines as in protocol/recording.md.

Reading yields all packets before the first damage, then raises an error that says in one sentence what is damaged."""

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
"""Largest size of a line, bytes (protocol/recording.md)."""


def read_header(path: Path | str) -> dict[str, Any]:
    """Return the header of a recording, which is its first line; RecordingError when that line is no header."""
    path = Path(path)
    with open_file(path) as file:
        for number, _, line in _read_lines(file):
            try:
                fields = _parse_object(line)
                _check_header(fields)
            except _LineError as flaw:
                raise RecordingError(path, str(flaw), f"line {number}") from None
            return fields
    raise RecordingError(path, "is empty")


def read_start_time(header: Mapping[str, Any]) -> tuple[datetime, float | None] | None:
    """Return the start time (UTC) from a header, and the time `t` of the packets (s) at that moment.

    `t` is None if the start is the first packet's arrival. The result is None without a usable start time."""
    text, t = header.get("began"), header.get("began_t")
    if not isinstance(text, str) or type(t) not in (int, float, type(None)):
        return None
    try:
        moment = datetime.fromisoformat(text)
        t_start = None if t is None else float(t)
        if moment.tzinfo is None or (t_start is not None and not isfinite(t_start)):
            return None
        return moment.astimezone(UTC), t_start
    except (ValueError, OverflowError):
        return None


def read_packets(
    path: Path | str, *, report: Report = warn, progress: Callable[[int], None] | None = None
) -> Iterator[Packet]:
    """Return an iterator that reads the packets of a recording one by one, in the order in which they arrived.

    `report` receives one sentence about an incomplete last line. `progress` receives the number of bytes read so far,
    after each line. Any other violation of protocol/recording.md raises RecordingError after the packets before it."""
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
            except _NoObjectError as flaw:
                # a line that was cut off lacks its last brace, so it is never an object
                if header_seen and not line.endswith(b"\n") and len(line) <= LONGEST_LINE:
                    report(f"{printable(str(path))}: {where}: cut off in the middle; everything before it is used")
                    return
                hint = "" if header_seen else "; samples have names that end in .npz or .csv"
                raise RecordingError(path, f"{flaw}{hint}", where) from None
            except _LineError as flaw:
                raise RecordingError(path, str(flaw), where) from None
            yield packet
        if not header_seen:
            raise RecordingError(path, "is empty")


def _read_lines(file: BinaryIO) -> Iterator[tuple[int, int, bytes]]:
    """Yield each line that is not blank, with its number and the number of bytes read up to its end."""
    read = number = 0
    while line := file.readline(LONGEST_LINE + 1):
        number, read = number + 1, read + len(line)
        if line.strip():
            yield number, read, line


class _LineError(Exception):
    """Error that describes the flaw of one line."""


class _NoObjectError(_LineError):
    """Error for a line that is not a JSON object."""


def _parse_object(line: bytes) -> dict[str, Any]:
    if len(line) > LONGEST_LINE:
        raise _NoObjectError(f"is longer than {LONGEST_LINE} bytes, so this is not a recording of packets")
    try:
        value = json.loads(line.decode("utf-8"), parse_constant=_reject_constant)
    except UnicodeDecodeError:
        raise _NoObjectError("is not text, so this is not a recording of packets") from None
    except (ValueError, RecursionError):
        raise _NoObjectError("is not JSON") from None
    if not isinstance(value, dict):
        raise _NoObjectError(f"is not a JSON object but {_shorten(value)}")
    return value


def _reject_constant(name: str) -> None:
    raise _NoObjectError(f"{name} is not JSON")


def _check_header(header: dict[str, Any]) -> None:
    if header.get("format") != FORMAT:
        raise _LineError(f'is not the header of a recording: "format" is not "{FORMAT}"')
    version = header.get("version")
    if type(version) is not int or version != VERSION:
        raise _LineError(f"is of version {_shorten(version)}; this release reads version {VERSION}")


def _parse_packet(fields: dict[str, Any]) -> Packet:
    for key in ("t", "site", "channel", "data"):
        if key not in fields:
            raise _LineError(f'"{key}" is missing')
    t, site, channel, data = fields["t"], fields["site"], fields["channel"], fields["data"]
    if type(t) not in (int, float):
        raise _LineError(f'"t" is not a number but {_shorten(t)}')
    if not abs(t) <= float_info.max:
        raise _LineError('"t" is not a finite number')
    if not isinstance(site, str) or site not in _SITES:
        raise _LineError(f'"site" is not one of {", ".join(_SITES)} but {_shorten(site)}')
    if not isinstance(channel, str):
        raise _LineError(f'"channel" is not text but {_shorten(channel)}')
    if not isinstance(data, str) or len(data) % 2 or not _HEX.issuperset(data):
        raise _LineError(f'"data" is not pairs of hexadecimal digits but {_shorten(data)}')
    device = fields.get("device", "")
    if not isinstance(device, str):
        raise _LineError(f'"device" is not text but {_shorten(device)}')
    return Packet(t=float(t), site=_SITES[site], channel=channel, data=bytes.fromhex(data), device=device)


_SITES = {site.value: site for site in Site}
_HEX = frozenset("0123456789abcdefABCDEF")


def _shorten(value: Any) -> str:
    return printable(json.dumps(value), 40)


def _format_line(fields: dict[str, Any]) -> bytes:
    encoded = json.dumps(fields, allow_nan=False).encode("utf-8") + b"\n"
    if len(encoded) > LONGEST_LINE:
        raise ValueError(f"a line of {len(encoded)} bytes is too long for a recording")
    return encoded


class PacketWriter:
    """Writes packets as a recording, and passes each line to the operating system before `write` returns.

        with PacketWriter("walk.jsonl", {"began": "2026-11-21T09:30:00Z", "began_t": 12.5}) as writer:
            writer.write(packet)

    An existing file is replaced. `count`: number of packets in the file. If the process is killed, written packets are
    safe. RecordingError when the file cannot be opened or written, for example on a full disk. Then the file ends with
    its last complete packet, and writing may continue when there is space again. ValueError for a packet or header that
    a recording cannot hold (a time that is not finite, a line that is too long); the file is then unchanged."""

    def __init__(self, path: Path | str, header: Mapping[str, Any] = {}) -> None:
        """Open the file and write its header.

        `header`: further keys for the first line, for example `began` and `began_t` (protocol/recording.md), or the
        result of `read_header` for another recording. ValueError when it names another format or version."""
        self.count = 0
        self._path = Path(path)
        required_keys = {"format": FORMAT, "version": VERSION}
        try:
            _check_header({**required_keys, **header})
        except _LineError as flaw:
            raise ValueError(f"a header that {flaw}") from None
        header_line = _format_line({**required_keys, **header})
        self._size = 0
        """Size of the complete lines in the file, bytes."""
        self._torn = False
        """True when an incomplete line is in the file and could not be removed."""
        try:
            # unbuffered, so that a failed write is an error at once and `close` has no data to lose
            self._file: io.FileIO = self._path.open("wb", buffering=0)
        except OSError as error:
            raise RecordingError(self._path, os_error_text(error)) from error
        try:
            self._write_line(header_line)
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
        self._write_line(_format_line(line))
        self.count += 1

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
        """Close the file; RecordingError when the system reports only now that data could not be written."""
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
