"""Times at which the job is killed, and the cost of each kill."""

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

from .compare import UnreadableEvents, differences, read_events
from .run import LOOK, EngineRun

STARTING = 5
"""One kill in this many hits the start of a run, or the recovery from the kill before; all others hit reading."""
READ = (0.3, 0.95)
"""Range of the share of bundles read at which the other kills come.

By then there is a snapshot to go back to; the engine goes back to the last but one."""
LATER = 0.1
"""Largest random delay of a kill, as a share of the time of reading.

The delay keeps the kills from always hitting the start of a bundle."""
SOONER = 0.6
"""Factor on the time of a kill that came after the end and is tried again."""


@frozen
class Kill:
    """A planned kill.

    `after` is the time in s after the `share` of the bundles was read or, if that is None, after the start or restart
    of the job. `which` is the process that is killed; None kills all at once, as in a power failure."""

    share: float | None
    after: float
    which: int | None = None


@frozen
class KillMark:
    """A kill that was done.

    `when` is its time on the system's clock, s. `started` says that the job had started to read. `reached` is the
    number of bundles of each partition that were read by then. `reopened` is the number of wearers who had gone on from
    their states."""

    kill: Kill
    when: float
    started: bool
    reached: dict[int, int]
    reopened: int


@frozen
class Cost:
    """Circumstances and cost of a kill.

    `started` says that the job had started to read, or to read again. `reached` is the share of the bundles that were
    read by then. `replayed` is the share that was read again, and `down` the time until the job read again, s; both are
    None for a kill that was followed by another before that. `reopened` is the number of wearers who went on from their
    states."""

    kill: Kill
    started: bool
    reached: float
    replayed: float | None
    down: float | None
    reopened: int

    @property
    def had_effect(self) -> bool:
        """True if something had to be repeated or restored: bundles read again, or a state reopened."""
        return bool(self.replayed or self.reopened)


@frozen
class Outcome:
    """A run that was killed once or more, and went to its end.

    `differences` are those from the uninterrupted run, a sentence each; empty for the same events, each as often."""

    costs: list[Cost]
    differences: list[str]


def draw(kills: int, starting: float, reading: float, processes: int, rng: Random) -> list[list[Kill]]:
    """Return the kills of each run.

    `starting` and `reading` are the durations of a run until it reads and from then on, s. Most kills come at a random
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


def play(create_run: Callable[[], EngineRun], kills: list[Kill], expected: pa.Table) -> Outcome:
    """Run a job from its start to its end with kills and restarts, and compare its events with `expected`.

    A run that ended before a kill came is started again, and killed sooner. Raises RunFailed."""
    while True:
        run, marks = create_run(), list[KillMark]()
        with closing(run):
            if _kill_and_restart(run, kills, marks):
                run.finish()
                return Outcome(_costs(marks, run.starts(), run.reopened()), compared(expected, run.events))
        late = kills[len(marks)]
        share = None if late.share is None else late.share * SOONER
        sooner = evolve(late, share=share, after=late.after * SOONER)
        kills = [*kills[: len(marks)], sooner, *kills[len(marks) + 1 :]]
        shutil.rmtree(run.home)


def compared(expected: pa.Table, events: Path) -> list[str]:
    """Return the differences of the events in a directory from the expected ones, a sentence each."""
    try:
        return differences(expected, read_events(events))
    except UnreadableEvents as torn:
        return [str(torn)]


def _kill_and_restart(run: EngineRun, kills: list[Kill], marks: list[KillMark]) -> bool:
    """Kill and restart the job; return False when it came to its end before."""
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
        marks.append(KillMark(kill, moment, len(run.starts()) > known, run.reached(), run.reopened()))
        known = len(run.starts())
        run.start()
    return True


def _costs(marks: list[KillMark], starts: list[dict[str, Any]], reopened: int) -> list[Cost]:
    found = []
    until = [*((mark.when, mark.reopened) for mark in marks[1:]), (inf, reopened)]
    for mark, (end, by_then) in zip(marks, until, strict=True):
        size = sum({one["part"]: one["end"] for one in starts}.values())
        again = {one["part"]: one for one in starts if mark.when < one["time"] < end}
        whole = again.keys() >= mark.reached.keys() and bool(again)
        replayed = sum(reached - again[part]["at"] for part, reached in mark.reached.items()) if whole else 0
        down = max(one["time"] for one in again.values()) - mark.when if whole else None
        share = sum(mark.reached.values()) / size
        went_on = by_then - mark.reopened
        found.append(Cost(mark.kill, mark.started, share, replayed / size if whole else None, down, went_on))
    return found
