"""A fleet on Spark Structured Streaming: `transformWithState` keeps the state of each wearer and recovers it.

    events = gait(rows, Fleet())          # streaming DataFrames: of SENT_SCHEMA in, of EVENT_SCHEMA out
    events.writeStream.format("parquet").option("checkpointLocation", checkpoint).start(directory)

Needs the extra `spark`, Java 17 or later (jvm.py), and a session that was configured with STORE.
examples/spark_gait.py is a whole job.

A micro-batch reads and writes a wearer's state once, and its events are available when it ends. A batch that Spark
repeats after a crash emits the same events with the same identities (NumberedEvent). A killed task may leave files in
the sink's directory: Spark ignores them; other readers need spark_files.py."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import lru_cache
from itertools import chain
from typing import Any

from pyspark.sql import Column, DataFrame, Row
from pyspark.sql import functions as f
from pyspark.sql.streaming.stateful_processor import StatefulProcessor, StatefulProcessorHandle, TimerValues

from . import EVENT_COLUMNS, SENT_COLUMNS, Fleet, Sent, Unreadable, event_row, read_message, read_sent

_ROCKS = "org.apache.spark.sql.execution.streaming.state.RocksDBStateStoreProvider"
STORE = {"spark.sql.streaming.stateStore.providerClass": _ROCKS}
"""Configuration that the Spark session needs: transformWithState keeps its state in RocksDB only."""


def _make_schema(columns: Mapping[str, type]) -> str:
    kinds = {str: "string", int: "bigint", float: "double", bool: "boolean", bytes: "binary"}
    return ", ".join(f"{name} {kinds[kind]}" for name, kind in columns.items())


SENT_SCHEMA, EVENT_SCHEMA = _make_schema(SENT_COLUMNS), _make_schema(EVENT_COLUMNS)
"""Schemas of the rows of solepath.fleet, in Spark's notation."""


def gait(rows: DataFrame, fleet: Fleet | Callable[[], Fleet], states: DataFrame | None = None) -> DataFrame:
    """Return the events (EVENT_SCHEMA) of a fleet's sessions for the rows that phones sent.

    The rows may arrive in any order within the fleet's window. `rows` is of SENT_SCHEMA, or holds messages of Kafka:
    `key` is the wearer's name and `value` holds lines of `sent_line`; more lines in a message cost less per line. An
    unreadable row is reported as an event, of the wearer "" if its wearer is unknown.

    `fleet` is pickled and sent to the executors with every task. For a fleet that is large or cannot be pickled
    (drivers), give a function that makes it, at the top level of a module that the executors can import: each process
    calls it once. `states` (wearer string, state binary) holds the wearers' first states for a new checkpoint."""
    if "value" in rows.columns:
        rows = rows.select(_text_column("key"), "value")
    else:
        columns = [_text_column(name) if kind is str else name for name, kind in SENT_COLUMNS.items()]
        rows = rows.select(_text_column("wearer").alias("key"), *columns)
    keyed = rows.fillna("", ["key"]).groupBy("key")
    initial = None if states is None else states.groupBy("wearer")
    return keyed.transformWithState(GaitProcessor(fleet), EVENT_SCHEMA, "Append", timeMode="None", initialState=initial)


def _text_column(name: str) -> Column:
    # invalid UTF-8 would end the worker, and with it the job, at every start
    return f.make_valid_utf8(f.col(name).cast("string")).alias(name)


class GaitProcessor(StatefulProcessor):
    """The step for one wearer; its state is that of Fleet.step."""

    def __init__(self, fleet: Fleet | Callable[[], Fleet]) -> None:
        self.fleet = fleet

    def init(self, handle: StatefulProcessorHandle) -> None:
        self._step = (self.fleet if isinstance(self.fleet, Fleet) else _make_fleet(self.fleet)).step
        self._state = handle.getValueState("wearer", "state binary")

    def handleInitialState(self, key: Any, initialState: Any, timerValues: TimerValues) -> None:
        self._state.update((initialState.state,))

    def handleInputRows(self, key: Any, rows: Iterable[Row], timerValues: TimerValues) -> Iterator[Row]:
        old_state = self._state.get()
        # the shuffle changes the order within a batch; the fleet's window is needed for rows of different batches
        sent = sorted(chain.from_iterable(map(_read_row, rows)), key=_sort_key)
        old = None if old_state is None else bytes(old_state[0])
        state, events = self._step(key[0], old, sent)
        if state != old:
            self._state.update((state,))
        return (Row(**event_row(event)) for event in events)


def _read_row(row: Row) -> list[Sent | Unreadable]:
    return read_message(row.key, row.value) if "value" in row else [read_sent(row.asDict())]


_make_fleet = lru_cache(lambda make: make())


def _sort_key(sent: Sent | Unreadable) -> tuple[int, int]:
    return sent.run, -1 if sent.number is None else sent.number
