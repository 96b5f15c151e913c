"""The whole demonstration: the same walks through the engine, through sessions alone, and through killed engines."""

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
from .kills import Outcome, draw, play
from .run import Children, EngineRun, start
from .wearers import DemoPlan, Wearers, prepare

SNAPSHOTS = 8
"""Number of snapshots in the time that sessions alone take; the engine takes longer."""
OFTEN, RARELY = 0.1, 10.0
"""Shortest and longest time between two snapshots, s; bytewax's default is the longest."""

FEW = 500
"""Smallest number of wearers for a memory figure: with fewer, the engine's own growth would count as theirs."""


@frozen
class Engine:
    """Measurements of an uninterrupted run.

    `whole` is the duration with the start of its processes, `seconds` that from the first bundle to the end, s. `every`
    is the time between two snapshots, s, and `snapshots` their number before the one at the end, counted from the
    files, since each snapshot closes one of every part. `cpu` is the time of the processors, s. `empty` and `full` are
    the memory of all processes at the first bundle and at its most, bytes; None where the system does not report it.
    `events` and `files` are counts."""

    whole: float
    seconds: float
    every: float
    snapshots: int
    cpu: float
    empty: int | None
    full: int | None
    events: int
    files: int


@frozen
class Bare:
    """Measurements of sessions alone, in as many processes.

    `rate` is that of all together, samples/s; `cpu` is the time of the processors, s. `state` and `largest` are the
    mean and the most bytes of a wearer's state in the engine while no row is held; `held` is the most with held rows,
    None if there were none. `snapshot` is the median time to take a state, s."""

    rate: float
    cpu: float
    state: float
    largest: int
    held: int | None
    snapshot: float


@define
class DemoStage:
    """A demonstration in the empty directory `at`.

    Its methods are used in this order: `prepare`, `bare`, `uninterrupted`, then `killed`. Raises RunFailed when a
    process ends with an error."""

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
        """Time between two snapshots, s: as planned, or such that a run has several by the duration of `bare`."""
        if self.plan.every is not None:
            return self.plan.every
        if self.sessions is None:
            return RARELY
        return min(max(sum(self.samples) / self.sessions.rate / SNAPSHOTS, OFTEN), RARELY)

    @property
    def memory(self) -> float | None:
        """Growth of memory per wearer, bytes; None if unknown or for few wearers."""
        engine = self.engine
        if engine is None or engine.full is None or engine.empty is None or self.plan.wearers < FEW:
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
        whole = monotonic() - t_start
        seconds = max(r["ended"] for r in reports) - min(r["started"] for r in reports if r["started"] is not None)
        self.engine = Engine(
            whole=whole,
            seconds=seconds,
            every=self.every,
            snapshots=max(len(files(self.events)) // self.plan.parts - 1, 0),
            cpu=sum(r["cpu"] for r in reports),
            empty=_sum(reports, "empty"),
            full=_sum(reports, "full"),
            events=len(read_events(self.events)),
            files=len(files(self.events)),
        )
        return self.engine

    def bare(self) -> Bare:
        """Run the same walks through sessions alone."""
        home = self.at / "sessions"
        home.mkdir()
        parts, log = range(self.plan.parts), home / "log"
        with Children() as children:
            for part in parts:
                module = "solepath.fleet.demo.bare"
                children.running.append(start(module, str(home), str(part), home=home, log=log))
            while not children.ended(1.0):
                pass
            children.check("the sessions alone", log)
        found = [json.loads((home / f"bare-{part}.json").read_text(encoding="utf-8")) for part in parts]
        states = [state for one in found for state in one["states"]]
        taken = median(seconds for _, _, seconds in states)
        free, held = ([size for size, waits, _ in states if bool(waits) is holds] for holds in (False, True))
        rate = sum(samples / one["seconds"] for samples, one in zip(self.samples, found, strict=True))
        cpu = sum(one["cpu"] for one in found)
        self.sessions = Bare(rate, cpu, mean(free), max(free), max(held, default=None), taken)
        return self.sessions

    def compare(self) -> list[str]:
        """Return the differences of the uninterrupted run from the sessions and the expected remarks."""
        engine, sessions = read_events(self.events), read_events(self.at / "sessions" / EVENTS)
        expected = {wearer.name: wearer.remarks() for wearer in Wearers.read(self.at).all}
        return [
            *differences(sessions, session_events(engine)),
            *compare_remarks(expected, engine),
            *find_number_gaps(engine),
        ]

    def killed(self, kills: int, *, keep: bool) -> Iterator[Outcome]:
        """Run jobs with so many kills and restarts, and compare each with the uninterrupted one at its end.

        `keep` leaves the files of the runs."""
        engine = self.engine or self.uninterrupted()
        expected = read_events(self.events)
        starting = engine.whole - engine.seconds
        planned = draw(kills, starting, engine.seconds, self.plan.parts, Random(f"kills {self.plan.seed}"))
        for number, of_run in enumerate(planned, 1):
            home = self.at / f"killed-{number}"
            outcome = play(partial(EngineRun.create, home, self.plan.parts, self.every), of_run, expected)
            self.outcomes.append(outcome)
            if not keep:
                shutil.rmtree(home)
            yield outcome


def _sum(reports: list[dict[str, Any]], key: str) -> int | None:
    values = [report[key] for report in reports]
    return None if None in values else sum(values)
