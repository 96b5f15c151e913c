"""A fleet on Spark Structured Streaming: `transformWithState` keeps the state of each wearer, moves it and recovers it.

    told = gait(rows, Fleet())            # streaming DataFrames: of SENT_SCHEMA in, of TOLD_SCHEMA out
    told.writeStream.format("parquet").option("checkpointLocation", checkpoint).start(directory)

Needs the extra `spark`, Java 17, and a session that was configured with STORE. examples/spark_gait.py is a whole job.

A micro-batch reads and writes a wearer's state once, and its events come out when it ends. What Spark repeats after a
crash gives the same events under the same identities (Told), and changes the state once. Spark's file sink lists the
files that it has finished in `_spark_metadata`, and Spark reads no others. Nor may any other reader (`committed`): a
killed task leaves files that nobody finished. Another sink may be given a batch twice, and goes by the identities.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import lru_cache
from pathlib import Path
from typing import Any
from urllib.parse import unquote, urlsplit

from pyspark.sql import DataFrame, Row
from pyspark.sql import functions as f
from pyspark.sql.streaming.stateful_processor import StatefulProcessor, StatefulProcessorHandle, TimerValues

from . import SENT_COLUMNS, TOLD_COLUMNS, Fleet, Sent, Unreadable, read_sent, told_row

STORE = {
    "spark.sql.streaming.stateStore.providerClass":
        "org.apache.spark.sql.execution.streaming.state.RocksDBStateStoreProvider",
}  # fmt: skip
"""What the Spark session is to be configured with: transformWithState keeps its state in RocksDB only."""


def _ddl(columns: Mapping[str, type]) -> str:
    kinds = {str: "string", int: "bigint", float: "double", bool: "boolean", bytes: "binary"}
    return ", ".join(f"{name} {kinds[kind]}" for name, kind in columns.items())


SENT_SCHEMA, TOLD_SCHEMA = _ddl(SENT_COLUMNS), _ddl(TOLD_COLUMNS)
"""Rows of solepath.fleet as Spark writes a schema, for `readStream.schema`, `from_json` and the like."""


def gait(rows: DataFrame, fleet: Fleet | Callable[[], Fleet], states: DataFrame | None = None) -> DataFrame:
    """What the sessions of a fleet tell (TOLD_SCHEMA) of what phones sent (SENT_SCHEMA; other columns are left out), in
    any order that the fleet's window covers. Rows whose wearer is null are refused under the name "".

    `fleet` goes to the executors by pickle, with every task. Where it is large, or no pickle takes it (drivers),
    give a function that makes it, at the top of a module that they can import: it is called once in each process.
    `states` (wearer string, state binary): what wearers begin with where the checkpoint is new.
    """
    keyed = rows.select(f.coalesce("wearer", f.lit("")).alias("key"), *SENT_COLUMNS).groupBy("key")
    begin = None if states is None else states.groupBy("wearer")
    return keyed.transformWithState(Gait(fleet), TOLD_SCHEMA, "Append", timeMode="None", initialState=begin)


def from_lines(lines: DataFrame) -> DataFrame:
    """Rows for `gait` from lines of JSON (solepath.fleet.sent_line) in a column `value`, as Kafka has it."""
    sent = f.from_json(f.col("value").cast("string"), SENT_SCHEMA.replace("data binary", "data string"))
    return lines.select(sent.alias("sent")).select("sent.*").withColumn("data", f.unhex("data"))


class Gait(StatefulProcessor):
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
        sent = sorted([read_sent(row.asDict()) for row in rows], key=_place)
        state, told = self._step(key[0], None if known is None else bytes(known[0]), sent)
        self._state.update((state,))
        return (Row(**told_row(one)) for one in told)


_made = lru_cache(lambda make: make())


def _place(sent: Sent | Unreadable) -> tuple[int, int]:
    return sent.run, -1 if sent.number is None else sent.number


def committed(directory: str | Path) -> list[Path]:
    """The files in a local `directory` of Spark's file sink that hold finished batches: what a reader other than Spark
    is to open. Each event is in them once. Empty before the first batch ends."""
    log = {int(path.stem): path for path in Path(directory).glob("_spark_metadata/[0-9]*")}
    whole = max([number for number, path in log.items() if path.suffix == ".compact"], default=-1)
    lines = [line for number in sorted(log) if number >= whole for line in log[number].read_text().splitlines()[1:]]
    return [Path(unquote(urlsplit(json.loads(line)["path"]).path)) for line in lines]
