"""Runs the same function on many jobs in several processes."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from contextlib import ExitStack
from typing import TypeVar

Job = TypeVar("Job")
Done = TypeVar("Done")

Progress = Callable[[int, int], None]
"""Function that is called with (jobs done, number of all jobs)."""


def run_jobs(
    work: Callable[[Job], Done],
    jobs: Sequence[Job],
    *,
    processes: int = 1,
    progress: Progress | None = None,
    before: int = 0,
    after: int = 0,
) -> Iterator[Done]:
    """Yield the result of the module-level function `work` for every job, in the order of the jobs.

    `before` and `after` are numbers of other jobs, done before and after these, which `progress` counts as well."""
    with ExitStack() as stack:
        many = processes > 1 and len(jobs) > 1
        pool = stack.enter_context(ProcessPoolExecutor(min(processes, len(jobs)))) if many else None
        for done, outcome in enumerate((map if pool is None else pool.map)(work, jobs), before + 1):
            if progress is not None:
                progress(done, before + len(jobs) + after)
            yield outcome
