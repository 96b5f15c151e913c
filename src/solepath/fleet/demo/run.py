"""One run of the demonstration's job: its processes, its directory and its result."""

from __future__ import annotations

import json
import os
import socket
import subprocess
import sys
from contextlib import ExitStack, suppress
from pathlib import Path
from time import monotonic, sleep
from typing import Any

from attrs import define, field
from bytewax.recovery import init_db_dir

from ...recording import printable
from .job import EVENTS, POSITION_FORMAT, RECOVERY, REOPENED_PREFIX

CHECK_INTERVAL = 0.005
"""Interval between two checks for the end of a process, s."""
END_TIMEOUT = 3.0
"""Time that the processes of a job have to end after one of them was killed, s; then they are killed too."""


class RunFailed(Exception):
    """Raised with one sentence when a process of a run ended with an error."""


def start(module: str, *arguments: str, directory: Path, log: Path) -> subprocess.Popen[bytes]:
    """Start a Python process that ends when this one ends; it does not receive Ctrl-C."""
    package = Path(__file__).parents[3]
    path = os.pathsep.join([str(package), *filter(None, [os.environ.get("PYTHONPATH")])])
    with log.open("ab") as out:
        return subprocess.Popen(
            [sys.executable, "-m", module, *arguments],
            stdin=subprocess.PIPE,
            stdout=out,
            stderr=subprocess.STDOUT,
            cwd=directory,
            env={**os.environ, "PYTHONPATH": path},
            start_new_session=True,
        )


@define
class Children:
    """The processes that are killed at the end of `with Children() as children`."""

    running: list[subprocess.Popen[bytes]] = field(factory=list)

    def __enter__(self) -> Children:
        return self

    def __exit__(self, *error: object) -> None:
        self.kill()

    def ended(self, patience: float) -> bool:
        """Return whether all ended within `patience` s or one failed, since the others might wait for it for ever."""
        limit = monotonic() + patience
        while True:
            statuses = [child.poll() for child in self.running]
            if None not in statuses or any(statuses):
                return True
            if monotonic() > limit:
                return False
            sleep(CHECK_INTERVAL)

    def is_running(self) -> bool:
        """Return whether at least one still runs."""
        return any(child.poll() is None for child in self.running)

    def kill(self, which: int | None = None) -> None:
        """Kill the process number `which`, or all if None, as `kill -9` does."""
        killed = self.running if which is None else [self.running[which]]
        for child in killed:
            child.kill()
        for child in killed:
            child.wait()
            if child.stdin is not None:
                with suppress(OSError):
                    child.stdin.close()

    def check(self, what: str, log: Path) -> None:
        """Raise RunFailed, with the last line of the log, when a process ended with an error."""
        for child in self.running:
            if child.returncode:
                lines = log.read_text(encoding="utf-8", errors="replace").strip().splitlines() or ["it said nothing"]
                raise RunFailed(f"{what} ended with status {child.returncode}: {printable(lines[-1])}")


@define
class EngineRun:
    """A run of the engine in a `directory` of a stage; `every` is the time between two snapshots, s."""

    directory: Path
    processes: int
    every: float
    children: Children = field(factory=Children)

    @classmethod
    def create(cls, directory: Path, processes: int, every: float) -> EngineRun:
        """Return a new run with empty directories."""
        (directory / RECOVERY).mkdir(parents=True)
        init_db_dir(directory / RECOVERY, processes)  # type: ignore[no-untyped-call]
        return cls(directory, processes, every)

    @property
    def events(self) -> Path:
        """Directory of the events."""
        return self.directory / EVENTS

    def start(self) -> None:
        """Start the job, or continue it from its last snapshot."""
        job = ("solepath.fleet.demo.job", str(self.directory), str(self.every))
        self.children = Children()
        for arguments in _process_arguments(self.processes):
            child = start(*job, *arguments, directory=self.directory, log=self.directory / "log")
            self.children.running.append(child)

    def finish(self) -> list[dict[str, Any]]:
        """Wait for the end and return each process's report (job.ProcessReport). Raises RunFailed."""
        while not self.ended(END_TIMEOUT):
            pass
        self.children.kill()
        reports = [self.directory / f"report-{child.pid}.json" for child in self.children.running]
        return [json.loads(report.read_text(encoding="utf-8")) for report in reports]

    def ended(self, patience: float) -> bool:
        """Return whether the job ended within `patience` s. Raises RunFailed if it failed."""
        if not self.children.ended(patience):
            return False
        self.children.check("the job", self.directory / "log")
        return True

    def kill(self, which: int | None) -> None:
        """Kill one process, or all if None; those that have not ended after END_TIMEOUT are killed too."""
        self.children.kill(which)
        limit = monotonic() + END_TIMEOUT
        while self.children.is_running() and monotonic() < limit:
            sleep(CHECK_INTERVAL)
        self.children.kill()

    def close(self) -> None:
        """Kill every process that still runs."""
        self.children.kill()

    def reached(self) -> dict[int, int]:
        """Return the number of bundles read by now, by partition."""
        counts = {}
        for path in self.directory.glob("reached-*"):
            data = path.read_bytes()
            if len(data) == POSITION_FORMAT.size:
                counts[int(path.name.partition("-")[2])] = POSITION_FORMAT.unpack(data)[0]
        return counts

    def share(self) -> float:
        """Return the share of all bundles that were read; 0 before all partitions were opened."""
        ends = {start["part"]: start["end"] for start in self.starts()}
        return sum(self.reached().values()) / sum(ends.values()) if len(ends) == self.processes else 0.0

    def reopened(self) -> int:
        """Return the number of wearers who continued from their states, over all restarts."""
        return sum(path.stat().st_size for path in self.directory.glob(f"{REOPENED_PREFIX}*"))

    def starts(self) -> list[dict[str, Any]]:
        """Return the openings of partitions: `part`, `time`, s, position `at` and position at the `end`, bundles."""
        path = self.directory / "began.jsonl"
        lines = path.read_text(encoding="utf-8").splitlines() if path.exists() else []
        return [json.loads(line) for line in lines if line.endswith("}")]


def _process_arguments(processes: int) -> list[tuple[str, ...]]:
    """Return the arguments of each process of a job: its number and all addresses."""
    if processes == 1:
        return [()]
    addresses = [f"127.0.0.1:{port}" for port in _free_ports(processes)]
    return [(str(number), *addresses) for number in range(processes)]


def _free_ports(count: int) -> list[int]:
    with ExitStack() as stack:
        sockets = [stack.enter_context(socket.socket()) for _ in range(count)]
        for socket_ in sockets:
            socket_.bind(("127.0.0.1", 0))
        return [socket_.getsockname()[1] for socket_ in sockets]
