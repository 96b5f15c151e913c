"""A fleet on Spark Structured Streaming: `transformWithState` keeps the state of each wearer, moves it and recovers it.

    told = gait(rows, Fleet())            # streaming DataFrames: of SENT_SCHEMA in, of EVENT_SCHEMA out
    told.writeStream.format("parquet").option("checkpointLocation", checkpoint).start(directory)

Needs the extra `spark`, Java 17, and a session that was configured with STORE. examples/spark_gait.py is a whole job.

A micro-batch reads and writes a wearer's state once, and its events come out when it ends. What Spark repeats after a
crash gives the same events under the same identities (Told), and changes the state once. The files that its sink wrote
may be a killed task's: Spark passes over those, for other readers see spark_files.py.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import lru_cache
from itertools import chain
from typing import Any

from pyspark.sql import Column, DataFrame, Row
from pyspark.sql import functions as f
from pyspark.sql.streaming.stateful_processor import StatefulProcessor, StatefulProcessorHandle, TimerValues

from . import EVENT_COLUMNS, SENT_COLUMNS, Fleet, Sent, Unreadable, event_row, read_line, read_sent

_ROCKS = "org.apache.spark.sql.execution.streaming.state.RocksDBStateStoreProvider"
STORE = {"spark.sql.streaming.stateStore.providerClass": _ROCKS}
"""What the Spark session is to be configured with: transformWithState keeps its state in RocksDB only."""
MOST_LINES = 4096
"""Of one message; one that has more is refused whole, since every line that cannot be read is told of."""


def _ddl(columns: Mapping[str, type]) -> str:
    kinds = {str: "string", int: "bigint", float: "double", bool: "boolean", bytes: "binary"}
    return ", ".join(f"{name} {kinds[kind]}" for name, kind in columns.items())


SENT_SCHEMA, EVENT_SCHEMA = _ddl(SENT_COLUMNS), _ddl(EVENT_COLUMNS)
"""Rows of solepath.fleet as Spark writes a schema."""


def gait(rows: DataFrame, fleet: Fleet | Callable[[], Fleet], states: DataFrame | None = None) -> DataFrame:
    """Events (EVENT_SCHEMA) of a fleet's sessions, fed what phones sent in any order that the fleet's window covers.

    `rows`: of SENT_SCHEMA; or messages as Kafka has them, `key` the wearer's name and `value` lines of `sent_line`: the
    more lines in one, the less they cost. What cannot be read is told, without a wearer under the name "".
    `fleet` goes to the executors by pickle, with every task. Where it is large, or no pickle takes it (drivers), give a
    function that makes it, at the top of a module that they can import: it is called once in each process.
    `states` (wearer string, state binary): what wearers begin with where the checkpoint is new.
    """
    if "value" in rows.columns:
        rows = rows.select(_text("key"), "value")
    else:
        columns = [_text(name) if kind is str else name for name, kind in SENT_COLUMNS.items()]
        rows = rows.select(_text("wearer").alias("key"), *columns)
    keyed = rows.fillna("", ["key"]).groupBy("key")
    begin = None if states is None else states.groupBy("wearer")
    return keyed.transformWithState(GaitProcessor(fleet), EVENT_SCHEMA, "Append", timeMode="None", initialState=begin)


def _text(name: str) -> Column:
    # what is no UTF-8 would end the worker, and with it the job, each time that it was started
    return f.make_valid_utf8(f.col(name).cast("string")).alias(name)


class GaitProcessor(StatefulProcessor):
    """The keyed step: its only state is the wearer's, as Fleet.step makes it."""

    def __init__(self, fleet: Fleet | Callable[[], Fleet]) -> None:
        self.fleet = fleet

    def init(self, handle: StatefulProcessorHandle) -> None:
        self._step = (self.fleet if isinstance(self.fleet, Fleet) else _made(self.fleet)).step
        self._state = handle.getValueState("wearer", "state binary")

    def handleInitialState(self, key: Any, initialState: Any, timerValues: TimerValues) -> None:
        self._state.update((initialState.state,))

    def handleInputRows(self, key: Any, rows: Iterable[Row], timerValues: TimerValues) -> Iterator[Row]:
        known = self._state.get()
        # the shuffle brings the rows of a batch in any order; the fleet's window is for what another batch brings
        sent = sorted(chain.from_iterable(map(_read, rows)), key=_place)
        state, told = self._step(key[0], None if known is None else bytes(known[0]), sent)
        self._state.update((state,))
        return (Row(**event_row(one)) for one in told)


def _read(row: Row) -> list[Sent | Unreadable]:
    if "value" not in row:
        return [read_sent(row.asDict())]
    lines = bytes(row.value or b"").splitlines()
    return [*map(read_line, lines)] if len(lines) <= MOST_LINES else [Unreadable("", f"{len(lines)} lines at once")]


_made = lru_cache(lambda make: make())


def _place(sent: Sent | Unreadable) -> tuple[int, int]:
    return sent.run, -1 if sent.number is None else sent.number
