"""A Spark job in processes of its own, with a kill -9 and a full disk; test_spark.py explains how to run it."""

from __future__ import annotations

import os
import random
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from here import EXAMPLES
from sparks import CONF, MASTER, deliver, expected, needed, read_output

from solepath.fleet.spark_files import committed

JOB = EXAMPLES / "spark_gait.py"

pytestmark = [pytest.mark.long]
_needed = pytest.fixture(needed, scope="module", autouse=True)


class Job:
    """A run of examples/spark_gait.py in separate processes: the driver, its JVM and the Python workers."""

    def __init__(self, directory: Path, output: str = "events", checkpoint: str = "checkpoint") -> None:
        self.output, self.checkpoint, self.log = directory / output, directory / checkpoint, directory / f"{output}.log"
        conf = " ".join(f"--conf {key}={value}" for key, value in CONF.items())
        place = {"PYSPARK_SUBMIT_ARGS": f"--master {MASTER} {conf} pyspark-shell", "SPARK_LOCAL_IP": "127.0.0.1"}
        command = [sys.executable, JOB, directory / "sent", self.output, self.checkpoint, "--files", "1"]
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
        """Return the number of finished batches."""
        return len(list(self.checkpoint.glob("commits/[0-9]*")))

    def until(self, batches: int) -> None:
        while self.batches() < batches:
            assert self.process.poll() is None, self.log.read_text()[-3000:]
            time.sleep(0.02)

    def end(self) -> str:
        read_output, _ = self.process.communicate()
        assert self.process.returncode == 0, self.log.read_text()[-3000:]
        return read_output

    def kill(self) -> int:
        """Kill all processes at once as `kill -9` does, and return their number."""
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
def test_a_job_that_is_killed_in_mid_stream_emits_the_events_of_one_that_is_not(tmp_path):
    wearers, files = 25, 10
    rows = deliver(tmp_path / "sent", wearers, files)
    started_at = time.monotonic()
    with Job(tmp_path, "through", "through-checkpoint") as job:
        job.until(1)
        first = time.monotonic()
        batches = job.end()
        seconds = (time.monotonic() - first) / (files - 1)
    print(
        f"\n{wearers} wearers, {rows} rows in {time.monotonic() - started_at:.0f} s with Spark's own start\n{batches}"
    )

    chance = random.Random(time.time_ns())
    for _ in range(2):
        with Job(tmp_path) as job:
            job.until(job.batches() + chance.randint(1, 2))
            time.sleep(chance.uniform(0.0, seconds))
            done = job.batches()
            processes = job.kill()
        print(f"killed {processes} processes after {done} of {files} batches")
        assert processes >= 3 and 1 <= done < files
    with Job(tmp_path) as job:
        job.end()
    events = read_output(job.output)
    written = set(job.output.glob("*.parquet"))
    print(f"{len(events)} events; {len(written) - len(set(committed(job.output)))} files that nobody finished")
    assert events == read_output(tmp_path / "through") == expected(wearers)
