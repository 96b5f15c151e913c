"""Helpers of the tests of a fleet on Spark: whether Spark can run here, phones' rows, and expected events."""

from __future__ import annotations

import os
import random
from collections.abc import Iterable
from functools import cache
from pathlib import Path
from typing import Any

import pytest
from walks import insoles, run_session

from solepath.emulate.routes.route import Route
from solepath.fleet import End, NumberedEvent, Sent, event_row, sent_row
from solepath.fleet.jvm import NoJava, java_environment
from solepath.fleet.spark_files import committed
from solepath.recipes import DEFAULT, by_name
from solepath.types.extras import install_hint

ROUTE = Route().stand(1.0).walk(3.0, 1.3).stop(0.5)
CONF = {
    "spark.driver.memory": "2g",
    "spark.driver.bindAddress": "127.0.0.1",
    "spark.driver.host": "127.0.0.1",
    "spark.ui.enabled": "false",
    "spark.ui.showConsoleProgress": "false",
    "spark.sql.shuffle.partitions": "2",
    "spark.sql.streaming.fileSink.log.compactInterval": "3",
}
MASTER = "local[2]"
WALKS = 5

Row = dict[str, Any]


def lacking() -> str | None:
    """Return why Spark cannot run here."""
    try:
        import pyspark  # noqa: F401
        from google import protobuf  # noqa: F401

        java_environment()
    except (ImportError, NoJava) as error:
        return f"{error}; {install_hint('spark')}"
    return None


def needed() -> None:
    """Skips what needs Spark, with the reason why it cannot run here."""
    why = lacking()
    if why is not None:
        pytest.skip(why)


def sent(wearer: int, walk: int) -> list[Sent]:
    """Return all rows that the phone of one wearer sends."""
    packets = insoles(ROUTE, seed=walk, cells=48).packets
    what = [*packets, End()]
    return [Sent(f"w{wearer}", number, one) for number, one in enumerate(what)]


@cache
def session_rows(walk: int, recipe: str) -> tuple[Row, ...]:
    """Return the rows of a session alone for the same walk."""
    events = run_session(insoles(ROUTE, seed=walk, cells=48).packets, by_name(recipe))
    return tuple(event_row(NumberedEvent("", number, event)) for number, event in enumerate(events))


def expected(wearers: int, recipe: str = DEFAULT.name) -> list[Row]:
    rows = [{**row, "wearer": f"w{w}"} for w in range(wearers) for row in session_rows(w % WALKS, recipe)]
    return in_order(rows)


def in_order(rows: Iterable[Row]) -> list[Row]:
    return sorted(rows, key=lambda row: (row["wearer"], row["number"]))


def deliver(directory: Path, wearers: int, files: int) -> int:
    """Files of what all wearers send at the same time; in each the rows are shuffled, some are late by a file, some
    are there twice. Returns how many rows.

    A file holds fewer rows of a wearer than the fleet's window."""
    chance = random.Random(wearers)
    directory.mkdir()
    late: list[Row] = []
    count = 0
    for file in range(files):
        rows, late = late, []
        for wearer in range(wearers):
            mine = sent(wearer, wearer % WALKS)
            for one in mine[len(mine) * file // files : len(mine) * (file + 1) // files]:
                fate = chance.random()
                (late if fate < 0.005 and file < files - 1 else rows).append(sent_row(one))
                if fate > 0.995:
                    rows.append(sent_row(one))
        chance.shuffle(rows)
        put(directory / f"{file:03}.parquet", rows, file)
        count += len(rows)
    return count


def put(path: Path, rows: list[Row], age: int) -> None:
    """One file of rows. Spark takes files by the time of their last change."""
    import pyarrow as pa
    from pyarrow import parquet

    kinds = {"wearer": pa.string(), "run": pa.int64(), "number": pa.int64(), "t": pa.float64(), "data": pa.binary()}
    schema = pa.schema([(name, kinds.get(name, pa.string())) for name in sent_row(Sent("", 0, End()))])
    parquet.write_table(pa.Table.from_pylist(rows, schema), path)
    os.utime(path, (1.7e9 + age, 1.7e9 + age))


def read_output(directory: Path) -> list[Row]:
    """Return the rows of the files that count, read without Spark."""
    from pyarrow import parquet

    return in_order(row for path in committed(directory) for row in parquet.read_table(path).to_pylist())
