"""Recordings of packets: JSON Lines as protocol/recording.md says, written line by line and read back.

Reading delivers everything that comes before a damage, then says in one sentence what is wrong and where.
Samples as .npz or .csv are the subject of samples.py.
"""

from __future__ import annotations

import json
import warnings
from collections.abc import Callable, Iterator
from math import isfinite
from pathlib import Path
from types import TracebackType
from typing import Any, BinaryIO

from .types import Packet, Site

__all__ = ["FORMAT", "VERSION", "PacketWriter", "RecordingError", "RecordingWarning", "read_packets"]

FORMAT = "solepath-packets"
VERSION = 1
LONGEST_LINE = 65_536
"""protocol/recording.md: "No line is longer than 65,536 bytes"."""


class RecordingError(Exception):
    """A recording cannot be used, or not beyond a place: one sentence naming the file, the place and what is wrong."""

    def __init__(self, path: Path | str, what: str, where: str = "") -> None:
        self.path, self.where, self.what = Path(path), where, what
        super().__init__(": ".join([printable(str(path))] + [part for part in (where, what) if part]))


class RecordingWarning(UserWarning):
    """A recording has a flaw that costs nothing but what is missing (a torn last line)."""


Report = Callable[[str], None]
"""Takes one sentence about a flaw that does not stop the reading."""


def warn(sentence: str) -> None:
    """The report of those who give none: a RecordingWarning."""
    warnings.warn(sentence, RecordingWarning, stacklevel=3)


def printable(text: str, longest: int = 200) -> str:
    """`text` on one line and without control codes, whatever a file or its name holds."""
    clean = "".join(c if c.isprintable() else "\N{REPLACEMENT CHARACTER}" for c in text)
    return clean if len(clean) <= longest else clean[: longest - 3] + "..."


def open_file(path: Path) -> BinaryIO:
    """The file opened for reading bytes; RecordingError when there is none, it is a directory or may not be read."""
    try:
        if path.is_dir():
            raise RecordingError(path, "is a directory, not a recording")
        return path.open("rb")
    except OSError as error:
        raise RecordingError(path, (error.strerror or str(error)).lower()) from error


def read_packets(
    path: Path | str, *, report: Report = warn, progress: Callable[[int], None] | None = None
) -> Iterator[Packet]:
    """The packets of a recording in the order in which they arrived, read as they are asked for.

    `report` gets one sentence about a torn last line. `progress` gets the number of bytes read so far, after every
    line. RecordingError, after the packets before the damage, for anything else that protocol/recording.md refuses.
    """
    path = Path(path)
    with open_file(path) as file:
        read = number = 0
        header_seen = False
        while line := file.readline(LONGEST_LINE + 1):
            number += 1
            where = f"line {number}"
            read += len(line)
            if progress is not None:
                progress(read)
            if not line.strip():
                continue
            try:
                fields = _object(line)
                if not header_seen:
                    _check_header(fields)
                    header_seen = True
                    continue
                packet = _packet(fields)
            except _NotAnObject as flaw:
                # an object ends with its brace, so a line that was cut is never an object
                if header_seen and not line.endswith(b"\n") and len(line) <= LONGEST_LINE:
                    report(f"{printable(str(path))}: {where}: cut off in the middle; everything before it is used")
                    return
                hint = "" if header_seen else "; samples have names that end in .npz or .csv"
                raise RecordingError(path, f"{flaw}{hint}", where) from None
            except _Flaw as flaw:
                raise RecordingError(path, str(flaw), where) from None
            yield packet
        if not header_seen:
            raise RecordingError(path, "is empty")


class _Flaw(Exception):
    """What is wrong with one line."""


class _NotAnObject(_Flaw):
    """The line is not a JSON object at all."""


def _object(line: bytes) -> dict[str, Any]:
    if len(line) > LONGEST_LINE:
        raise _NotAnObject(f"is longer than {LONGEST_LINE} bytes, so this is not a recording of packets")
    try:
        value = json.loads(line.decode("utf-8"), parse_constant=_refuse_constant)
    except UnicodeDecodeError:
        raise _NotAnObject("is not text, so this is not a recording of packets") from None
    except (ValueError, RecursionError):
        raise _NotAnObject("is not JSON") from None
    if not isinstance(value, dict):
        raise _NotAnObject(f"is not a JSON object but {_short(value)}")
    return value


def _refuse_constant(name: str) -> None:
    raise _NotAnObject(f"{name} is not JSON")


def _check_header(header: dict[str, Any]) -> None:
    if header.get("format") != FORMAT:
        raise _Flaw(f'is not the header of a recording: "format" is not "{FORMAT}"')
    version = header.get("version")
    if type(version) is not int or version != VERSION:
        raise _Flaw(f"is of version {_short(version)}; this release reads version {VERSION}")


def _packet(fields: dict[str, Any]) -> Packet:
    for key in ("t", "site", "channel", "data"):
        if key not in fields:
            raise _Flaw(f'"{key}" is missing')
    t, site, channel, data = fields["t"], fields["site"], fields["channel"], fields["data"]
    if type(t) not in (int, float):
        raise _Flaw(f'"t" is not a number but {_short(t)}')
    try:
        t = float(t)
    except OverflowError:
        raise _Flaw('"t" is not a finite number') from None
    if not isfinite(t):
        raise _Flaw('"t" is not a finite number')
    if not isinstance(site, str) or site not in _SITES:
        raise _Flaw(f'"site" is not one of {", ".join(_SITES)} but {_short(site)}')
    if not isinstance(channel, str):
        raise _Flaw(f'"channel" is not text but {_short(channel)}')
    if not isinstance(data, str) or len(data) % 2 or not _HEX.issuperset(data):
        raise _Flaw(f'"data" is not pairs of hexadecimal digits but {_short(data)}')
    return Packet(t=t, site=_SITES[site], channel=channel, data=bytes.fromhex(data))


_SITES = {site.value: site for site in Site}
_HEX = frozenset("0123456789abcdefABCDEF")


def _short(value: Any) -> str:
    return printable(json.dumps(value), 40)


class PacketWriter:
    """Writes packets as a recording, every line flushed before the next packet is taken.

        with PacketWriter("walk.jsonl") as writer:
            writer.write(packet)

    An existing file is replaced. `OSError` when it cannot be written; `ValueError` for a packet that no recording can
    hold (a time that is not finite, a line that would be too long).
    """

    def __init__(self, path: Path | str, **header: Any) -> None:
        """`header`: further keys for the first line, for instance a note."""
        first = json.dumps({"format": FORMAT, "version": VERSION, **header}, allow_nan=False)
        self._file = Path(path).open("wb")  # noqa: SIM115 - this class is the context manager
        self._put(first)

    def write(self, packet: Packet) -> None:
        if not isfinite(packet.t):
            raise ValueError(f"a packet at {packet.t} s cannot be recorded")
        line = {"t": packet.t, "site": packet.site.value, "channel": packet.channel, "data": packet.data.hex()}
        self._put(json.dumps(line, allow_nan=False))

    def _put(self, line: str) -> None:
        encoded = line.encode("utf-8") + b"\n"
        if len(encoded) > LONGEST_LINE:
            raise ValueError(f"a line of {len(encoded)} bytes is too long for a recording")
        self._file.write(encoded)
        self._file.flush()

    def close(self) -> None:
        self._file.close()

    def __enter__(self) -> PacketWriter:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()
