"""Writing of events as numbered Parquet files, which DuckDB, pandas, Polars and Spark read as one table.

    SELECT wearer, count(*) FROM 'events/*.parquet' WHERE event = 'StrideTaken' GROUP BY wearer       -- DuckDB
    pandas.read_parquet("events")        spark.read.parquet("events")

Needs the extra `bytewax`, or pyarrow itself. This module depends on no engine: the caller writes through `PartFiles`
and saves the number of the next part file in its own state.

A part file ("part") is written under a name that readers skip, flushed to the disk, and renamed. After a crash the
engine restores the number of the next part. That part and all later parts are removed, since their events are emitted
again. So the files hold each event once. At the restart a reader may see the events of the last seconds before the
crash disappear and return unchanged.

Every `close` makes a file. With few wearers, call `close` seldom, or join the files of past days in another directory,
in DuckDB by `COPY (SELECT * FROM 'events/*.parquet' ORDER BY wearer, number) TO 'june.parquet'`."""

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
DICTIONARY_COLUMNS = ["wearer", "event", "foot", "final"]
"""Columns with few different values, which Parquet stores in less space with a dictionary."""
EVENTS_PER_GROUP = 1 << 15
"""Number of events in a row group; as Python rows they take about 40 MB of memory."""
MAX_GROUPS = 32
"""Largest number of row groups in a part; then it is closed without a call of `close`."""
_NAME = re.compile(
    r"\.?(?P<visible>part-(?P<partition>\w+)-(?P<run>\d+)-(?P<number>\d+)\.parquet)((?P<unfinished>\.writing)|\.replaced)?"
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
    `resume` is the run and the number of the next part, as `close` returned them at the engine's last snapshot; this
    part and later ones are removed. None starts a new run with parts numbered from 0. Parts of another run are then
    hidden from readers (renamed to `.part-0-1749718800000-00000007.parquet.replaced`) and a warning is logged, since a
    new run uses the same event numbers again. Resuming the other run makes its parts visible again.

    `partitions` are all partitions of the job, in every process. The writer of the first partition also hides the parts
    of partitions that are not in this list, from a time when the job had more; if the list is empty, they stay. `group`
    is the number of events that are sorted by wearer and packed as one row group.

    Raises an OSError that names the file when one cannot be written (the disk is full); its data are then discarded, so
    start again from the engine's last snapshot. Raises ValueError for a partition with other characters."""

    directory: Path
    partition: str = "0"
    resume: tuple[int, int] | None = None
    group: int = EVENTS_PER_GROUP
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
        """Make the valid parts of this run visible to readers, hide those of other runs, and remove all other files."""
        restored = hidden = 0
        for name in names:
            path, visible = self.directory / name[0], self.directory / name["visible"]
            is_own = int(name["run"]) == self.run and name["partition"] == self.partition
            if name["unfinished"] or (is_own and int(name["number"]) >= self.number):
                path.unlink()
            elif is_own and path != visible:
                path.rename(visible)
                restored += 1
            elif not is_own and path == visible:
                path.rename(visible.with_name(f".{visible.name}.replaced"))
                hidden += 1
        if hidden and self.resume is None:
            _LOG.warning(_NEW_RUN, self.directory, hidden)
        elif hidden or restored:
            _LOG.warning(_RESUMED_RUN, self.directory, restored, hidden)

    def write(self, events: Iterable[NumberedEvent]) -> None:
        """Add events to the open part."""
        for event in events:
            self._rows.append(event_row(event))
            if len(self._rows) >= self.group:
                self._flush()
                if self._groups >= MAX_GROUPS:
                    self.close()

    def close(self) -> tuple[int, int]:
        """Write the collected events, if any, to the disk as one part; return the run and the next part's number.

        The engine must save these two numbers together with the position of its source."""
        if self._rows:
            self._flush()
        if self._writer is not None:
            self._writer.close()
            data, self._writer, self._groups = self._buffer.getvalue(), None, 0
            self._publish(data, self.directory / f"part-{self.partition}-{self.run}-{self.number:08d}.parquet")
            self.number += 1
        return self.run, self.number

    def _flush(self) -> None:
        """Write the collected events as a row group, sorted by wearer, since they then compress better."""
        if self._writer is None:
            self._buffer = pa.BufferOutputStream()
            self._writer = parquet.ParquetWriter(
                self._buffer, SCHEMA, compression="zstd", use_dictionary=DICTIONARY_COLUMNS
            )
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
    """Flush the directory, so that new file names are on the disk; Windows has no such call and needs none."""
    if hasattr(os, "O_DIRECTORY"):
        descriptor = os.open(directory, os.O_RDONLY | os.O_DIRECTORY)
        try:
            os.fsync(descriptor)
        finally:
            os.close(descriptor)
