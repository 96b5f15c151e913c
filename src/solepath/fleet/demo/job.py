"""The job of the demonstration, as an engine runs it:

    python -m bytewax.run "solepath.fleet.demo.job:flow('STAGE/RUN')" -r STAGE/RUN/recovery -s 1 -b 0

STAGE was prepared (wearers.py); events go to STAGE/RUN/told, and beside it what the run has to say of itself.
"""

from __future__ import annotations

import atexit
import json
import os
from functools import partial
from pathlib import Path
from struct import Struct
from time import process_time, time
from typing import Any

from attrs import asdict, define
from bytewax import operators
from bytewax.dataflow import Dataflow
from bytewax.inputs import FixedPartitionedSource, StatefulSourcePartition

from .. import Fleet, Sent, Unreadable
from ..bytewax import ParquetSink, gait
from .child import end_with_parent, most_memory, settle
from .wearers import Wearers

TOLD, RECOVERY = "told", "recovery"
"""Directories of a run."""
POSITION = Struct("<q")

Keyed = tuple[str, list[Sent | Unreadable]]


def flow(run: str) -> Dataflow:
    """The dataflow: phones, sessions, files."""
    end_with_parent()
    home = Path(run)
    wearers = Wearers.read(home.parent)
    report = Report()
    atexit.register(partial(report.write, home))
    dataflow = Dataflow("fleet_demo")
    sent: Any = operators.input("phones", dataflow, Phones(wearers, home, report))
    fleet = Fleet(wearers.recipe)
    told = gait("gait", sent, fleet)
    operators.output("files", told, ParquetSink(home / TOLD, wearers.plan.parts))
    _warm(fleet, wearers)
    settle()
    return dataflow


def _warm(fleet: Fleet, wearers: Wearers) -> None:
    """What the first packets, the first state and the first restart make once for all is no wearer's."""
    first, state = wearers.all[0], None
    for number in range(wearers.bundles):
        state, _ = fleet.step(first.name, state, first.bundle(number))


@define
class Report:
    """What one process of a run used. `began`, `ended`: s of the system's clock at the first bundle and at the end of
    the work; `cpu`: s from the one to the other; `empty`, `full`: most memory until the first, and until the second."""

    began: float | None = None
    ended: float | None = None
    cpu: float = 0.0
    empty: int | None = None
    full: int | None = None

    def begin(self) -> None:
        if self.began is None:
            self.began, self.cpu, self.empty = time(), -process_time(), most_memory()

    def write(self, home: Path) -> None:
        """At the end of the process: by then the engine has done all that was to do."""
        self.cpu += process_time()
        self.ended, self.full = time(), most_memory()
        (home / f"report-{os.getpid()}.json").write_text(json.dumps(asdict(self)), encoding="utf-8")


class Phones(FixedPartitionedSource[Keyed, int]):
    """Bundles of all wearers as fast as they are asked for: the first of each, then the second. They can be read again
    from any place."""

    def __init__(self, wearers: Wearers, home: Path, report: Report) -> None:
        self._wearers, self._home, self._report = wearers, home, report

    def list_parts(self) -> list[str]:
        return [str(part) for part in range(self._wearers.plan.parts)]

    def build_part(self, step_id: str, for_part: str, resume_state: int | None) -> Part:
        return Part(self._wearers, int(for_part), resume_state or 0, self._home, self._report)


class Part(StatefulSourcePartition[Keyed, int]):
    """Its state is how many bundles were read."""

    def __init__(self, wearers: Wearers, part: int, at: int, home: Path, report: Report) -> None:
        self._wearers, self._report = wearers.of_part(part), report
        self._at, self._end = at, len(self._wearers) * wearers.bundles
        began = {"part": part, "at": at, "end": self._end, "time": time()}
        with (home / "began.jsonl").open("a", encoding="utf-8") as file:
            file.write(json.dumps(began) + "\n")
        self._reached = os.open(home / f"reached-{part}", os.O_WRONLY | os.O_CREAT)

    def next_batch(self) -> list[Keyed]:
        self._report.begin()
        at = self._at
        if at >= self._end:
            raise StopIteration
        number, who = divmod(at, len(self._wearers))
        wearer = self._wearers[who]
        self._at = at + 1
        os.lseek(self._reached, 0, os.SEEK_SET)
        os.write(self._reached, POSITION.pack(at + 1))  # for whoever kills this, and wants to know what that cost
        bundle = wearer.bundle(number)
        return [(wearer.name, bundle)] if bundle else []

    def snapshot(self) -> int:
        return self._at

    def close(self) -> None:
        os.close(self._reached)
