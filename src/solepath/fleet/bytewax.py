"""A fleet on bytewax: an operator for any dataflow, and a sink for its events. Needs the extra `bytewax`.

    lines = operators.input("phones", flow, LineSource("sent"))         # of bytes, any source
    keyed = operators.flat_map_batch("read", lines, read_lines)         # of lists of rows, keyed by wearer
    events = gait("gait", keyed, Fleet(recipe))                         # of NumberedEvent, keyed by wearer
    operators.output("files", events, ParquetSink("events"))

A job that is killed at any moment and started again with its recovery store continues at the last snapshot. Source,
wearers and sink go back to the same snapshot, so the files hold each event once if the source can go back."""

from __future__ import annotations

import sqlite3
from collections.abc import Iterable
from contextlib import closing
from datetime import UTC, datetime, timedelta
from itertools import chain
from pathlib import Path
from typing import Any

from attrs import define, field, frozen
from bytewax import operators
from bytewax.dataflow import operator
from bytewax.operators import KeyedStream, StatefulBatchLogic
from bytewax.outputs import FixedPartitionedSink, StatefulSinkPartition

from .fleet import Fleet
from .parquet import PartFiles
from .step.keyed import Keyed
from .step.sent import NumberedEvent


@operator
def gait(
    step_id: str, up: KeyedStream[Any], fleet: Fleet, idle: timedelta | None = None, forget: timedelta | None = None
) -> KeyedStream[NumberedEvent]:
    """Return the events of a fleet's sessions, wearer by wearer, for the rows that phones sent.

    `up` is keyed by the wearer's name and holds Sent and Unreadable, one at a time or in lists. The recovery store
    holds the state of Fleet.step, and the time of the last row of a wearer who has ended. After a restart, a session is
    created from its state when the wearer's next row arrives.

    `idle` is the time without a row after which a wearer's session is replaced by its bytes until the next row. This
    saves memory and changes no event (unless an app's part cannot be saved at that moment: Fleet.step). `forget` is the
    time without a row, on the engine's clock and over restarts, after which the state of a wearer who has ended is
    discarded. Until then, late copies of rows do not start a session. A later row starts the wearer again, with events
    numbered from 0. bytewax keeps the wearer's name (see `purge`)."""
    items = operators.map("named", up, lambda item: (item[0], item))  # bytewax does not pass the key to a logic
    return operators.stateful_batch(
        "sessions", items, lambda saved: KeyedWearer(fleet, idle, forget, *saved or (None, None))
    )


def purge(store: str | Path) -> None:
    """Remove forgotten wearers from the recovery store of a job that does not run.

    bytewax keeps their names for ever, and SQLite keeps overwritten data. Rows that bytewax may still need stay; these
    are all rows unless the job runs with `-b 0`."""
    for path in sorted(Path(store).glob("part-*.sqlite3")):
        with closing(sqlite3.connect(path)) as database:
            database.execute(
                "DELETE FROM snaps AS gone WHERE ser_change IS NULL AND NOT EXISTS (SELECT 1 FROM snaps WHERE "
                "step_id = gone.step_id AND state_key = gone.state_key AND snap_epoch < gone.snap_epoch)"
            )
            database.commit()
            database.execute("VACUUM")


@frozen
class ParquetSink(FixedPartitionedSink[NumberedEvent, tuple[int, int]]):
    """A sink that writes NumberedEvent, keyed by wearer, as Parquet files into `directory` (fleet/parquet.py).

    All workers must see the directory. Every snapshot closes a part file. `partitions` is the number of workers that
    write at the same time; it must not change during the life of a recovery store. When a file cannot be written, the
    job ends with an OSError that names it."""

    directory: Path = field(converter=Path)
    partitions: int = 1

    def list_parts(self) -> list[str]:
        return [str(number) for number in range(self.partitions)]

    def build_part(self, step_id: str, for_part: str, resume_state: tuple[int, int] | None) -> _Partition:
        return _Partition(PartFiles(self.directory, for_part, resume_state, partitions=self.list_parts()))


@frozen
class _Partition(StatefulSinkPartition[NumberedEvent, tuple[int, int]]):
    parts: PartFiles

    def write_batch(self, values: list[NumberedEvent]) -> None:
        self.parts.write(values)

    def snapshot(self) -> tuple[int, int]:
        return self.parts.close()


@define
class KeyedWearer(StatefulBatchLogic[tuple[str, Any], NumberedEvent, tuple[bytes | None, datetime | None]]):
    """The logic of one wearer; it holds a session (`keyed`), its state as bytes, or both while they are equal.

    `ended` is the time of the last row, once the wearer has ended."""

    fleet: Fleet
    idle: timedelta | None
    forget: timedelta | None
    state: bytes | None
    ended: datetime | None
    keyed: Keyed | None = None

    def on_batch(self, values: list[tuple[str, Any]]) -> tuple[Iterable[NumberedEvent], bool]:
        keyed = self.keyed = self.keyed or self.fleet.open(values[0][0], self.state)
        self.state = None
        rows = [sent if isinstance(sent, list | tuple) else (sent,) for _, sent in values]
        events = keyed.feed(chain.from_iterable(rows))
        self.ended = datetime.now(UTC) if keyed.ended else None
        return events, self.RETAIN

    def notify_at(self) -> datetime | None:
        idle = [datetime.now(UTC) + self.idle] if self.idle is not None and self.keyed is not None else []
        return min([*idle, *self._forget_at()], default=None)

    def on_notify(self) -> tuple[Iterable[NumberedEvent], bool]:
        if any([at <= datetime.now(UTC) for at in self._forget_at()]):
            return [], self.DISCARD
        self.snapshot()
        self.keyed = None
        return [], self.RETAIN

    def _forget_at(self) -> list[datetime]:
        return [self.ended + self.forget] if self.ended is not None and self.forget is not None else []

    def snapshot(self) -> tuple[bytes | None, datetime | None]:
        if self.state is None and self.keyed is not None:
            self.state = self.keyed.state()
        return self.state, self.ended
