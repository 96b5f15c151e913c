"""Events as Parquet: a directory of numbered part files that DuckDB, pandas, Polars and Spark read as one table.

    SELECT wearer, count(*) FROM 'told/*.parquet' WHERE event = 'StrideTaken' GROUP BY wearer       -- DuckDB
    pandas.read_parquet("told")        spark.read.parquet("told")

Needs the extra `bytewax`, or pyarrow itself. It knows no engine: one writes through `PartFiles`, and keeps the number
of the next part among its own state.

A part is written under a name that readers pass over, brought to the disk, and renamed. After a crash the engine says
which part comes next, and those from it on are removed, since their events come again. So the files hold each event
once; a reader may see those of the last seconds before a crash go away with the restart and come back the same.

Every `close` makes a file. Where few walk, close seldom, or join the files of days gone by into another directory, in
DuckDB by `COPY (SELECT * FROM 'told/*.parquet' ORDER BY wearer, number) TO 'june.parquet'`.
"""

from __future__ import annotations

import logging
import os
import re
from collections.abc import Iterable, Sequence
from contextlib import suppress
from pathlib import Path
from time import time_ns
from typing import Any

import pyarrow as pa
from attrs import define, field
from pyarrow import parquet

from .rows import EVENT_COLUMNS, event_row
from .step.sent import NumberedEvent

_ARROW = {str: pa.string(), int: pa.int64(), float: pa.float64(), bool: pa.bool_()}
SCHEMA = pa.schema([(name, _ARROW[kind]) for name, kind in EVENT_COLUMNS.items()])
"""Columns of the files, in the order of EVENT_COLUMNS."""
REPEATED = ["wearer", "event", "foot", "final"]
"""Columns that are worth a dictionary."""
GROUP = 1 << 15
"""Events of a row group: as rows they take some 40 MB."""
GROUPS = 32
"""Row groups after which a part is closed in any case."""
_NAME = re.compile(
    r"\.?(?P<shown>part-(?P<partition>\w+)-(?P<run>\d+)-(?P<number>\d+)\.parquet)((?P<half>\.writing)|\.replaced)?"
)
_LOG = logging.getLogger(__name__)
_BEGUN = (
    "%s: a new run begins, and the parts of the one before are hidden (%d). Was that one to go on? "
    "Start the job with its recovery store, and they are back"
)
_TAKEN_UP = "%s: an earlier run goes on, and its parts are back (%d); those of another are hidden (%d)"


@define
class PartFiles:
    """The part files of one writer in `directory`, which is made when there is none.

    `partition`: letters and digits that tell this writer from others in the same directory, in whatever process.
    `resume`: the run and the number of the next part, as the last `close` that counts gave them; parts from there on
    are removed. None when nothing is remembered: then a new run begins, whose parts are numbered from 0. Parts of
    another run are hidden from readers then (renamed, `.part-0-1749718800000-00000007.parquet.replaced`), since the
    events of a fleet that begins anew are numbered anew, and a warning is logged. Whoever resumes that run has its
    parts back.

    `partitions`: all that the job has, in every process. The first hides the parts of others, which were written when
    the job had more; where nobody says, they are left. `group`: so many events are sorted by wearer and packed as one
    row group.

    OSError, naming the file, when one cannot be written (the disk is full). Nothing of it is left then, on the disk or
    here: begin again with the last number that counted. ValueError for a partition that is no word.
    """

    directory: Path
    partition: str = "0"
    resume: tuple[int, int] | None = None
    group: int = GROUP
    partitions: Sequence[str] = ()
    run: int = field(init=False)
    """In the names of its parts: the time in ms at which it began."""
    number: int = field(init=False)
    """Of the part that is open."""
    _rows: list[dict[str, Any]] = field(factory=list, init=False)
    _buffer: Any = field(default=None, init=False)
    _writer: Any = field(default=None, init=False)
    _groups: int = field(default=0, init=False)

    def __attrs_post_init__(self) -> None:
        if not re.fullmatch(r"\w+", self.partition):
            raise ValueError(f"partition must be letters and digits, not {self.partition!r}")
        self.directory.mkdir(parents=True, exist_ok=True)
        paths = sorted(self.directory.iterdir())
        names = [name for path in paths if (name := _NAME.fullmatch(path.name)) and path.is_file()]
        names = [name for name in names if self._is_to_see_to(name["partition"])]
        newest = max([int(name["run"]) for name in names], default=0)
        self.run, self.number = self.resume or (max(newest + 1, time_ns() // 1_000_000), 0)
        self._take_over(names)
        _settle(self.directory)

    def _is_to_see_to(self, partition: str) -> bool:
        is_first = self.partition == next(iter(self.partitions), None)
        return partition == self.partition or (is_first and partition not in self.partitions)

    def _take_over(self, names: list[re.Match[str]]) -> None:
        """Of all that is there, readers see the parts of this run that count."""
        back = aside = 0
        for name in names:
            path, shown = self.directory / name[0], self.directory / name["shown"]
            mine = int(name["run"]) == self.run and name["partition"] == self.partition
            if name["half"] or (mine and int(name["number"]) >= self.number):
                path.unlink()
            elif mine and path != shown:
                path.rename(shown)
                back += 1
            elif not mine and path == shown:
                path.rename(shown.with_name(f".{shown.name}.replaced"))
                aside += 1
        if aside and self.resume is None:
            _LOG.warning(_BEGUN, self.directory, aside)
        elif aside or back:
            _LOG.warning(_TAKEN_UP, self.directory, back, aside)

    def write(self, told: Iterable[NumberedEvent]) -> None:
        """Gather events for the part that is open."""
        for one in told:
            self._rows.append(event_row(one))
            if len(self._rows) >= self.group:
                self._flush()
                if self._groups >= GROUPS:
                    self.close()

    def close(self) -> tuple[int, int]:
        """Bring what was gathered to the disk as one part, if it is anything. The run and the number of the next part:
        what the engine remembers, together with the state of whoever told the events."""
        if self._rows:
            self._flush()
        if self._writer is not None:
            self._writer.close()
            data, self._writer, self._groups = self._buffer.getvalue(), None, 0
            self._publish(data, self.directory / f"part-{self.partition}-{self.run}-{self.number:08d}.parquet")
            self.number += 1
        return self.run, self.number

    def _flush(self) -> None:
        """A row group of what was gathered, sorted: a wearer's events stand together, and compress so."""
        if self._writer is None:
            self._buffer = pa.BufferOutputStream()
            self._writer = parquet.ParquetWriter(self._buffer, SCHEMA, compression="zstd", use_dictionary=REPEATED)
        table = pa.Table.from_pylist(self._rows, SCHEMA)
        self._rows = []
        self._writer.write_table(table.sort_by([("wearer", "ascending"), ("number", "ascending")]))
        self._groups += 1

    def _publish(self, data: Any, path: Path) -> None:
        beside = path.with_name(f".{path.name}.writing")
        try:
            with beside.open("wb") as file:
                file.write(data)
                file.flush()
                os.fsync(file.fileno())
            beside.replace(path)
            _settle(self.directory)
        except OSError as error:
            with suppress(OSError):
                beside.unlink(missing_ok=True)
            raise OSError(error.errno, error.strerror, str(path)) from None


def _settle(directory: Path) -> None:
    """A name is on the disk only when its directory is; Windows has no way to say so and needs none."""
    if hasattr(os, "O_DIRECTORY"):
        at = os.open(directory, os.O_RDONLY | os.O_DIRECTORY)
        try:
            os.fsync(at)
        finally:
            os.close(at)
