"""A fleet on bytewax: an operator for anybody's dataflow, and a sink for what it tells. Needs the extra `bytewax`.

    sent = operators.input("phones", flow, source)                      # of Sent and Unreadable, as read_sent gives
    keyed = operators.key_on("wearer", sent, lambda one: one.wearer)
    told = gait("gait", keyed, Fleet(recipe))                           # of Told, keyed by wearer
    operators.output("files", told, ParquetSink("told"))

Killed at any moment and started again with its recovery store, a job goes on at the last snapshot: the source, every
wearer and the sink at the same place. So the files hold each event once, when the source can go back to where it was.
"""

from __future__ import annotations

from collections.abc import Iterable
from datetime import UTC, datetime, timedelta
from functools import partial
from pathlib import Path
from typing import Any

from bytewax import operators
from bytewax.dataflow import operator
from bytewax.operators import KeyedStream, StatefulBatchLogic
from bytewax.outputs import FixedPartitionedSink, StatefulSinkPartition

from .fleet import Fleet
from .keyed import Keyed
from .parquet import Parts
from .sent import Sent, Told, Unreadable

Batch = tuple[str, list[Sent | Unreadable]]


@operator
def gait(step_id: str, up: KeyedStream[Any], fleet: Fleet, idle: timedelta | None = None) -> KeyedStream[Told]:
    """What the sessions of a fleet tell of what phones sent, wearer by wearer.

    `up`: keyed by the wearer's name; Sent and Unreadable, one at a time or in lists. Its state in the recovery store is
    that of Fleet.step. After a restart a session is made again when its wearer is heard of again. `idle`: the session
    of who sent nothing for so long is put away as bytes until then, which changes memory and not a single event.
    """
    batches = operators.flat_map_batch("batches", up, _batches)
    return operators.stateful_batch("sessions", batches, partial(_Wearer, fleet, idle))


def _batches(items: list[tuple[str, Any]]) -> list[tuple[str, Batch]]:
    """By wearer, each with the name: bytewax does not tell it to who keeps the state."""
    by_wearer: dict[str, list[Any]] = {}
    for wearer, sent in items:
        by_wearer.setdefault(wearer, []).extend(sent if isinstance(sent, list | tuple) else [sent])
    return [(wearer, (wearer, sent)) for wearer, sent in by_wearer.items()]


class _Wearer(StatefulBatchLogic[Batch, Told, bytes | None]):
    """One wearer: a session, or its state as bytes, or both while they are the same."""

    def __init__(self, fleet: Fleet, idle: timedelta | None, state: bytes | None) -> None:
        self._fleet, self._idle, self._state = fleet, idle, state
        self._keyed: Keyed | None = None
        self._until: datetime | None = None

    def on_batch(self, values: list[Batch]) -> tuple[Iterable[Told], bool]:
        if self._keyed is None:
            self._keyed = self._fleet.open(values[0][0], self._state)
        self._state = None
        if self._idle is not None:
            self._until = datetime.now(UTC) + self._idle
        return [told for _, sent in values for told in self._keyed.feed(sent)], self.RETAIN

    def notify_at(self) -> datetime | None:
        return self._until

    def on_notify(self) -> tuple[Iterable[Told], bool]:
        self.snapshot()
        self._keyed = self._until = None
        return [], self.RETAIN

    def snapshot(self) -> bytes | None:
        if self._state is None and self._keyed is not None:
            self._state = self._keyed.state()
        return self._state


class ParquetSink(FixedPartitionedSink[Told, int]):
    """Told, keyed by wearer, as Parquet files in `directory` (fleet/parquet.py), a part at every snapshot.

    `partitions`: so many workers write; it stays the same for the life of a recovery store. All workers see the same
    directory. The job ends with an OSError that names the file when one cannot be written.
    """

    def __init__(self, directory: str | Path, partitions: int = 1) -> None:
        self._directory, self._partitions = Path(directory), partitions

    def list_parts(self) -> list[str]:
        return [str(number) for number in range(self._partitions)]

    def build_part(self, step_id: str, for_part: str, resume_state: int | None) -> _Partition:
        return _Partition(Parts(self._directory, for_part, resume_state))


class _Partition(StatefulSinkPartition[Told, int]):
    def __init__(self, parts: Parts) -> None:
        self._parts = parts

    def write_batch(self, values: list[Told]) -> None:
        self._parts.write(values)

    def snapshot(self) -> int:
        return self._parts.close()
