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
from itertools import chain
from pathlib import Path
from typing import Any

from attrs import define, field, frozen
from bytewax import operators
from bytewax.dataflow import operator
from bytewax.operators import KeyedStream, StatefulBatchLogic
from bytewax.outputs import FixedPartitionedSink, StatefulSinkPartition

from .fleet import Fleet
from .keyed import Keyed
from .parquet import Parts
from .sent import Told


@operator
def gait(step_id: str, up: KeyedStream[Any], fleet: Fleet, idle: timedelta | None = None) -> KeyedStream[Told]:
    """What the sessions of a fleet tell of what phones sent, wearer by wearer.

    `up`: keyed by the wearer's name; Sent and Unreadable, one at a time or in lists. Its state in the recovery store is
    that of Fleet.step. After a restart a session is made again when its wearer is heard of again. `idle`: the session
    of who sent nothing for so long is put away as bytes until then, which changes memory and not a single event.
    """
    named = operators.map("named", up, lambda item: (item[0], item))  # bytewax tells a logic no key
    return operators.stateful_batch("sessions", named, partial(_Wearer, fleet, idle))


@define
class _Wearer(StatefulBatchLogic[tuple[str, Any], Told, bytes | None]):
    """One wearer: a session, or its state as bytes, or both while they are the same."""

    fleet: Fleet
    idle: timedelta | None
    state: bytes | None
    keyed: Keyed | None = None

    def on_batch(self, values: list[tuple[str, Any]]) -> tuple[Iterable[Told], bool]:
        keyed = self.keyed = self.keyed or self.fleet.open(values[0][0], self.state)
        self.state = None
        told = [keyed.feed(sent if isinstance(sent, list | tuple) else [sent]) for _, sent in values]
        return list(chain.from_iterable(told)), self.RETAIN

    def notify_at(self) -> datetime | None:
        return None if self.idle is None or self.keyed is None else datetime.now(UTC) + self.idle

    def on_notify(self) -> tuple[Iterable[Told], bool]:
        self.snapshot()
        self.keyed = None
        return [], self.RETAIN

    def snapshot(self) -> bytes | None:
        if self.state is None and self.keyed is not None:
            self.state = self.keyed.state()
        return self.state


@frozen
class ParquetSink(FixedPartitionedSink[Told, tuple[int, int]]):
    """Told, keyed by wearer, as Parquet files in `directory` (fleet/parquet.py), which all workers see; every snapshot
    closes a part. `partitions`: so many workers write at a time; it stays as it is for the life of a recovery store.
    The job ends with an OSError that names the file when one cannot be written."""

    directory: Path = field(converter=Path)
    partitions: int = 1

    def list_parts(self) -> list[str]:
        return [str(number) for number in range(self.partitions)]

    def build_part(self, step_id: str, for_part: str, resume_state: tuple[int, int] | None) -> _Partition:
        return _Partition(Parts(self.directory, for_part, resume_state, partitions=self.list_parts()))


@frozen
class _Partition(StatefulSinkPartition[Told, tuple[int, int]]):
    parts: Parts

    def write_batch(self, values: list[Told]) -> None:
        self.parts.write(values)

    def snapshot(self) -> tuple[int, int]:
        return self.parts.close()
