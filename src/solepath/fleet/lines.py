"""What phones sent, from a directory of files of lines, for bytewax: as it lies there. Needs the extra `bytewax`.

    lines = operators.input("phones", flow, LineSource("sent"))          # of bytes
    sent = operators.map("read", lines, read_line)                       # of Sent and Unreadable

bytewax has sources of its own for files. They end the job at a byte that is no UTF-8, and read all files of a directory
at the same time, so that the hours of one wearer are mixed.
"""

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

from .files import NamedFiles, seen

_LOG = logging.getLogger(__name__)


@frozen
class LineSource(FixedPartitionedSource[bytes, dict[str, int]]):
    """The lines of the files in `directory` whose names fit `pattern`, as bytes, without empty ones.

    Files are read one after the other in the order of their names (so pad numbers with zeros). Every directory in
    `directory` is read so too, at the same time as the others: workers, who all see all of them, share the work by
    directories, and the files of one wearer lie in one of them. What is hidden (its name begins with a dot) is passed
    over.

    A line counts when its line feed is there: files may grow at their ends. How much of each was read goes into the
    recovery store, so what is new is read at the next start, or by the same job when it is to `follow`: then it does
    not end, and looks again so often. A new directory is seen at the next start. What was read to its end may be taken
    away. Of a line that is too long for `read_line` comes as much as it refuses.

    `batch`: lines that are read at a time. NotADirectoryError when there is no such directory; an OSError that names
    the file when one cannot be read. A job that ends says in a warning which files do not end with a line feed.
    """

    directory: Path = field(converter=Path)
    pattern: str = "*.jsonl"
    follow: timedelta | None = None
    batch: int = 1000

    def __attrs_post_init__(self) -> None:
        if not self.directory.is_dir():
            raise NotADirectoryError(ENOTDIR, strerror(ENOTDIR), str(self.directory))

    def list_parts(self) -> list[str]:
        return [".", *(path.name for path in seen(self.directory) if path.is_dir())]

    def build_part(self, step_id: str, for_part: str, resume_state: dict[str, int] | None) -> _Directory:
        return _Directory(self, NamedFiles(self.directory / for_part, self.pattern, dict(resume_state or {})))


@define
class _Directory(StatefulSourcePartition[bytes, dict[str, int]]):
    source: LineSource
    files: NamedFiles
    lines: Iterator[bytes] = field(init=False)
    awake: datetime | None = field(default=None, init=False)

    def __attrs_post_init__(self) -> None:
        self.lines = self.files.unread()

    def next_batch(self) -> list[bytes]:
        lines = list(islice(self.lines, self.source.batch))
        self.awake = None
        if not lines:
            if self.source.follow is None:
                for path, left in self.files.waiting():
                    _LOG.warning("%s: the last %d bytes wait for their line feed", path, left)
                raise StopIteration
            self.lines, self.awake = self.files.unread(), datetime.now(UTC) + self.source.follow
        return lines

    def next_awake(self) -> datetime | None:
        return self.awake

    def snapshot(self) -> dict[str, int]:
        return dict(self.files.read)
