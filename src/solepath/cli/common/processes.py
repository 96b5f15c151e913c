"""Runs the same function on many jobs in several processes."""

from __future__ import annotations

import os
import signal
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack
from threading import Thread
from typing import TypeVar

from .failure import parse_count
from .parser import option

Job = TypeVar("Job")
JobResult = TypeVar("JobResult")

Progress = Callable[[int, int], None]
"""Function that is called with (number of jobs done, number of all jobs)."""


def run_jobs(
    work: Callable[[Job], JobResult], jobs: Sequence[Job], *, processes: int = 1, progress: Progress | None = None
) -> Iterator[JobResult]:
    """Yield the result of the module-level function `work` for every job, in the order of the jobs.

    The processes end at once with Ctrl-C, and with this one, however it ends."""
    from concurrent.futures import ProcessPoolExecutor

    with ExitStack() as stack:
        parallel, count = processes > 1 and len(jobs) > 1, min(processes, len(jobs))
        pool = stack.enter_context(ProcessPoolExecutor(count, initializer=_end_with_parent)) if parallel else None
        for job_number, outcome in enumerate((map if pool is None else pool.map)(work, jobs), 1):
            if progress is not None:
                progress(job_number, len(jobs))
            yield outcome


def _end_with_parent() -> None:
    """End this process when Ctrl-C is typed or its parent has ended: a pool whose owner was killed waits for ever."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    Thread(target=_wait_for_parent, daemon=True).start()


def _wait_for_parent() -> None:
    from multiprocessing import parent_process

    if (parent := parent_process()) is not None:
        parent.join()
        os._exit(1)


add_processes = option(
    "--processes", metavar="N", type=parse_count, default=os.cpu_count() or 1, help="how many at once (default: cores)"
)
"""--processes."""
