"""When the job is killed, and what each kill cost."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from contextlib import closing
from math import inf
from pathlib import Path
from random import Random
from time import time
from typing import Any

import pyarrow as pa
from attrs import evolve, frozen

from .compare import Torn, differences, read_events
from .run import LOOK, EngineRun

STARTING = 5
"""One kill in so many hits the start of a run, or the recovery from the kill before; all others hit reading."""
READ = (0.3, 0.95)
"""Shares of a run's bundles between which the others come, when there is a snapshot to go back to: the engine goes
back to the last but one,"""
LATER = 0.1
"""and up to this share of the time of reading later, so that they do not all hit the beginning of a bundle."""
SOONER = 0.6
"""A kill that came after the end is tried anew, so much sooner."""


@frozen
class Kill:
    """`after`: s from the moment when the `share` of the bundles was read, or from the start, or restart, of the job
    where that is None. `which`: the process that is killed; None for all at once, as when the power fails."""

    share: float | None
    after: float
    which: int | None = None


@frozen
class KillMark:
    """A kill that was done. `when`: s of the system's clock. `started`: the job had begun to read. `reached`: bundles
    of each partition that were read by then. `reopened`: wearers who had gone on from their states by then."""

    kill: Kill
    when: float
    started: bool
    reached: dict[int, int]
    reopened: int


@frozen
class Cost:
    """What a kill met and cost. `started`: the job had begun to read, or to read again. `reached`: share of the bundles
    that were read by then. `replayed`: share of them that were read again, `down`: s until the job read again; both
    None for a kill that was followed by another before the job did. `reopened`: wearers who went on from their states
    after it."""

    kill: Kill
    started: bool
    reached: float
    replayed: float | None
    down: float | None
    reopened: int

    @property
    def told(self) -> bool:
        """Something had to be made good: read again, or gone on with from a state."""
        return bool(self.replayed or self.reopened)


@frozen
class Outcome:
    """A run that was killed once or more, and went to its end. `differences`: from the uninterrupted run, a sentence
    each; [] when it told the same events, each as often."""

    costs: list[Cost]
    differences: list[str]


def draw(kills: int, starting: float, reading: float, processes: int, rng: Random) -> list[list[Kill]]:
    """Kills of each run. `starting`, `reading`: s of a run until it reads, and from then on. Most come at a random
    moment of reading, and each of these has a run of its own."""
    found: list[list[Kill]] = []
    for number in range(1, kills + 1):
        which = None if processes == 1 or rng.random() < 0.5 else rng.randrange(processes)
        if number % STARTING:
            found.append([Kill(rng.uniform(*READ), rng.uniform(0.0, LATER * reading), which)])
            continue
        kill = Kill(None, rng.uniform(0.0, starting + LATER * reading), which)
        if rng.random() < 0.5:
            found[-1].append(kill)
        else:
            found.append([kill])
    return found


def play(begin: Callable[[], EngineRun], kills: list[Kill], expected: pa.Table) -> Outcome:
    """A run from its start, killed and restarted, to its end, and what it told beside what was `expected`. RunFailed.
    A run that was over before a kill came is begun anew, and killed sooner."""
    while True:
        run, marks = begin(), list[KillMark]()
        with closing(run):
            if _killed(run, kills, marks):
                run.finish()
                return Outcome(_costs(marks, run.began(), run.reopened()), compared(expected, run.told))
        late = kills[len(marks)]
        share = None if late.share is None else late.share * SOONER
        sooner = evolve(late, share=share, after=late.after * SOONER)
        kills = [*kills[: len(marks)], sooner, *kills[len(marks) + 1 :]]
        shutil.rmtree(run.home)


def compared(expected: pa.Table, told: Path) -> list[str]:
    """How the events in a directory differ from those that were expected: a sentence each."""
    try:
        return differences(expected, read_events(told))
    except Torn as torn:
        return [str(torn)]


def _killed(run: EngineRun, kills: list[Kill], marks: list[KillMark]) -> bool:
    """Kill and restart; False when the job came to its end before."""
    known = 0
    run.start()
    for kill in kills:
        while kill.share is not None and run.share() < kill.share:
            if run.ended(LOOK):
                return False
        if run.ended(kill.after):
            return False
        moment = time()
        run.kill(kill.which)
        marks.append(KillMark(kill, moment, len(run.began()) > known, run.reached(), run.reopened()))
        known = len(run.began())
        run.start()
    return True


def _costs(marks: list[KillMark], began: list[dict[str, Any]], reopened: int) -> list[Cost]:
    found = []
    until = [*((mark.when, mark.reopened) for mark in marks[1:]), (inf, reopened)]
    for mark, (end, by_then) in zip(marks, until, strict=True):
        size = sum({one["part"]: one["end"] for one in began}.values())
        again = {one["part"]: one for one in began if mark.when < one["time"] < end}
        whole = again.keys() >= mark.reached.keys() and bool(again)
        replayed = sum(reached - again[part]["at"] for part, reached in mark.reached.items()) if whole else 0
        down = max(one["time"] for one in again.values()) - mark.when if whole else None
        share = sum(mark.reached.values()) / size
        went_on = by_then - mark.reopened
        found.append(Cost(mark.kill, mark.started, share, replayed / size if whole else None, down, went_on))
    return found
