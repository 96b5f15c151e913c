"""Files of lines in a directory, read byte for byte, each line once.

This module knows no engine: its user keeps `read` in a state of its own."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from fnmatch import fnmatch
from pathlib import Path
from typing import BinaryIO

from attrs import define

from .rows import LONGEST_LINE

_CUT = LONGEST_LINE + 2
"""Length that no line with its line feed reaches, bytes."""


@define
class NamedFiles:
    """The files in `directory` whose names match `pattern`, in the order of their names.

    `read` holds the number of bytes of each file that were read, up to and with the last line. A file that is removed,
    or became shorter, loses its entry."""

    directory: Path
    pattern: str
    read: dict[str, int]

    def read_new_lines(self) -> Iterator[bytes]:
        """Yield every line that has its line feed by now, without it; skip empty ones.

        Of a line that is too long only as much is yielded as makes `read_line` reject it. Raises an OSError that names
        the file when one cannot be read."""
        sizes = self._sizes()
        self.read = {name: at for name, at in self.read.items() if at <= sizes.get(name, -1)}
        for name in sorted(sizes):
            at = self.read.get(name, 0)
            if at < sizes[name]:
                with (self.directory / name).open("rb") as file:
                    file.seek(at)
                    for line, length in _read_whole_lines(file):
                        self.read[name] = at = at + length
                        if line.strip():
                            yield line

    def unread_sizes(self) -> Iterator[tuple[Path, int]]:
        """Yield the files that hold unread bytes, and how many."""
        for name, size in self._sizes().items():
            left = size - self.read.get(name, 0)
            if left > 0:
                yield self.directory / name, left

    def _sizes(self) -> dict[str, int]:
        found = {}
        for path in visible_paths(self.directory):
            if fnmatch(path.name, self.pattern) and path.is_file():
                with suppress(FileNotFoundError):  # removed in the meantime
                    found[path.name] = path.stat().st_size
        return found


def visible_paths(directory: Path) -> list[Path]:
    """Return the paths in a directory, without hidden ones, as files being transferred often are."""
    return sorted(path for path in directory.iterdir() if not path.name.startswith("."))


def _read_whole_lines(file: BinaryIO) -> Iterator[tuple[bytes, int]]:
    """Yield lines without line feeds, cut where they are too long, with the bytes that each takes in the file."""
    while line := file.readline(_CUT):
        length, ended = len(line), line.endswith(b"\n")
        if length < _CUT and not ended:
            return
        while not ended and (more := file.readline(_CUT)):
            length, ended = length + len(more), more.endswith(b"\n")
        yield line.removesuffix(b"\n"), length
