"""The demonstration as a whole: a stage on which the same walks go through the engine, through sessions alone, and
through an engine that is killed."""

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

from .compare import differences, files, holes, of_sessions, read_events, remarked
from .kills import Outcome, draw, play
from .run import Children, EngineRun, start
from .wearers import DemoPlan, Wearers, prepare

SNAPSHOTS = 8
"""Snapshots in the time that sessions alone take; the engine takes longer."""
OFTEN, RARELY = 0.1, 10.0
"""s between two snapshots, at the least and the most. bytewax's own is the most."""

FEW = 500
"""Among fewer wearers than that, memory that the engine itself takes on the way would count as theirs."""


@frozen
class Engine:
    """An uninterrupted run. `whole`: s with the start of its processes; `seconds`: s from the first bundle to the end;
    `every`: s between two snapshots, of which `snapshots` came before the one at the end, as the files tell, since each
    closes one of every part; `cpu`: s of the processors; `empty`, `full`: memory of all processes at the first
    bundle and at its most, bytes, None where the system does not say; `events`; `files`."""

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
    """Sessions alone, in as many processes. `rate`: samples/s of all together; `cpu`: s of the processors. `state`,
    `largest`: bytes of the state of a wearer in the engine while nothing is held behind a missing row, the mean and the
    most; `held`: the most with rows that are held, None where none ever were; `snapshot`: s that it takes, the
    median."""

    rate: float
    cpu: float
    state: float
    largest: int
    held: int | None
    snapshot: float


@define
class DemoStage:
    """`at`: an empty directory. Used in this order: `prepare`, `bare`, `uninterrupted`, then `killed`. RunFailed when a
    process ends as it should not have."""

    at: Path
    plan: DemoPlan
    samples: list[int] = field(factory=list, init=False)
    """Of the wearers of each process."""
    poisoned: int = field(default=0, init=False)
    """Wearers who send any bytes."""
    gapped: int = field(default=0, init=False)
    """Wearers who lose something for good."""
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
        """s between two snapshots: as planned, or so many that a run has several, as far as `bare` says how long it
        takes."""
        if self.plan.every is not None:
            return self.plan.every
        if self.sessions is None:
            return RARELY
        return min(max(sum(self.samples) / self.sessions.rate / SNAPSHOTS, OFTEN), RARELY)

    @property
    def memory(self) -> float | None:
        """Bytes a wearer, beyond what the processes held at the first; None where nobody says, or for a few."""
        engine = self.engine
        if engine is None or engine.full is None or engine.empty is None or self.plan.wearers < FEW:
            return None
        return (engine.full - engine.empty) / self.plan.wearers

    @property
    def told(self) -> Path:
        """The events of the uninterrupted run."""
        return self.at / "uninterrupted" / "told"

    def uninterrupted(self) -> Engine:
        """The job from its start to its end."""
        began = monotonic()
        run = EngineRun.begin(self.told.parent, self.plan.parts, self.every)
        with closing(run):
            run.start()
            reports = run.finish()
        whole = monotonic() - began
        seconds = max(r["ended"] for r in reports) - min(r["began"] for r in reports if r["began"] is not None)
        self.engine = Engine(
            whole=whole,
            seconds=seconds,
            every=self.every,
            snapshots=max(len(files(self.told)) // self.plan.parts - 1, 0),
            cpu=sum(r["cpu"] for r in reports),
            empty=_sum(reports, "empty"),
            full=_sum(reports, "full"),
            events=len(read_events(self.told)),
            files=len(files(self.told)),
        )
        return self.engine

    def bare(self) -> Bare:
        """The same through sessions alone."""
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
        """How the uninterrupted run differs from the sessions alone, and from what a fleet is to say beside: a sentence
        each."""
        engine, sessions = read_events(self.told), read_events(self.at / "sessions" / "told")
        expected = {wearer.name: wearer.remarks() for wearer in Wearers.read(self.at).all}
        return [*differences(sessions, of_sessions(engine)), *remarked(expected, engine), *holes(engine)]

    def killed(self, kills: int, *, keep: bool) -> Iterator[Outcome]:
        """So many kills, each followed by a restart, and each run compared with the uninterrupted one at its end.
        `keep`: leave what the runs wrote."""
        engine = self.engine or self.uninterrupted()
        expected = read_events(self.told)
        starting = engine.whole - engine.seconds
        planned = draw(kills, starting, engine.seconds, self.plan.parts, Random(f"kills {self.plan.seed}"))
        for number, of_run in enumerate(planned, 1):
            home = self.at / f"killed-{number}"
            outcome = play(partial(EngineRun.begin, home, self.plan.parts, self.every), of_run, expected)
            self.outcomes.append(outcome)
            if not keep:
                shutil.rmtree(home)
            yield outcome


def _sum(reports: list[dict[str, Any]], key: str) -> int | None:
    values = [report[key] for report in reports]
    return None if None in values else sum(values)
