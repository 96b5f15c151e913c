"""Files of lines in a directory, read byte for byte, each line once. It knows no engine: who reads keeps `read` among
its own state."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from fnmatch import fnmatch
from pathlib import Path
from typing import BinaryIO

from attrs import define

from .rows import LONGEST_LINE

_CUT = LONGEST_LINE + 2
"""Bytes that a line and its line feed cannot have."""


@define
class NamedFiles:
    """The files in `directory` whose names fit `pattern`, in the order of their names. `read`: bytes of each that were
    read by now, with the line that came last. Of one that is gone, or became shorter, nothing is known."""

    directory: Path
    pattern: str
    read: dict[str, int]

    def unread(self) -> Iterator[bytes]:
        """Every line that has its line feed by now, without it; empty ones are passed over. Of a line that is too long
        comes as much as `read_line` refuses. An OSError that names the file when one cannot be read."""
        sizes = self._sizes()
        self.read = {name: at for name, at in self.read.items() if at <= sizes.get(name, -1)}
        for name in sorted(sizes):
            at = self.read.get(name, 0)
            if at < sizes[name]:
                with (self.directory / name).open("rb") as file:
                    file.seek(at)
                    for line, length in _whole_lines(file):
                        self.read[name] = at = at + length
                        if line.strip():
                            yield line

    def waiting(self) -> Iterator[tuple[Path, int]]:
        """Files that hold something that was not read yet, and how many bytes."""
        for name, size in self._sizes().items():
            left = size - self.read.get(name, 0)
            if left > 0:
                yield self.directory / name, left

    def _sizes(self) -> dict[str, int]:
        found = {}
        for path in seen(self.directory):
            if fnmatch(path.name, self.pattern) and path.is_file():
                with suppress(FileNotFoundError):  # taken away this moment
                    found[path.name] = path.stat().st_size
        return found


def seen(directory: Path) -> list[Path]:
    """What is in it, without what is hidden, as a file on its way often is."""
    return sorted(path for path in directory.iterdir() if not path.name.startswith("."))


def _whole_lines(file: BinaryIO) -> Iterator[tuple[bytes, int]]:
    """Lines without their line feeds, cut where they are too long, and how many bytes of the file each takes."""
    while line := file.readline(_CUT):
        length, ended = len(line), line.endswith(b"\n")
        if length < _CUT and not ended:
            return
        while not ended and (more := file.readline(_CUT)):
            length, ended = length + len(more), more.endswith(b"\n")
        yield line.removesuffix(b"\n"), length
