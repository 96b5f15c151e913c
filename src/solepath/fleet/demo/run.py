"""The runs of a demonstration: sessions without an engine, the job uninterrupted, and the job with kills."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from random import Random
from time import monotonic, process_time, time

import pyarrow as pa
from attrs import asdict, define, field, frozen
from pyarrow import parquet

from ...events import Event
from ...recipes import by_name
from ...recording import printable
from ...session import Session
from ..jvm import java_environment
from .compare import Row, compare_sessions, differences, read_events
from .job import CHECKPOINT, EVENTS, PLAN, SENT
from .wearers import DemoPlan, DemoWearer, count_samples, make_wearers

CHECK_INTERVAL = 0.02
"""Interval between two looks at a running job, s."""
JOB = ("-m", "solepath.fleet.demo.job")


class RunFailed(Exception):
    """Raised with one sentence when a job ended with an error."""


@frozen
class Kill:
    """A kill of all processes of a job; `when` is its time, s, system's clock.

    `batches` were finished by then; `is_in_batch` is True if one more had started."""

    when: float
    batches: int
    is_in_batch: bool


@frozen
class EngineRun:
    """A job in a `directory` of a stage: its processes, batches and events."""

    directory: Path
    job: tuple[str, ...] = JOB

    @contextmanager
    def started(self) -> Iterator[subprocess.Popen[bytes]]:
        """Start the job, or continue it from its checkpoint; at the end kill its processes, as `kill -9` does."""
        self.directory.mkdir(exist_ok=True)
        package = str(Path(__file__).parents[3])
        path = os.pathsep.join([package, os.environ.get("PYTHONPATH", "")])
        place = {"PYTHONPATH": path, "PYSPARK_PYTHON": sys.executable, "SPARK_LOCAL_IP": "127.0.0.1"}
        with (
            (self.directory / "log").open("ab") as log,
            subprocess.Popen(
                [sys.executable, *self.job, str(self.directory)],
                stdin=subprocess.PIPE,
                stdout=log,
                stderr=subprocess.STDOUT,
                cwd=self.directory,
                env={**os.environ, **java_environment(), **place},
                start_new_session=True,
            ) as child,
        ):
            try:
                yield child
            finally:
                # Python and Java; the workers of Java end when it has ended
                with suppress(ProcessLookupError):
                    os.killpg(child.pid, signal.SIGKILL)

    def ended(self, child: subprocess.Popen[bytes], patience: float | None) -> bool:
        """Return whether the job ended within `patience` s, or ever. Raises RunFailed if it failed."""
        try:
            status = child.wait(patience)
        except subprocess.TimeoutExpired:
            return False
        if status:
            lines = (self.directory / "log").read_text().splitlines() or [""]
            raise RunFailed(f"the job ended with status {status}: {printable(lines[-1])}")
        return True

    def finish(self) -> None:
        """Start or continue the job and wait for its end. Raises RunFailed."""
        with self.started() as child:
            self.ended(child, None)

    def batch_times(self) -> list[float]:
        """Return the time at which each finished batch ended, s, system's clock."""
        paths = (self.directory / CHECKPOINT / "commits").glob("[0-9]*")
        return [path.stat().st_mtime for path in sorted(paths, key=lambda path: int(path.name))]

    def kill(self, batches: int, delay: float) -> Kill | None:
        """Kill the job `delay` s after so many batches are finished; return None if it ended before."""
        with self.started() as child:
            while len(self.batch_times()) < batches:
                if self.ended(child, CHECK_INTERVAL):
                    return None
            if self.ended(child, delay):
                return None
            started_batches = [*(self.directory / CHECKPOINT / "offsets").glob("[0-9]*")]
            finished = len(self.batch_times())
            return Kill(time(), finished, len(started_batches) > finished)


@define
class DemoStage:
    """A demonstration in the directory `at`: `prepare`, `run_sessions`, `uninterrupted`, then `killed`."""

    at: Path
    plan: DemoPlan
    wearers: list[DemoWearer] = field(factory=list, init=False)
    sessions: dict[str, list[Event]] = field(factory=dict, init=False)
    """Events of sessions without an engine, by wearer."""
    session_seconds: float = field(default=0.0, init=False)
    """Processor time of these sessions, s."""
    whole: float = field(default=0.0, init=False)
    """Duration of the uninterrupted run with the start of its processes, s."""
    times: list[float] = field(factory=list, init=False)
    """Time at which each batch of the uninterrupted run ended, s."""
    events: list[Row] = field(factory=list, init=False)
    """Events of the uninterrupted run."""
    kills: list[tuple[Kill, float]] = field(factory=list, init=False)
    """Each kill, with the time from it to the end of the next batch, s."""

    @property
    def samples(self) -> int:
        """Number of samples that all wearers send."""
        return sum(count_samples(wearer.sending) for wearer in self.wearers)

    @property
    def rate(self) -> float:
        """Samples/s through the job after its first batch, in which Spark still starts."""
        return self.samples / len(self.times) / self.batch if self.batch else 0.0

    @property
    def batch(self) -> float:
        """Mean duration of a batch after the first, s."""
        return (self.times[-1] - self.times[0]) / max(len(self.times) - 1, 1)

    def prepare(self) -> None:
        """Emulate the walks, and write what all wearers send in each second as a file."""
        self.wearers = make_wearers(self.plan)
        (self.at / SENT).mkdir()
        for number in range(max(len(wearer.sending.bundles) for wearer in self.wearers)):
            sent = [(wearer.name, wearer.bundle(number)) for wearer in self.wearers]
            rows = [{"key": name, "value": lines} for name, lines in sent if lines]
            path = self.at / SENT / f"{number:06d}.parquet"
            schema = pa.schema([("key", pa.string()), ("value", pa.binary())])
            parquet.write_table(pa.Table.from_pylist(rows, schema), path)
            os.utime(path, (1.7e9 + number, 1.7e9 + number))  # Spark takes files by the time of their last change
        (self.at / PLAN).write_text(json.dumps(asdict(self.plan)))

    def run_sessions(self) -> None:
        """Run a session for each wearer, without an engine."""
        recipe = by_name(self.plan.recipe)
        for wearer in self.wearers:
            inputs, session, events = wearer.inputs(), Session(recipe), list[Event]()
            started_at = process_time()
            for packet in inputs:
                events += session.feed(packet)
            self.session_seconds += process_time() - started_at
            self.sessions[wearer.name] = events

    def uninterrupted(self) -> list[str]:
        """Run the job without a kill, and return how its events differ from those of sessions. Raises RunFailed."""
        run, started_at = EngineRun(self.at / "uninterrupted"), monotonic()
        run.finish()
        self.whole, self.times = monotonic() - started_at, run.batch_times()
        self.events = read_events(run.directory / EVENTS)
        return compare_sessions(self.wearers, self.sessions, self.events)

    def killed(self, kills: int, job: tuple[str, ...] = JOB) -> list[str]:
        """Run a job with this number of kills and restarts, and return how its events differ from the uninterrupted's.

        A kill comes after a random batch, in the middle of the next, or when the job starts again. Raises RunFailed."""
        rng, run = Random(f"kills {self.plan.seed}"), EngineRun(self.at / "killed", job)
        batches = len(self.times)
        done, marks = 0, list[Kill]()
        for after in sorted(rng.randint(1, max(batches - 2, 1)) for _ in range(kills)):
            starting = self.whole - batches * self.batch if after <= done else 0.0
            kill = run.kill(after, rng.uniform(0.0, starting + self.batch))
            if kill is None:
                break
            marks.append(kill)
            done = kill.batches
        run.finish()
        times = run.batch_times()
        self.kills = [(kill, min(t for t in times if t > kill.when) - kill.when) for kill in marks]
        return differences(self.events, read_events(run.directory / EVENTS))
