"""The whole demonstration: the same walks through the engine, through sessions without an engine, and with kills."""

from __future__ import annotations

import json
import shutil
from collections.abc import Iterator
from contextlib import closing
from functools import partial
from pathlib import Path
from random import Random
from statistics import mean, median
from time import monotonic
from typing import Any

from attrs import define, field, frozen

from .compare import compare_remarks, differences, files, find_number_gaps, read_events, session_events
from .job import EVENTS
from .kills import Outcome, draw, play_run
from .run import Children, EngineRun, start
from .wearers import DemoPlan, Wearers, prepare

TARGET_SNAPSHOTS = 8
"""Number of snapshots in the time that sessions take without an engine; the engine takes longer."""
MIN_INTERVAL, MAX_INTERVAL = 0.1, 10.0
"""Shortest and longest time between two snapshots, s; bytewax's default is the longest."""
MIN_WEARERS_FOR_MEMORY = 500
"""Smallest number of wearers for a memory per wearer: with fewer, the growth of the engine itself would dominate."""


@frozen
class Engine:
    """The measurements of an uninterrupted run.

    `total_duration` includes the start of the processes; `seconds` is the time from the first bundle to the end, s.
    `snapshot_interval` is in s. `snapshots` is the number of snapshots without the one at the end, computed from the
    number of files, since each snapshot closes one file of every partition. `cpu` is the processor time, s. `empty` and
    `full` are the memory of all processes at the first bundle and at the maximum, bytes; None where the system does not
    report it. `events` and `files` are counts."""

    total_duration: float
    seconds: float
    snapshot_interval: float
    snapshots: int
    cpu: float
    empty: int | None
    full: int | None
    events: int
    files: int


@frozen
class Bare:
    """The measurements of sessions without an engine, in the same number of processes.

    `rate` is that of all processes together, samples/s. `cpu` is the processor time, s. `state` and `largest` are the
    mean and the largest size of a wearer's state while no row is held, bytes. `held` is the largest size with held
    rows, bytes; None if no row was held. `snapshot` is the median time to take a state, s."""

    rate: float
    cpu: float
    state: float
    largest: int
    held: int | None
    snapshot: float


@define
class DemoStage:
    """A demonstration in the empty directory `at`.

    Call its methods in this order: `prepare`, `run_sessions`, `uninterrupted`, then `killed`. They raise RunFailed when
    a process ends with an error."""

    at: Path
    plan: DemoPlan
    samples: list[int] = field(factory=list, init=False)
    """Number of samples of the wearers of each process."""
    poisoned: int = field(default=0, init=False)
    """Number of wearers who send random bytes."""
    gapped: int = field(default=0, init=False)
    """Number of wearers who lose rows for ever."""
    engine: Engine | None = field(default=None, init=False)
    sessions: Bare | None = field(default=None, init=False)
    outcomes: list[Outcome] = field(factory=list, init=False)

    def prepare(self) -> None:
        """Emulate the walks."""
        prepare(self.at, self.plan)
        wearers = Wearers.read(self.at)
        self.samples = [wearers.samples(part) for part in range(self.plan.parts)]
        self.poisoned, self.gapped = wearers.poisoned, wearers.gapped

    @property
    def every(self) -> float:
        """Time between two snapshots, s: the planned one, or a share of the duration of `run_sessions`."""
        if self.plan.every is not None:
            return self.plan.every
        if self.sessions is None:
            return MAX_INTERVAL
        return min(max(sum(self.samples) / self.sessions.rate / TARGET_SNAPSHOTS, MIN_INTERVAL), MAX_INTERVAL)

    @property
    def memory(self) -> float | None:
        """Growth of memory per wearer, bytes; None if unknown or with few wearers."""
        engine = self.engine
        if engine is None or engine.full is None or engine.empty is None or self.plan.wearers < MIN_WEARERS_FOR_MEMORY:
            return None
        return (engine.full - engine.empty) / self.plan.wearers

    @property
    def events(self) -> Path:
        """Directory with the events of the uninterrupted run."""
        return self.at / "uninterrupted" / EVENTS

    def uninterrupted(self) -> Engine:
        """Run the job from its start to its end."""
        t_start = monotonic()
        run = EngineRun.create(self.events.parent, self.plan.parts, self.every)
        with closing(run):
            run.start()
            reports = run.finish()
        duration = monotonic() - t_start
        seconds = max(r["ended"] for r in reports) - min(r["started"] for r in reports if r["started"] is not None)
        self.engine = Engine(
            total_duration=duration,
            seconds=seconds,
            snapshot_interval=self.every,
            snapshots=max(len(files(self.events)) // self.plan.parts - 1, 0),
            cpu=sum(report["cpu"] for report in reports),
            empty=_sum(reports, "empty"),
            full=_sum(reports, "full"),
            events=len(read_events(self.events)),
            files=len(files(self.events)),
        )
        return self.engine

    def run_sessions(self) -> Bare:
        """Run the same walks through sessions without an engine."""
        directory = self.at / "sessions"
        directory.mkdir()
        parts, log = range(self.plan.parts), directory / "log"
        with Children() as children:
            for part in parts:
                module = "solepath.fleet.demo.bare"
                children.running.append(start(module, str(directory), str(part), directory=directory, log=log))
            while not children.ended(1.0):
                pass
            children.check("the run without an engine", log)
        results = [json.loads((directory / f"bare-{part}.json").read_text(encoding="utf-8")) for part in parts]
        states = [state for result in results for state in result["states"]]
        snapshot_time = median(seconds for _, _, seconds in states)
        sizes = [size for size, held_rows, _ in states if not held_rows]
        held_sizes = [size for size, held_rows, _ in states if held_rows]
        rate = sum(samples / result["seconds"] for samples, result in zip(self.samples, results, strict=True))
        cpu = sum(result["cpu"] for result in results)
        self.sessions = Bare(rate, cpu, mean(sizes), max(sizes), max(held_sizes, default=None), snapshot_time)
        return self.sessions

    def compare(self) -> list[str]:
        """Return the differences of the uninterrupted run from the sessions and from the expected remarks."""
        engine, sessions = read_events(self.events), read_events(self.at / "sessions" / EVENTS)
        expected = {wearer.name: wearer.remarks() for wearer in Wearers.read(self.at).all}
        return [
            *differences(sessions, session_events(engine)),
            *compare_remarks(expected, engine),
            *find_number_gaps(engine),
        ]

    def killed(self, kills: int, *, keep: bool) -> Iterator[Outcome]:
        """Run jobs with this number of kills and restarts, and yield the comparison of each with the uninterrupted run.

        `keep` leaves the files of the runs."""
        engine = self.engine or self.uninterrupted()
        expected = read_events(self.events)
        start_duration = engine.total_duration - engine.seconds
        planned = draw(kills, start_duration, engine.seconds, self.plan.parts, Random(f"kills {self.plan.seed}"))
        for number, run_kills in enumerate(planned, 1):
            directory = self.at / f"killed-{number}"
            outcome = play_run(partial(EngineRun.create, directory, self.plan.parts, self.every), run_kills, expected)
            self.outcomes.append(outcome)
            if not keep:
                shutil.rmtree(directory)
            yield outcome


def _sum(reports: list[dict[str, Any]], key: str) -> int | None:
    values = [report[key] for report in reports]
    return None if None in values else sum(values)
