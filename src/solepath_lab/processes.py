"""Runs the same function on many jobs in several processes."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from contextlib import ExitStack
from typing import TypeVar

Job = TypeVar("Job")
JobResult = TypeVar("JobResult")

Progress = Callable[[int, int], None]
"""Function that is called with (number of jobs done, number of all jobs)."""


def run_jobs(
    work: Callable[[Job], JobResult], jobs: Sequence[Job], *, processes: int = 1, progress: Progress | None = None
) -> Iterator[JobResult]:
    """Yield the result of the module-level function `work` for every job, in the order of the jobs."""
    with ExitStack() as stack:
        parallel = processes > 1 and len(jobs) > 1
        pool = stack.enter_context(ProcessPoolExecutor(min(processes, len(jobs)))) if parallel else None
        for job_number, outcome in enumerate((map if pool is None else pool.map)(work, jobs), 1):
            if progress is not None:
                progress(job_number, len(jobs))
            yield outcome
