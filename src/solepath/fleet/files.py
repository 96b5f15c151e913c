"""Reading of files of lines in a directory, each line once.

This module depends on no engine: the caller saves `positions` in its own state."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from fnmatch import fnmatch
from pathlib import Path
from typing import BinaryIO

from attrs import define

from .rows import MAX_LINE_LENGTH

_MAX_READ = MAX_LINE_LENGTH + 2
"""Largest number of bytes that are read at once: more than the longest valid line with its line feed."""


@define
class NamedFiles:
    """The files in `directory` whose names match `pattern`, in the order of their names.

    `positions` holds, by file name, the number of bytes that were read, up to the end of the last line. A file that is
    removed or became shorter loses its entry."""

    directory: Path
    pattern: str
    positions: dict[str, int]

    def read_new_lines(self) -> Iterator[bytes]:
        """Yield every new line that ends with a line feed, without the line feed; skip empty lines.

        A line that is too long is cut at a length that `read_line` rejects. Raises an OSError that names the file when
        one cannot be read."""
        sizes = self._sizes()
        self.positions = {name: read for name, read in self.positions.items() if read <= sizes.get(name, -1)}
        for name in sorted(sizes):
            position = self.positions.get(name, 0)
            if position < sizes[name]:
                with (self.directory / name).open("rb") as file:
                    file.seek(position)
                    for line, length in _read_whole_lines(file):
                        self.positions[name] = position = position + length
                        if line.strip():
                            yield line

    def unread_sizes(self) -> Iterator[tuple[Path, int]]:
        """Yield the path and the number of unread bytes of each file that has any."""
        for name, size in self._sizes().items():
            unread = size - self.positions.get(name, 0)
            if unread > 0:
                yield self.directory / name, unread

    def _sizes(self) -> dict[str, int]:
        sizes = {}
        for path in visible_paths(self.directory):
            if fnmatch(path.name, self.pattern) and path.is_file():
                with suppress(FileNotFoundError):  # removed in the meantime
                    sizes[path.name] = path.stat().st_size
        return sizes


def visible_paths(directory: Path) -> list[Path]:
    """Return the paths in a directory, without hidden ones, since files in transfer are often hidden."""
    return sorted(path for path in directory.iterdir() if not path.name.startswith("."))


def _read_whole_lines(file: BinaryIO) -> Iterator[tuple[bytes, int]]:
    """Yield each line without its line feed, cut if it is too long, with its uncut length in the file, bytes."""
    while line := file.readline(_MAX_READ):
        length, is_whole = len(line), line.endswith(b"\n")
        if length < _MAX_READ and not is_whole:
            return
        while not is_whole and (rest := file.readline(_MAX_READ)):
            length, is_whole = length + len(rest), rest.endswith(b"\n")
        yield line.removesuffix(b"\n"), length
