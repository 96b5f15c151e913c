"""Events as Parquet: a directory of numbered part files that DuckDB, pandas, Polars and Spark read as one table.

    SELECT wearer, count(*) FROM 'events/*.parquet' WHERE event = 'StrideTaken' GROUP BY wearer       -- DuckDB
    pandas.read_parquet("events")        spark.read.parquet("events")

Needs the extra `bytewax`, or pyarrow itself. This module knows no engine: its user writes through `PartFiles`, and
keeps the number of the next part in a state of its own.

A part is written under a name that readers skip, flushed to the disk, and renamed. After a crash the engine says which
part comes next; that part and all later ones are removed, since their events come again. So the files hold each event
once; a reader may see the events of the last seconds before a crash disappear at the restart and come back unchanged.

Every `close` makes a file. With few wearers, close seldom, or join the files of past days in another directory, in
DuckDB by `COPY (SELECT * FROM 'events/*.parquet' ORDER BY wearer, number) TO 'june.parquet'`."""

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
"""Columns that repeat their values, for which a dictionary saves space."""
GROUP = 1 << 15
"""Number of events in a row group: as rows they take about 40 MB."""
GROUPS = 32
"""Number of row groups after which a part is closed in any case."""
_NAME = re.compile(
    r"\.?(?P<shown>part-(?P<partition>\w+)-(?P<run>\d+)-(?P<number>\d+)\.parquet)((?P<half>\.writing)|\.replaced)?"
)
_LOG = logging.getLogger(__name__)
_NEW_RUN = (
    "%s: a new run begins, and the parts of the one before are hidden (%d). Was that one to go on? "
    "Start the job with its recovery store, and they are back"
)
_RESUMED_RUN = "%s: an earlier run goes on, and its parts are back (%d); those of another are hidden (%d)"


@define
class PartFiles:
    """The part files of one writer in `directory`, which is created when missing.

    `partition`, letters and digits, distinguishes this writer from others in the same directory, in any process.
    `resume` is the run and the number of the next part, as the last `close` that counts returned them; parts from there
    on are removed. None, when nothing is remembered, starts a new run with parts numbered from 0. Parts of another run
    are then hidden from readers (renamed, `.part-0-1749718800000-00000007.parquet.replaced`), since the events of a
    fleet that starts again are numbered again, and a warning is logged. Resuming that run restores its parts.

    `partitions` are all partitions of the job, in every process. The first one hides the parts of other partitions,
    which were written when the job had more; if `partitions` is empty, they stay. `group` is the number of events that
    are sorted by wearer and packed as one row group.

    Raises OSError, naming the file, when one cannot be written (the disk is full). Nothing of it is then left on the
    disk or here: start again with the last number that counted. Raises ValueError for a partition that is no word."""

    directory: Path
    partition: str = "0"
    resume: tuple[int, int] | None = None
    group: int = GROUP
    partitions: Sequence[str] = ()
    run: int = field(init=False)
    """Time at which the run started, ms; part of the names of its parts."""
    number: int = field(init=False)
    """Number of the open part."""
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
        names = [name for name in names if self._is_managed(name["partition"])]
        newest = max([int(name["run"]) for name in names], default=0)
        self.run, self.number = self.resume or (max(newest + 1, time_ns() // 1_000_000), 0)
        self._hide_and_restore(names)
        _sync_directory(self.directory)

    def _is_managed(self, partition: str) -> bool:
        is_first = self.partition == next(iter(self.partitions), None)
        return partition == self.partition or (is_first and partition not in self.partitions)

    def _hide_and_restore(self, names: list[re.Match[str]]) -> None:
        """Leave visible to readers the parts of this run that count, and no others."""
        restored = hidden = 0
        for name in names:
            path, shown = self.directory / name[0], self.directory / name["shown"]
            mine = int(name["run"]) == self.run and name["partition"] == self.partition
            if name["half"] or (mine and int(name["number"]) >= self.number):
                path.unlink()
            elif mine and path != shown:
                path.rename(shown)
                restored += 1
            elif not mine and path == shown:
                path.rename(shown.with_name(f".{shown.name}.replaced"))
                hidden += 1
        if hidden and self.resume is None:
            _LOG.warning(_NEW_RUN, self.directory, hidden)
        elif hidden or restored:
            _LOG.warning(_RESUMED_RUN, self.directory, restored, hidden)

    def write(self, events: Iterable[NumberedEvent]) -> None:
        """Add events to the open part."""
        for one in events:
            self._rows.append(event_row(one))
            if len(self._rows) >= self.group:
                self._flush()
                if self._groups >= GROUPS:
                    self.close()

    def close(self) -> tuple[int, int]:
        """Write the collected events, if any, to the disk as one part; return the run and the next part's number.

        The engine remembers these two numbers together with the state of the source of the events."""
        if self._rows:
            self._flush()
        if self._writer is not None:
            self._writer.close()
            data, self._writer, self._groups = self._buffer.getvalue(), None, 0
            self._publish(data, self.directory / f"part-{self.partition}-{self.run}-{self.number:08d}.parquet")
            self.number += 1
        return self.run, self.number

    def _flush(self) -> None:
        """Write a sorted row group of the collected events: a wearer's events are adjacent and compress better."""
        if self._writer is None:
            self._buffer = pa.BufferOutputStream()
            self._writer = parquet.ParquetWriter(self._buffer, SCHEMA, compression="zstd", use_dictionary=REPEATED)
        table = pa.Table.from_pylist(self._rows, SCHEMA)
        self._rows = []
        self._writer.write_table(table.sort_by([("wearer", "ascending"), ("number", "ascending")]))
        self._groups += 1

    def _publish(self, data: Any, path: Path) -> None:
        temporary = path.with_name(f".{path.name}.writing")
        try:
            with temporary.open("wb") as file:
                file.write(data)
                file.flush()
                os.fsync(file.fileno())
            temporary.replace(path)
            _sync_directory(self.directory)
        except OSError as error:
            with suppress(OSError):
                temporary.unlink(missing_ok=True)
            raise OSError(error.errno, error.strerror, str(path)) from None


def _sync_directory(directory: Path) -> None:
    """Flush the directory: a file name is on the disk only then; Windows has no such call and needs none."""
    if hasattr(os, "O_DIRECTORY"):
        at = os.open(directory, os.O_RDONLY | os.O_DIRECTORY)
        try:
            os.fsync(at)
        finally:
            os.close(at)
