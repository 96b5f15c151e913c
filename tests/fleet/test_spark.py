"""A fleet on Spark: the events of sessions, also past rows of anything and states of nobody.

pip install -e '.[test,spark]', then
python -m pytest -m long tests/fleet/test_spark*.py
"""

from __future__ import annotations

import os
import random
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from here import HELPERS
from sparks import CONF, MASTER, Row, deliver, expected, in_order, needed, read_output, sent

from solepath.fleet import EVENT_COLUMNS, Fleet, sent_line
from solepath.fleet.jvm import java_environment
from solepath.recipes import by_name

pytestmark = [pytest.mark.long]
_needed = pytest.fixture(needed, scope="module", autouse=True)


@pytest.fixture(scope="module")
def spark() -> Iterator[Any]:
    from pyspark.sql import SparkSession

    from solepath.fleet.spark import STORE

    os.environ["SPARK_LOCAL_IP"] = "127.0.0.1"
    os.environ["PYSPARK_PYTHON"] = sys.executable
    os.environ.update(java_environment())
    os.environ["PYTHONPATH"] = os.pathsep.join([str(HELPERS), str(HELPERS / "fleet"), os.environ.get("PYTHONPATH", "")])
    session = SparkSession.builder.master(MASTER).config(map=CONF | STORE).getOrCreate()
    session.sparkContext.setLogLevel("ERROR")
    yield session
    session.stop()


def run(rows: Any, directory: Path, fleet: Fleet | Callable[[], Fleet] | None = None, states: Any = None) -> list[Row]:
    """Send all input files through the fleet, into files below `directory`."""
    from solepath.fleet.spark import gait

    events = gait(rows, Fleet() if fleet is None else fleet, states)
    writer = events.writeStream.format("parquet").option("checkpointLocation", str(directory / "checkpoint"))
    writer.trigger(availableNow=True).start(str(directory / "events")).awaitTermination()
    return read_output(directory / "events")


def stream(spark: Any, directory: Path, files: int = 1) -> Any:
    from solepath.fleet.spark import SENT_SCHEMA

    return spark.readStream.schema(SENT_SCHEMA).option("maxFilesPerTrigger", files).parquet(str(directory))


@pytest.mark.parametrize("recipe", ["default", "kupt-dfpc"])
def test_events_through_spark_are_those_of_a_session(spark, tmp_path, recipe):
    deliver(tmp_path / "sent", wearers=5, files=5)
    events = run(stream(spark, tmp_path / "sent"), tmp_path, Fleet(by_name(recipe)))
    assert events == expected(5, recipe)
    assert list(events[0]) == list(EVENT_COLUMNS)
    assert {"StrideTaken", "HeelStrike"} <= {row["event"] for row in events}


def test_messages_as_kafka_has_them_give_the_same_events(spark, tmp_path):
    """Return messages whose key is the wearer and whose value holds the lines of about a second."""
    from pyarrow import parquet, table

    wrong = {b"w0": [b"no JSON\n", b"\xff{\n", sent_line(sent(1, 1)[0])], b"\xff\xfe": [b"{}"], b"w3": [b"\n"] * 5000}
    messages = [(f"w{wearer}".encode(), lines) for wearer in range(2) for lines in _bundles(wearer)]
    messages += [*wrong.items(), (None, [])]
    random.Random(3).shuffle(messages)
    (tmp_path / "sent").mkdir()
    keys, values = [key for key, _ in messages], [b"".join(lines) for _, lines in messages]
    parquet.write_table(table({"key": keys, "value": values}), tmp_path / "sent/messages.parquet")
    rows = spark.readStream.schema("key binary, value binary").parquet(str(tmp_path / "sent"))
    events = run(rows, tmp_path)
    rejected = [row["wearer"] for row in events if row["event"] == "SentRejected"]
    assert sorted(rejected) == ["", "w0", "w0", "w0", "w3", "\ufffd\ufffd"]
    rest = [row for row in events if row["event"] != "SentRejected"]
    of = [[without_number(row) for row in rest if row["wearer"] == f"w{wearer}"] for wearer in range(2)]
    assert of == [[without_number(row) for row in expected(2) if row["wearer"] == f"w{wearer}"] for wearer in range(2)]


def _bundles(wearer: int) -> Iterator[list[bytes]]:
    lines = [sent_line(one) for one in sent(wearer, wearer)]
    yield from (lines[at : at + 200] for at in range(0, len(lines), 200))


def without_number(row: Row) -> Row:
    return {key: value for key, value in row.items() if key != "number"}


def test_states_of_a_checkpoint_go_on_in_a_job_of_more_partitions(spark, tmp_path):
    """A checkpoint has a fixed number of partitions; a new job starts with the states of the old one."""
    deliver(tmp_path / "sent", wearers=4, files=5)
    later = tmp_path / "later"
    later.mkdir()
    for path in sorted((tmp_path / "sent").iterdir())[3:]:
        path.rename(later / path.name)
    before = run(stream(spark, tmp_path / "sent"), tmp_path)
    store = spark.read.format("statestore").option("stateVarName", "wearer").load(str(tmp_path / "checkpoint"))
    states = store.selectExpr("key.key as wearer", "value.state as state").localCheckpoint()
    spark.conf.set("spark.sql.shuffle.partitions", "3")
    try:
        after = run(stream(spark, later), tmp_path / "next", states=states)
    finally:
        spark.conf.set("spark.sql.shuffle.partitions", CONF["spark.sql.shuffle.partitions"])
    assert before and after and in_order(before + after) == expected(4)
