"""A fleet on Spark: the events of sessions, also past a kill -9, a full disk, rows of anything and states of nobody.

    pip install solepath[spark,test], Java 17, then
    python -m pytest -m "spark and not soak" tests/test_fleet_spark.py             # about three minutes
    python -m pytest -m "spark and soak" -s tests/test_fleet_spark.py              # 1,000 wearers; prints its rate
"""

from __future__ import annotations

import json
import os
import random
import re
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterable, Iterator
from functools import cache
from pathlib import Path
from struct import pack
from typing import Any

import pytest

from solepath.fleet import TOLD_COLUMNS, End, Fleet, Sent, Told, sent_line, sent_row, told_row
from solepath.fleet.spark_files import committed
from solepath.recipes import BY_NAME, DEFAULT
from solepath.session import Session
from solepath.sim.route import Route
from solepath.types import Packet, Site
from toys import BASE
from walks import insoles

JOB = Path(__file__).resolve().parents[1] / "examples" / "spark_gait.py"
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


def _lacking() -> str | None:
    """Why Spark cannot run here."""
    home = os.environ.get("JAVA_HOME")
    java = shutil.which("java", path=f"{home}/bin" if home else None)
    if java is None:
        return "Spark needs Java 17, and there is no java here"
    told = subprocess.run([java, "-version"], capture_output=True, text=True, check=False).stderr
    version = re.search(r'version "(\d+)', told)
    if version is None or int(version[1]) < 17:
        return f"Spark needs Java 17, and here is {told.splitlines()[0] if told else 'none'}"
    try:
        import pyspark  # noqa: F401
        from google import protobuf  # noqa: F401
    except ImportError as error:
        return f"{error}; pip install solepath[spark]"
    return None


pytestmark = [pytest.mark.spark]


@pytest.fixture(scope="module", autouse=True)
def _needed() -> None:
    lacking = _lacking()
    if lacking is not None:
        pytest.skip(lacking)


@pytest.fixture(scope="module")
def spark() -> Iterator[Any]:
    from pyspark.sql import SparkSession

    from solepath.fleet.spark import STORE

    os.environ["SPARK_LOCAL_IP"] = "127.0.0.1"
    os.environ["PYSPARK_PYTHON"] = sys.executable
    os.environ["PYTHONPATH"] = os.pathsep.join([str(Path(__file__).parent), os.environ.get("PYTHONPATH", "")])
    session = SparkSession.builder.master(MASTER).config(map=CONF | STORE).getOrCreate()
    session.sparkContext.setLogLevel("ERROR")
    yield session
    session.stop()


# --- what is sent, and what is to be told of it -----------------------------------------------------------------------


def sent(wearer: int, walk: int) -> list[Sent]:
    """All that the phone of one wearer sends."""
    packets = insoles(ROUTE, seed=walk, cells=48).packets
    what = [*packets, End()]
    return [Sent(f"w{wearer}", number, one) for number, one in enumerate(what)]


@cache
def says(walk: int, recipe: str) -> tuple[Row, ...]:
    """Rows of what a bare session says of the same walk."""
    session = Session(BY_NAME[recipe])
    events = session.feed(insoles(ROUTE, seed=walk, cells=48).packets) + session.finish()
    return tuple(told_row(Told("", number, event)) for number, event in enumerate(events))


def expected(wearers: int, recipe: str = DEFAULT.name) -> list[Row]:
    rows = [{**row, "wearer": f"w{w}"} for w in range(wearers) for row in says(w % WALKS, recipe)]
    return in_order(rows)


def in_order(rows: Iterable[Row]) -> list[Row]:
    return sorted(rows, key=lambda row: (row["wearer"], row["number"]))


def of_sessions(rows: Iterable[Row]) -> list[Row]:
    """Those of the wearers w0, w1, ..."""
    return in_order(row for row in rows if re.fullmatch(r"w\d+", row["wearer"]))


def deliver(directory: Path, wearers: int, files: int, more: Iterable[Row] = ()) -> int:
    """Files of what all wearers send at the same time; in each the rows are shuffled, some are late by a file, some
    are there twice. Returns how many rows.

    A file holds fewer rows of a wearer than the fleet's window."""
    chance = random.Random(wearers)
    directory.mkdir()
    late: list[Row] = []
    count = 0
    for file in range(files):
        rows, late = [*late, *(more if file == 0 else ())], []
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


def told(directory: Path) -> list[Row]:
    """What is in the files that count, by somebody who is not Spark."""
    from pyarrow import parquet

    return in_order(row for path in committed(directory) for row in parquet.read_table(path).to_pylist())


def run(rows: Any, directory: Path, fleet: Fleet | Callable[[], Fleet] | None = None, states: Any = None) -> list[Row]:
    """All that is there through the fleet, into files below `directory`."""
    from solepath.fleet.spark import gait

    events = gait(rows, Fleet() if fleet is None else fleet, states)
    writer = events.writeStream.format("parquet").option("checkpointLocation", str(directory / "checkpoint"))
    writer.trigger(availableNow=True).start(str(directory / "told")).awaitTermination()
    return told(directory / "told")


def stream(spark: Any, directory: Path, files: int = 1) -> Any:
    from solepath.fleet.spark import SENT_SCHEMA

    return spark.readStream.schema(SENT_SCHEMA).option("maxFilesPerTrigger", files).parquet(str(directory))


# --- the events -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("recipe", ["default", "kupt-dfpc"])
def test_events_through_spark_are_those_of_a_session(spark, tmp_path, recipe):
    deliver(tmp_path / "sent", wearers=5, files=5)
    events = run(stream(spark, tmp_path / "sent"), tmp_path, Fleet(BY_NAME[recipe]))
    assert events == expected(5, recipe)
    assert list(events[0]) == list(TOLD_COLUMNS)
    assert {"StepTaken", "HeelStrike"} <= {row["event"] for row in events}


def test_other_readers_find_the_files_that_spark_finds(spark, tmp_path):
    """After a few batches Spark folds what it has written of its files into one."""
    deliver(tmp_path / "sent", wearers=2, files=5)
    events = run(stream(spark, tmp_path / "sent"), tmp_path)
    assert list((tmp_path / "told/_spark_metadata").glob("*.compact"))
    nobodys = tmp_path / "told" / "part-of-a-killed-task.snappy.parquet"
    nobodys.write_bytes(b"PAR1")
    assert told(tmp_path / "told") == events == in_order(
        row.asDict() for row in spark.read.parquet(str(tmp_path / "told")).collect()
    )  # fmt: skip


def test_messages_as_kafka_has_them_give_the_same_events(spark, tmp_path):
    """Their key is the wearer, and their value are lines, of a second or so."""
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
    refused = [row["wearer"] for row in events if row["event"] == "SentRejected"]
    assert sorted(refused) == ["w0", "w0", "w0", "w3", "\ufffd\ufffd"]
    rest = [row for row in events if row["event"] != "SentRejected"]
    of = [[without_number(row) for row in rest if row["wearer"] == f"w{wearer}"] for wearer in range(2)]
    assert of == [[without_number(row) for row in expected(2) if row["wearer"] == f"w{wearer}"] for wearer in range(2)]


def _bundles(wearer: int) -> Iterator[list[bytes]]:
    lines = [sent_line(one) for one in sent(wearer, wearer)]
    yield from (lines[at : at + 200] for at in range(0, len(lines), 200))


def without_number(row: Row) -> Row:
    return {key: value for key, value in row.items() if key != "number"}


def of_toys() -> Fleet:
    """One that no pickle takes."""
    return Fleet(profiles=[BASE])


def test_a_fleet_with_a_device_of_ones_own_is_made_where_it_is_used(spark, tmp_path):
    batteries = [0.5, float("nan"), 0.25]
    data = [bytes([0]) + pack(">d", share) for share in batteries] + [bytes([11]) + pack(">d", 1.0)]
    packets = [Packet(float(t), Site.LEFT_FOOT, "toy/more", one) for t, one in enumerate(data)]
    (tmp_path / "sent").mkdir()
    put(tmp_path / "sent/toy.parquet", [sent_row(Sent("w0", number, one)) for number, one in enumerate(packets)], 0)
    events = run(stream(spark, tmp_path / "sent"), tmp_path, of_toys)
    said = Session(profiles=[BASE]).feed(packets)
    assert {"BatteryLevel", "PacketRejected"} <= {row["event"] for row in events}
    assert events == [told_row(Told("w0", number, event)) for number, event in enumerate(said)]


# --- what goes wrong --------------------------------------------------------------------------------------------------


def anything(count: int) -> Iterator[Row]:
    """Rows of wearers whose rows are filled at random: of any bytes, also where the rest is as it should be."""
    chance = random.Random(8)
    good = [sent_row(one) for one in sent(0, 0)]

    def flawed(row: Row) -> Row:
        longer = chance.choice([chance.randbytes(40), chance.randbytes(5000), b"", None])
        odd = chance.choice([None, "", "left_foot", "tick", "end", "insole/frame", "\u0000", "x" * 300])
        numbers = chance.choice([None, -1, 0, 2**63 - 1, -(2**63), chance.randrange(2000)])
        times = chance.choice([None, float("nan"), float("inf"), -1e308, 0.0])
        key = chance.choice(sorted(row))
        value = {"data": longer, "t": times, "run": numbers, "number": numbers}.get(key, odd)
        return {**row, "wearer": f"poisoned {chance.randrange(5)}", key: value}

    for row in chance.choices(good, k=count):
        yield flawed(row)


def test_a_wearer_of_anything_stalls_no_other(spark, tmp_path):
    deliver(tmp_path / "sent", wearers=3, files=5, more=anything(2000))
    events = run(stream(spark, tmp_path / "sent"), tmp_path)
    assert of_sessions(events) == expected(3)
    poisoned = [row for row in events if row["wearer"].startswith("poisoned")]
    assert {"SentRejected", "NumbersMissing"} <= {row["event"] for row in poisoned}
    assert any(row["wearer"] == "" and "wearer is no text" in row["fields"] for row in events)


def test_text_that_is_no_text_ends_no_job(spark, tmp_path):
    """Parquet holds whatever bytes were written as text."""
    import pyarrow as pa
    from pyarrow import parquet

    (tmp_path / "sent").mkdir()
    rows = [sent_row(one) for one in sent(0, 0)]
    put(tmp_path / "sent/good.parquet", rows, 0)
    bad = parquet.read_table(tmp_path / "sent/good.parquet").take([0, 0, 0])
    for name in ("wearer", "site", "channel", "device"):
        bytes_ = pa.array([b"\xff\xfe", b"w0\x80", b"\xed\xa0\x80"]).view(pa.string())
        bad = bad.set_column(bad.column_names.index(name), name, bytes_)
    parquet.write_table(bad, tmp_path / "sent/bad.parquet")
    events = run(stream(spark, tmp_path / "sent"), tmp_path)
    assert of_sessions(events) == expected(1)
    assert [row["event"] for row in events if row["wearer"] != "w0"] == ["SentRejected"] * 3


def test_a_state_that_cannot_go_on_is_told_and_its_wearer_begins_afresh(spark, tmp_path):
    """As after a step back to an older release: its version is 250."""
    from binascii import crc32

    fleet = Fleet()
    states, before = {}, {}
    for wearer in range(3):
        first = sent(wearer, wearer)[:400]
        states[f"w{wearer}"], events = fleet.step(f"w{wearer}", None, first)
        before[f"w{wearer}"] = [told_row(one) for one in events]
    head = states["w1"][:4] + bytes([250]) + states["w1"][5:37]
    states["w1"] = head + crc32(head).to_bytes(4, "little") + states["w1"][41:]
    states["w2"] = b"nothing that anybody wrote"

    (tmp_path / "sent").mkdir()
    put(tmp_path / "sent/rest.parquet", [sent_row(one) for wearer in range(3) for one in sent(wearer, wearer)[400:]], 0)
    frame = spark.createDataFrame(list(states.items()), "wearer string, state binary")
    events = run(stream(spark, tmp_path / "sent"), tmp_path, fleet, frame)
    of = {wearer: [row for row in events if row["wearer"] == wearer] for wearer in states}
    assert before["w0"] + of["w0"] == [row for row in expected(1) if row["wearer"] == "w0"]
    for wearer, reason in (("w1", "version 250"), ("w2", "")):
        first, *rest = of[wearer]
        assert first["event"] == "StateRefused" and reason in first["fields"]
        assert {"StepTaken", "HeelStrike"} <= {row["event"] for row in rest}
        assert first["number"] >= len(before[wearer]), "no identity is used twice"


def test_states_of_a_checkpoint_go_on_in_a_job_of_more_partitions(spark, tmp_path):
    """The number of partitions is for the life of a checkpoint; a new job begins with the states of the old one."""
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


# --- a job of its own -------------------------------------------------------------------------------------------------


class Job:
    """examples/spark_gait.py in processes of its own: the driver, its JVM and the Python workers."""

    def __init__(self, directory: Path, told: str = "told", checkpoint: str = "checkpoint") -> None:
        self.told, self.checkpoint, self.log = directory / told, directory / checkpoint, directory / f"{told}.log"
        conf = " ".join(f"--conf {key}={value}" for key, value in CONF.items())
        place = {"PYSPARK_SUBMIT_ARGS": f"--master {MASTER} {conf} pyspark-shell", "SPARK_LOCAL_IP": "127.0.0.1"}
        command = [sys.executable, JOB, directory / "sent", self.told, self.checkpoint, "--files", "1"]
        with self.log.open("w") as log:
            self.process = subprocess.Popen(
                command, env=os.environ | place, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=log,
                text=True, start_new_session=True,
            )  # fmt: skip

    def __enter__(self) -> Job:
        return self

    def __exit__(self, *_: object) -> None:
        self.kill()
        self.process.wait()
        if self.process.stdout is not None:
            self.process.stdout.close()

    def batches(self) -> int:
        """How many are done with."""
        return len(list(self.checkpoint.glob("commits/[0-9]*")))

    def until(self, batches: int) -> None:
        while self.batches() < batches:
            assert self.process.poll() is None, self.log.read_text()[-3000:]
            time.sleep(0.02)

    def end(self) -> str:
        told, _ = self.process.communicate()
        assert self.process.returncode == 0, self.log.read_text()[-3000:]
        return told

    def kill(self) -> int:
        """kill -9 of all of it at once. Returns how many processes there were."""
        there = map(int, filter(str.isdigit, os.listdir("/proc")))
        session = [pid for pid in there if _session(pid) == self.process.pid]
        for pid in session:
            os.kill(pid, signal.SIGKILL)
        while any(_session(pid) == self.process.pid and not _is_dead(pid) for pid in session):
            time.sleep(0.01)
        return len(session)


def _session(pid: int) -> int | None:
    try:
        return os.getsid(pid)
    except ProcessLookupError:
        return None


def _is_dead(pid: int) -> bool:
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] == "Z"
    except OSError:
        return True


@pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="finds the processes of a job in /proc")
@pytest.mark.parametrize(("wearers", "kills"), [(25, 2), pytest.param(1000, 1, marks=pytest.mark.soak)])
def test_a_job_that_is_killed_in_mid_stream_tells_what_one_that_runs_through_tells(tmp_path, wearers, kills):
    files = 10
    rows = deliver(tmp_path / "sent", wearers, files)
    begun = time.monotonic()
    with Job(tmp_path, "through", "through-checkpoint") as job:
        job.until(1)
        first = time.monotonic()
        batches = job.end()
        seconds = (time.monotonic() - first) / (files - 1)
    print(f"\n{wearers} wearers, {rows} rows in {time.monotonic() - begun:.0f} s with Spark's own start\n{batches}")

    chance = random.Random(time.time_ns())
    for _ in range(kills):
        with Job(tmp_path) as job:
            job.until(job.batches() + chance.randint(1, 2))
            time.sleep(chance.uniform(0.0, seconds))
            done = job.batches()
            processes = job.kill()
        print(f"killed {processes} processes after {done} of {files} batches")
        assert processes >= 3 and 1 <= done < files
    with Job(tmp_path) as job:
        job.end()
    events = told(job.told)
    written = set(job.told.glob("*.parquet"))
    print(f"{len(events)} events; {len(written) - len(set(committed(job.told)))} files that nobody finished")
    assert events == told(tmp_path / "through") == expected(wearers)


@pytest.fixture
def small_disk(tmp_path: Path) -> Iterator[Path]:
    """A place with room for almost nothing."""
    place = tmp_path / "told"
    place.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", "size=32k", "tmpfs", place]
    if shutil.which("mount") is None or subprocess.run(mount, capture_output=True, check=False).returncode:
        pytest.skip("no disk can be mounted here")
    yield place
    subprocess.run(["umount", place], check=True)


def test_a_job_whose_disk_is_full_ends_and_goes_on_when_there_is_room(tmp_path, small_disk):
    deliver(tmp_path / "sent", wearers=10, files=5)
    with Job(tmp_path) as job:
        job.process.communicate()
    assert job.process.returncode != 0 and "No space left on device" in job.log.read_text()
    assert job.batches() < 5
    subprocess.run(["mount", "-o", "remount,size=64m", small_disk], check=True)
    with Job(tmp_path) as job:
        job.end()
    assert told(small_disk) == expected(10)


def test_events_of_a_wearer_have_one_number_each():
    numbers = [row["number"] for row in says(0, "default")]
    assert numbers == list(range(len(numbers)))
    assert all(isinstance(json.loads(row["fields"]), dict) for row in says(0, "default"))
