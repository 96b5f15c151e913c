"""One run of the demonstration's job: its processes, its directory, and what became of it."""

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
from .job import POSITION, RECOVERY, REOPENED, TOLD

LOOK = 0.005
"""s between two looks whether a process has ended."""
PATIENCE = 3.0
"""s in which the processes of a job end by themselves after one of them was killed; then they are killed too."""


class RunFailed(Exception):
    """A process of a run ended as it should not have: one sentence."""


def start(module: str, *arguments: str, home: Path, log: Path) -> subprocess.Popen[bytes]:
    """A process of Python that ends when this one does. It hears no Ctrl-C: whoever started it ends it."""
    package = Path(__file__).parents[3]
    path = os.pathsep.join([str(package), *filter(None, [os.environ.get("PYTHONPATH")])])
    with log.open("ab") as out:
        return subprocess.Popen(
            [sys.executable, "-m", module, *arguments],
            stdin=subprocess.PIPE,
            stdout=out,
            stderr=subprocess.STDOUT,
            cwd=home,
            env={**os.environ, "PYTHONPATH": path},
            start_new_session=True,
        )


@define
class Children:
    """Processes that end with the block: `with Children() as children`."""

    running: list[subprocess.Popen[bytes]] = field(factory=list)

    def __enter__(self) -> Children:
        return self

    def __exit__(self, *error: object) -> None:
        self.kill()

    def ended(self, patience: float) -> bool:
        """Whether all ended within so many s, or one ended badly: the others might wait for it for ever."""
        limit = monotonic() + patience
        while True:
            statuses = [child.poll() for child in self.running]
            if None not in statuses or any(statuses):
                return True
            if monotonic() > limit:
                return False
            sleep(LOOK)

    def left(self) -> bool:
        """Whether one still runs."""
        return any(child.poll() is None for child in self.running)

    def kill(self, which: int | None = None) -> None:
        """kill -9 of one, or of all."""
        killed = self.running if which is None else [self.running[which]]
        for child in killed:
            child.kill()
        for child in killed:
            child.wait()
            if child.stdin is not None:
                with suppress(OSError):
                    child.stdin.close()

    def check(self, what: str, log: Path) -> None:
        """RunFailed when one of them did not end well; the last line of the log says why."""
        for child in self.running:
            if child.returncode:
                said = log.read_text(encoding="utf-8", errors="replace").strip().splitlines() or ["it said nothing"]
                raise RunFailed(f"{what} ended with status {child.returncode}: {printable(said[-1])}")


@define
class EngineRun:
    """`home`: its directory, on a stage; `processes`: of the engine; `every`: s between two snapshots."""

    home: Path
    processes: int
    every: float
    children: Children = field(factory=Children)

    @classmethod
    def begin(cls, home: Path, processes: int, every: float) -> EngineRun:
        """A run that has read nothing yet."""
        (home / RECOVERY).mkdir(parents=True)
        init_db_dir(home / RECOVERY, processes)  # type: ignore[no-untyped-call]
        return cls(home, processes, every)

    @property
    def told(self) -> Path:
        """Where its events are."""
        return self.home / TOLD

    def start(self) -> None:
        """Begin, or go on where the last snapshot was taken."""
        job = ("solepath.fleet.demo.job", str(self.home), str(self.every))
        self.children = Children()
        for place in _places(self.processes):
            child = start(*job, *place, home=self.home, log=self.home / "log")
            self.children.running.append(child)

    def finish(self) -> list[dict[str, Any]]:
        """Wait for its end; what each process has to report (job.Report). RunFailed."""
        while not self.ended(PATIENCE):
            pass
        self.children.kill()
        reports = [self.home / f"report-{child.pid}.json" for child in self.children.running]
        return [json.loads(report.read_text(encoding="utf-8")) for report in reports]

    def ended(self, patience: float) -> bool:
        """Whether it came to its end within so many s. RunFailed when that was none."""
        if not self.children.ended(patience):
            return False
        self.children.check("the job", self.home / "log")
        return True

    def kill(self, which: int | None) -> None:
        """kill -9 of one process, or all; the others end by themselves, or else likewise."""
        self.children.kill(which)
        limit = monotonic() + PATIENCE
        while self.children.left() and monotonic() < limit:
            sleep(LOOK)
        self.children.kill()

    def close(self) -> None:
        """Nothing of it is left running."""
        self.children.kill()

    def reached(self) -> dict[int, int]:
        """How many bundles were read by now, of each partition that was."""
        found = {}
        for path in self.home.glob("reached-*"):
            data = path.read_bytes()
            if len(data) == POSITION.size:
                found[int(path.name.partition("-")[2])] = POSITION.unpack(data)[0]
        return found

    def share(self) -> float:
        """The same as a share of all; 0 before all partitions were opened."""
        ends = {one["part"]: one["end"] for one in self.began()}
        return sum(self.reached().values()) / sum(ends.values()) if len(ends) == self.processes else 0.0

    def reopened(self) -> int:
        """How many wearers went on from their states by now, after all restarts together."""
        return sum(path.stat().st_size for path in self.home.glob(f"{REOPENED}*"))

    def began(self) -> list[dict[str, Any]]:
        """Each time that a partition was opened: its `part`, where it went on (`at`), its `end`, and when (`time`)."""
        path = self.home / "began.jsonl"
        lines = path.read_text(encoding="utf-8").splitlines() if path.exists() else []
        return [json.loads(line) for line in lines if line.endswith("}")]


def _places(processes: int) -> list[tuple[str, ...]]:
    """What tells each process of a job where the others are."""
    if processes == 1:
        return [()]
    addresses = [f"127.0.0.1:{port}" for port in _free_ports(processes)]
    return [(str(number), *addresses) for number in range(processes)]


def _free_ports(count: int) -> list[int]:
    """Of this machine alone."""
    with ExitStack() as stack:
        sockets = [stack.enter_context(socket.socket()) for _ in range(count)]
        for one in sockets:
            one.bind(("127.0.0.1", 0))
        return [one.getsockname()[1] for one in sockets]
