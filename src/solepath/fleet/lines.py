"""A bytewax source of phones' rows from a directory of files of lines, unchanged. Needs the extra `bytewax`.

    lines = operators.input("phones", flow, LineSource("sent"))         # of bytes
    keyed = operators.flat_map_batch("read", lines, read_lines)         # of lists of Sent and Unreadable, by wearer

bytewax's own file sources end the job at a byte that is not UTF-8. They read all files of a directory at the same time,
which mixes the rows of one wearer."""

from __future__ import annotations

import logging
from collections.abc import Iterator
from datetime import UTC, datetime, timedelta
from errno import ENOTDIR
from itertools import islice
from os import strerror
from pathlib import Path

from attrs import define, field, frozen
from bytewax.inputs import FixedPartitionedSource, StatefulSourcePartition

from .files import NamedFiles, visible_paths

_LOG = logging.getLogger(__name__)


@frozen
class LineSource(FixedPartitionedSource[bytes, dict[str, int]]):
    """A source of the lines of the files in `directory` whose names match `pattern`, as bytes, without empty ones.

    Files are read one after the other in the order of their names (so pad numbers with zeros). The directories in
    `directory` are read in the same way and in parallel: the workers, who must see all directories, divide them among
    themselves. The files of one wearer must be in one directory. Hidden entries (with a name that starts with a dot)
    are skipped.

    A line is read after its line feed has been written; files may grow at their ends. The recovery store holds the
    position in each file, so the next start reads new lines. With `follow` the job does not end but checks for new
    lines after that time. A new directory is noticed at the next start. A file that was read to its end may be removed.
    A line that is too long is cut at a length that `read_line` rejects.

    `batch` is the largest number of lines read at a time. Raises NotADirectoryError without the directory, and an
    OSError that names the file when one cannot be read. A job that ends logs a warning for each file that does not end
    with a line feed."""

    directory: Path = field(converter=Path)
    pattern: str = "*.jsonl"
    follow: timedelta | None = None
    batch: int = 1000

    def __attrs_post_init__(self) -> None:
        if not self.directory.is_dir():
            raise NotADirectoryError(ENOTDIR, strerror(ENOTDIR), str(self.directory))

    def list_parts(self) -> list[str]:
        return [".", *(path.name for path in visible_paths(self.directory) if path.is_dir())]

    def build_part(self, step_id: str, for_part: str, resume_state: dict[str, int] | None) -> _Directory:
        return _Directory(self, NamedFiles(self.directory / for_part, self.pattern, dict(resume_state or {})))


@define
class _Directory(StatefulSourcePartition[bytes, dict[str, int]]):
    source: LineSource
    files: NamedFiles
    lines: Iterator[bytes] = field(init=False)
    awake: datetime | None = field(default=None, init=False)

    def __attrs_post_init__(self) -> None:
        self.lines = self.files.read_new_lines()

    def next_batch(self) -> list[bytes]:
        lines = list(islice(self.lines, self.source.batch))
        self.awake = None
        if not lines:
            if self.source.follow is None:
                for path, left in self.files.unread_sizes():
                    _LOG.warning("%s: the last %d bytes wait for their line feed", path, left)
                raise StopIteration
            self.lines, self.awake = self.files.read_new_lines(), datetime.now(UTC) + self.source.follow
        return lines

    def next_awake(self) -> datetime | None:
        return self.awake

    def snapshot(self) -> dict[str, int]:
        return dict(self.files.positions)
