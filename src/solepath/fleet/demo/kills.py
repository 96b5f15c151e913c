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
from .run import CHECK_INTERVAL, EngineRun

START_KILL_INTERVAL = 5
"""One kill in this many comes at the start of a run or during the recovery from a kill; the others come at reading."""
READ_SHARES = (0.3, 0.95)
"""Range of the share of bundles that were read before a kill at reading.

By then there is a snapshot to go back to; the engine goes back to the last but one."""
MAX_DELAY_SHARE = 0.1
"""Largest random delay of a kill, as a share of the time of reading.

The delay keeps the kills from always hitting the start of a bundle."""
RETRY_FACTOR = 0.6
"""Factor on the time of a kill that is tried again, since the run ended before it."""


@frozen
class Kill:
    """A planned kill.

    `after` is the time after the `share` of the bundles was read, s; if `share` is None, the time after the start or
    restart of the job. `which` is the index of the process that is killed; None kills all at once, as a power failure.
    """

    share: float | None
    after: float
    which: int | None = None


@frozen
class KillMark:
    """A kill that was carried out.

    `when` is its time, s, system's clock. `started` is True if the job had started to read. `reached` is the number of
    bundles of each partition that were read by then. `reopened` is the number of wearers who had continued from their
    states."""

    kill: Kill
    when: float
    started: bool
    reached: dict[int, int]
    reopened: int


@frozen
class Cost:
    """The circumstances and the cost of a kill.

    `started` is True if the job had started to read, or to read again. `reached` is the share of the bundles that were
    read by then. `replayed` is the share that was read again, and `down` the time until the job read again, s; both are
    None if another kill came before. `reopened` is the number of wearers who continued from their states."""

    kill: Kill
    started: bool
    reached: float
    replayed: float | None
    down: float | None
    reopened: int

    @property
    def had_effect(self) -> bool:
        """True if bundles had to be read again or a state was reopened."""
        return bool(self.replayed or self.reopened)


@frozen
class Outcome:
    """The result of a run that was killed once or more and then ended.

    `differences` are those from the events of the uninterrupted run, a sentence each; empty for equal events."""

    costs: list[Cost]
    differences: list[str]


def draw(kills: int, starting: float, reading: float, processes: int, rng: Random) -> list[list[Kill]]:
    """Return the kills of each run.

    `starting` is the duration of a run until it reads, `reading` the rest of it, s. Most kills come at a random
    moment of reading, each in a separate run."""
    runs: list[list[Kill]] = []
    for number in range(1, kills + 1):
        process = None if processes == 1 or rng.random() < 0.5 else rng.randrange(processes)
        if number % START_KILL_INTERVAL:
            runs.append([Kill(rng.uniform(*READ_SHARES), rng.uniform(0.0, MAX_DELAY_SHARE * reading), process)])
            continue
        kill = Kill(None, rng.uniform(0.0, starting + MAX_DELAY_SHARE * reading), process)
        if rng.random() < 0.5:
            runs[-1].append(kill)
        else:
            runs.append([kill])
    return runs


def play_run(create_run: Callable[[], EngineRun], kills: list[Kill], expected: pa.Table) -> Outcome:
    """Run a job from its start to its end with kills and restarts, and compare its events with `expected`.

    A run that ended before a kill is started again and killed earlier. Raises RunFailed."""
    while True:
        run, marks = create_run(), list[KillMark]()
        with closing(run):
            if _kill_and_restart(run, kills, marks):
                run.finish()
                costs = _compute_costs(marks, run.starts(), run.reopened())
                return Outcome(costs, find_event_differences(expected, run.events))
        late_kill = kills[len(marks)]
        share = None if late_kill.share is None else late_kill.share * RETRY_FACTOR
        earlier = evolve(late_kill, share=share, after=late_kill.after * RETRY_FACTOR)
        kills = [*kills[: len(marks)], earlier, *kills[len(marks) + 1 :]]
        shutil.rmtree(run.directory)


def find_event_differences(expected: pa.Table, events: Path) -> list[str]:
    """Return the differences of the events in a directory from the expected ones, a sentence each."""
    try:
        return differences(expected, read_events(events))
    except UnreadableEvents as error:
        return [str(error)]


def _kill_and_restart(run: EngineRun, kills: list[Kill], marks: list[KillMark]) -> bool:
    """Kill and restart the job; return False when the job ended before a kill."""
    starts_before = 0
    run.start()
    for kill in kills:
        while kill.share is not None and run.share() < kill.share:
            if run.ended(CHECK_INTERVAL):
                return False
        if run.ended(kill.after):
            return False
        t_kill = time()
        run.kill(kill.which)
        marks.append(KillMark(kill, t_kill, len(run.starts()) > starts_before, run.reached(), run.reopened()))
        starts_before = len(run.starts())
        run.start()
    return True


def _compute_costs(marks: list[KillMark], starts: list[dict[str, Any]], reopened: int) -> list[Cost]:
    costs = []
    ends = [*((mark.when, mark.reopened) for mark in marks[1:]), (inf, reopened)]
    for mark, (end, reopened_by_end) in zip(marks, ends, strict=True):
        size = sum({start["part"]: start["end"] for start in starts}.values())
        restarts = {start["part"]: start for start in starts if mark.when < start["time"] < end}
        is_complete = restarts.keys() >= mark.reached.keys() and bool(restarts)
        replayed = sum(reached - restarts[part]["at"] for part, reached in mark.reached.items()) if is_complete else 0
        down = max(start["time"] for start in restarts.values()) - mark.when if is_complete else None
        share, replayed_share = sum(mark.reached.values()) / size, replayed / size if is_complete else None
        reopened_since = reopened_by_end - mark.reopened
        costs.append(Cost(mark.kill, mark.started, share, replayed_share, down, reopened_since))
    return costs
