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

from .compare import differences, files, holes, of_sessions, read_told
from .kills import Outcome, draw, play
from .run import Children, Run, start
from .wearers import Plan, Wearers, prepare


@frozen
class Engine:
    """An uninterrupted run. `whole`: s with the start of its processes; `seconds`: s from the first bundle to the end;
    `cpu`: s of the processors meanwhile; `empty`, `full`: memory of all processes before the first bundle and at its
    most, bytes, None where the system does not say; `events`; `files`."""

    whole: float
    seconds: float
    cpu: float
    empty: int | None
    full: int | None
    events: int
    files: int


@frozen
class Bare:
    """Sessions alone, in as many processes. `rate`: samples/s of all together; `cpu`: s of the processors. `state`,
    `largest`: bytes of the state of a wearer in the engine, the mean and the most, with what waits there for what is
    late; `session`: the most without that; `snapshot`: s that it takes, the median."""

    rate: float
    cpu: float
    state: float
    largest: int
    session: int
    snapshot: float


@define
class Stage:
    """`at`: an empty directory. Used in this order: `prepare`, `uninterrupted`, `bare`, then `killed`. RunFailed when a
    process ends as it should not have."""

    at: Path
    plan: Plan
    samples: list[int] = field(factory=list, init=False)
    """Of the wearers of each process."""
    poisoned: int = field(default=0, init=False)
    """Wearers who send any bytes."""
    engine: Engine | None = field(default=None, init=False)
    sessions: Bare | None = field(default=None, init=False)
    outcomes: list[Outcome] = field(factory=list, init=False)

    def prepare(self) -> None:
        """Emulate the walks."""
        prepare(self.at, self.plan)
        wearers = Wearers.read(self.at)
        self.samples = [wearers.samples(part) for part in range(self.plan.parts)]
        self.poisoned = wearers.poisoned

    @property
    def told(self) -> Path:
        """The events of the uninterrupted run."""
        return self.at / "uninterrupted" / "told"

    def uninterrupted(self) -> Engine:
        """The job from its start to its end."""
        began = monotonic()
        run = Run.begin(self.told.parent, self.plan.parts, self.plan.every)
        with closing(run):
            run.start()
            reports = run.finish()
        whole = monotonic() - began
        seconds = max(r["ended"] for r in reports) - min(r["began"] for r in reports if r["began"] is not None)
        self.engine = Engine(
            whole=whole,
            seconds=seconds,
            cpu=sum(r["cpu"] for r in reports),
            empty=_sum(reports, "empty"),
            full=_sum(reports, "full"),
            events=len(read_told(self.told)),
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
        sizes, alone, taken = zip(*(state for one in found for state in one["states"]), strict=True)
        rate = sum(samples / one["seconds"] for samples, one in zip(self.samples, found, strict=True))
        self.sessions = Bare(rate, sum(one["cpu"] for one in found), mean(sizes), max(sizes), max(alone), median(taken))
        return self.sessions

    def compare(self) -> list[str]:
        """How the uninterrupted run differs from the sessions alone: a sentence each."""
        engine, sessions = read_told(self.told), read_told(self.at / "sessions" / "told")
        return [*differences(sessions, of_sessions(engine)), *holes(engine)]

    def killed(self, kills: int, *, keep: bool) -> Iterator[Outcome]:
        """So many kills, each followed by a restart, and each run compared with the uninterrupted one at its end.
        `keep`: leave what the runs wrote."""
        engine = self.engine or self.uninterrupted()
        expected = read_told(self.told)
        planned = draw(kills, engine.whole, self.plan.parts, Random(f"kills {self.plan.seed}"))
        for number, of_run in enumerate(planned, 1):
            home = self.at / f"killed-{number}"
            outcome = play(partial(Run.begin, home, self.plan.parts, self.plan.every), of_run, expected)
            self.outcomes.append(outcome)
            if not keep:
                shutil.rmtree(home)
            yield outcome


def _sum(reports: list[dict[str, Any]], key: str) -> int | None:
    values = [report[key] for report in reports]
    return None if None in values else sum(values)
