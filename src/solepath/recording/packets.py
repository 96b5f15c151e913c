"""Reading of recordings of packets, which are JSON Lines as in protocol/recording.md.

A line that is damaged costs one packet: it is reported and left out. A file with more damaged lines than whole ones is
no recording."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterator, Mapping
from datetime import UTC, datetime
from math import isfinite
from pathlib import Path
from sys import float_info
from typing import Any, BinaryIO

from attrs import frozen

from ..types import Packet, Site
from .bad_rows import LONGEST_LINE, BadRows, Line, read_lines
from .errors import RecordingError, Report, printable, warn
from .unpacking import open_unpacked

FORMAT = "solepath-packets"
"""Value of the key "format" in the header."""
VERSION = 1
"""Version of the format that this release reads and writes."""
SAMPLES_HINT = "samples have names that end in .npz, .csv, .tsv, .txt, .xlsx or .parquet"


def read_header(path: Path | str) -> dict[str, Any]:
    """Return the header of a recording, which is its first line; RecordingError when that line is no header."""
    path = Path(path)
    with open_unpacked(path) as file:
        return _parse_header(path, file)[0]


def read_start_time(header: Mapping[str, Any]) -> tuple[datetime, float | None] | None:
    """Return the start time (UTC) from a header, and the time `t` of the packets (s) at that moment.

    `t` is None if the start is the first packet's arrival. The result is None without a usable start time."""
    t = header.get("began_t")
    try:
        moment = datetime.fromisoformat(header["began"])
        if moment.tzinfo is None or type(t) not in (int, float, type(None)) or not isfinite(t or 0.0):
            return None
        return moment.astimezone(UTC), None if t is None else float(t)
    except (KeyError, TypeError, ValueError, OverflowError):
        return None


def read_packets(
    path: Path | str, *, report: Report = warn, progress: Callable[[int], None] | None = None
) -> Iterator[Packet]:
    """Return an iterator that reads the packets of a recording one by one, in the order in which they arrived.

    `report` receives one sentence about an incomplete last line, and about each of the first damaged lines, which are
    left out. `progress` receives the number of bytes read so far, after each line. RecordingError for a file that
    cannot be read or has no valid header, and after the last packet if more lines are damaged than whole."""
    yield from open_packets(path, report=report, progress=progress).packets


@frozen(eq=False)
class OpenRecording:
    """A recording that was opened once, as a pipe can be: its header, and an iterator over its packets.

    `bad_lines` counts the lines that the iterator has left out. The file is closed after the last packet."""

    header: dict[str, Any]
    packets: Iterator[Packet]
    bad_lines: BadRows


def open_packets(
    path: Path | str, *, report: Report = warn, progress: Callable[[int], None] | None = None
) -> OpenRecording:
    """Open a recording and read its header; the arguments and errors are those of `read_packets`."""
    path = Path(path)
    file = open_unpacked(path)
    try:
        header, lines = _parse_header(path, file)
    except BaseException:
        file.close()
        raise
    bad_lines = BadRows(path, report)
    return OpenRecording(header, _parse_packets(path, file, lines, bad_lines, progress), bad_lines)


def _parse_header(path: Path, file: BinaryIO) -> tuple[dict[str, Any], Iterator[Line[bytes]]]:
    """Return the header of a recording, and an iterator over the lines below it."""
    start, lines = file.peek(), read_lines(file, b"\n")  # type: ignore[attr-defined]
    for line in lines:
        try:
            fields = _parse_object(line)
            fault = header_fault(fields)
        except _NoObjectError as flaw:
            fault = _explain_start(start) or f"{flaw}; {SAMPLES_HINT}"
        if fault is not None:
            raise RecordingError(path, fault, f"line {line.number}")
        return fields, lines
    raise RecordingError(path, "is empty")


def _explain_start(start: bytes) -> str:
    """Return what a file is that starts with these bytes; "" for none that is known."""
    from .captures import is_capture  # packets do not need it

    if is_capture(start):
        return (
            "is a Bluetooth capture: if it is of HCI, `solepath convert` makes a recording of it (a file, not a pipe)"
        )
    is_wide = start[:2] in (b"\xff\xfe", b"\xfe\xff") or start[:2].count(0) == 1
    return "is text in UTF-16; a recording is in UTF-8: save it so" if is_wide else ""


def _parse_packets(
    path: Path, file: BinaryIO, lines: Iterator[Line[bytes]], bad_lines: BadRows, progress: Callable[[int], None] | None
) -> Iterator[Packet]:
    with file:
        for line in lines:
            if progress is not None:
                progress(line.end)
            where = f"line {line.number}"
            try:
                packet = _parse_packet(_parse_object(line))
            except _LineError as flaw:
                # a line that was cut off lacks its last brace, so it is never an object
                if isinstance(flaw, _NoObjectError) and line.is_cut:
                    text = f"{where}: cut off in the middle; everything before it is used"
                    bad_lines.report(f"{printable(str(path))}: {text}")
                    break
                bad_lines.add(where, str(flaw))
            else:
                bad_lines.add_good()
                yield packet
        bad_lines.finish()


class _LineError(Exception):
    """Error that describes the flaw of one line."""


class _NoObjectError(_LineError):
    """Error for a line that is not a JSON object."""


def _parse_object(line: Line[bytes]) -> dict[str, Any]:
    if line.is_too_long:
        raise _NoObjectError(f"is longer than {LONGEST_LINE} bytes")
    try:
        value = json.loads(line.data.decode("utf-8-sig"), parse_constant=_reject_constant)
    except UnicodeDecodeError:
        raise _NoObjectError("is not text") from None
    except (ValueError, RecursionError):
        raise _NoObjectError("is not JSON") from None
    if not isinstance(value, dict):
        raise _NoObjectError(f"is not a JSON object but {_shorten(value)}")
    return value


def _reject_constant(name: str) -> None:
    raise _NoObjectError(f"{name} is not JSON")


def header_fault(header: Mapping[str, Any]) -> str | None:
    """Return what is wrong with the header of a recording; None for a valid one."""
    if header.get("format") != FORMAT:
        return f'is not the header of a recording: "format" is not "{FORMAT}"'
    version = header.get("version")
    if type(version) is not int or version != VERSION:
        return f"is of version {_shorten(version)}; this release reads version {VERSION}"
    return None


_SITES = {site.value: site for site in Site}
_PAIRS = re.compile("(?:[0-9a-fA-F]{2})*")
_RULES: tuple[tuple[str, Callable[[Any], bool], str], ...] = (
    ("t", lambda value: type(value) in (int, float), "a number"),
    ("site", lambda value: isinstance(value, str) and value in _SITES, f"one of {', '.join(_SITES)}"),
    ("channel", lambda value: isinstance(value, str), "text"),
    ("data", lambda value: isinstance(value, str) and bool(_PAIRS.fullmatch(value)), "pairs of hexadecimal digits"),
    ("device", lambda value: isinstance(value, str), "text"),
)
"""What each key of a packet's line holds."""


def _parse_packet(fields: dict[str, Any]) -> Packet:
    packet = {"device": ""} | fields
    for key, fits, what in _RULES:
        if key not in packet:
            raise _LineError(f'"{key}" is missing')
        if not fits(packet[key]):
            raise _LineError(f'"{key}" is not {what} but {_shorten(packet[key])}')
        if key == "t" and not abs(packet[key]) <= float_info.max:
            raise _LineError('"t" is not a finite number')
    t, site, channel, data, device = (packet[key] for key, _, _ in _RULES)
    return Packet(t=float(t), site=_SITES[site], channel=channel, data=bytes.fromhex(data), device=device)


def _shorten(value: Any) -> str:
    return printable(json.dumps(value), 40)
