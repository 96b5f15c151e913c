"""The job of the demonstration, as an engine runs it.

    python -m solepath.fleet.demo.job STAGE/RUN SECONDS [NUMBER ADDRESS ADDRESS ...]

STAGE is a prepared directory (wearers.py), and RUN a directory in it for the events and reports of this run. SECONDS is
the time between two snapshots. ADDRESS is HOST:PORT of each process, if there are several; NUMBER counts them from 0.
This module replaces `python -m bytewax.run`, whose interval between two snapshots (-s) is at least 1 s, too long for a
short run."""

from __future__ import annotations

import atexit
import json
import os
import sys
from datetime import timedelta
from functools import partial
from pathlib import Path
from struct import Struct
from time import process_time, time
from typing import Any

import pyarrow as pa
from attrs import asdict, define
from bytewax import operators
from bytewax.dataflow import Dataflow
from bytewax.inputs import FixedPartitionedSource, StatefulSourcePartition
from bytewax.recovery import RecoveryConfig
from bytewax.run import cli_main

from ...recipes import Recipe
from ..bytewax import ParquetSink, gait
from ..fleet import Fleet
from ..parquet import SCHEMA
from ..rows import event_row
from ..step import keyed
from ..step.sent import Sent, Unreadable
from .child import end_with_parent, freeze_garbage, memory, most_memory
from .wearers import Wearers

EVENTS, RECOVERY = "events", "recovery"
"""Directories of a run."""
REOPENED_PREFIX = "reopened-"
"""Prefix of files, one for each process, with one byte for each wearer who continued from a state."""
POSITION_FORMAT = Struct("<q")
"""Format of the files `reached-*`: the number of bundles that were read from a partition."""

WearerRows = tuple[str, list[Sent | Unreadable]]


def main(run: str, every: float, number: int | None, addresses: list[str]) -> None:
    """Run one process of the engine.

    `every` is the time between two snapshots, s. `number` is the index of this process's address in `addresses`."""
    cli_main(  # type: ignore[no-untyped-call]
        flow(run),
        process_id=number,
        addresses=addresses or None,
        epoch_interval=timedelta(seconds=every),
        recovery_config=RecoveryConfig(Path(run) / RECOVERY, timedelta(0)),  # type: ignore[no-untyped-call]
    )


def flow(run: str) -> Dataflow:
    """Return the dataflow: phones, sessions, files."""
    end_with_parent()
    directory = Path(run)
    wearers = Wearers.read(directory.parent)
    report = ProcessReport()
    atexit.register(partial(report.write, directory))
    dataflow = Dataflow("fleet_demo")
    sent: Any = operators.input("phones", dataflow, Phones(wearers, directory, report))
    fleet = CountedSessions(wearers.recipe, directory)
    events = gait("gait", sent, fleet)
    operators.output("files", events, ParquetSink(directory / EVENTS, wearers.plan.parts))
    _warm(Fleet(wearers.recipe), wearers)
    freeze_garbage()
    return dataflow


def _warm(fleet: Fleet, wearers: Wearers) -> None:
    """Step through the bundles of one wearer, so that the time to load modules is not measured with a wearer."""
    wearer, state, rows = wearers.all[0], None, list[dict[str, Any]]()
    for number in range(wearers.bundles):
        state, events = fleet.step(wearer.name, state, wearer.bundle(number))
        rows += map(event_row, events)
    pa.Table.from_pylist(rows, SCHEMA)  # loads pandas if there is one


class CountedSessions(Fleet):
    """A fleet that writes one byte to a file for each wearer opened from a state; `EngineRun.reopened` counts them."""

    __slots__ = ("_file",)

    def __init__(self, recipe: Recipe, directory: Path) -> None:
        super().__init__(recipe)
        self._file = os.open(directory / f"{REOPENED_PREFIX}{os.getpid()}", os.O_WRONLY | os.O_CREAT | os.O_APPEND)

    def open(self, wearer: str, state: bytes | None) -> keyed.Keyed:
        if state is not None:
            os.write(self._file, b".")
        return super().open(wearer, state)


@define
class ProcessReport:
    """Resources that one process of a run used.

    A bundle is the rows that a phone sends at once. `started` and `ended` are the times of the first bundle and of the
    end of the work, s, system's clock. `cpu` is the processor time between them, s. `empty` is the memory at the first
    bundle and `full` the largest until the end, bytes."""

    started: float | None = None
    ended: float | None = None
    cpu: float = 0.0
    empty: int | None = None
    full: int | None = None

    def note_start(self) -> None:
        """Record the time and the memory at the first call; later calls do nothing."""
        if self.started is None:
            # `write` adds the processor time at the end
            self.started, self.cpu, self.empty = time(), -process_time(), memory()

    def write(self, directory: Path) -> None:
        """Write the report at the end of the process, when the engine has done all its work."""
        self.cpu += process_time()
        self.ended, self.full = time(), most_memory()
        (directory / f"report-{os.getpid()}.json").write_text(json.dumps(asdict(self)), encoding="utf-8")


class Phones(FixedPartitionedSource[WearerRows, int]):
    """A source of the bundles of all wearers at full speed: first the first bundle of every wearer, then the second.

    It can be read again from any position."""

    def __init__(self, wearers: Wearers, directory: Path, report: ProcessReport) -> None:
        self._wearers, self._home, self._report = wearers, directory, report

    def list_parts(self) -> list[str]:
        return [str(part) for part in range(self._wearers.plan.parts)]

    def build_part(self, step_id: str, for_part: str, resume_state: int | None) -> CountingPart:
        return CountingPart(self._wearers, int(for_part), resume_state or 0, self._home, self._report)


class CountingPart(StatefulSourcePartition[WearerRows, int]):
    """A partition of the source; its state is the number of bundles that were read."""

    def __init__(self, wearers: Wearers, part: int, at: int, directory: Path, report: ProcessReport) -> None:
        self._wearers, self._report = wearers.of_partition(part), report
        self._position, self._end_position = at, len(self._wearers) * wearers.bundles
        started = {"part": part, "at": at, "end": self._end_position, "time": time()}
        with (directory / "began.jsonl").open("a", encoding="utf-8") as file:
            file.write(json.dumps(started) + "\n")
        self._position_file = os.open(directory / f"reached-{part}", os.O_WRONLY | os.O_CREAT)

    def next_batch(self) -> list[WearerRows]:
        self._report.note_start()
        position = self._position
        if position >= self._end_position:
            raise StopIteration
        number, index = divmod(position, len(self._wearers))
        wearer = self._wearers[index]
        self._position = position + 1
        os.lseek(self._position_file, 0, os.SEEK_SET)
        # kills.py reads it, to count the bundles that are read again after a kill
        os.write(self._position_file, POSITION_FORMAT.pack(position + 1))
        bundle = wearer.bundle(number)
        return [(wearer.name, bundle)] if bundle else []

    def snapshot(self) -> int:
        return self._position

    def close(self) -> None:
        os.close(self._position_file)


if __name__ == "__main__":
    main(sys.argv[1], float(sys.argv[2]), int(sys.argv[3]) if sys.argv[3:] else None, sys.argv[4:])
