"""Walks side by side, a process each."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from typing import TypeVar

Job = TypeVar("Job")
Done = TypeVar("Done")

Progress = Callable[[int, int], None]
"""Told (done, all)."""


def each(
    work: Callable[[Job], Done], jobs: Sequence[Job], *, processes: int = 1, progress: Progress | None = None
) -> Iterator[Done]:
    """What `work`, a function of a module, makes of every job, in their order."""
    if processes > 1 and len(jobs) > 1:
        with ProcessPoolExecutor(min(processes, len(jobs))) as pool:
            yield from _counted(pool.map(work, jobs), len(jobs), progress)
    else:
        yield from _counted(map(work, jobs), len(jobs), progress)


def _counted(outcomes: Iterator[Done], total: int, progress: Progress | None) -> Iterator[Done]:
    for done, outcome in enumerate(outcomes, 1):
        if progress is not None:
            progress(done, total)
        yield outcome
