"""Runs the jobs of an experiment: several at a time, with a line about each, without those that are already done."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from itertools import islice
from typing import TypeVar

from attrs import define, field

from solepath.cli.common.processes import run_jobs

from .done_jobs import DoneJobs

Job = TypeVar("Job")
JobResult = TypeVar("JobResult")


def ignore_line(line: str) -> None:
    """Do nothing with a line."""


@define
class Runner:
    """Settings with which the jobs of an experiment run."""

    processes: int = 1
    """Number of jobs that run at the same time."""
    report: Callable[[str], None] = ignore_line
    """Function that receives a line without its end about each job that is done."""
    done_jobs: DoneJobs | None = None
    """File with results, which is read before a job runs and receives its result at once; None keeps nothing."""
    title: str = field(default="", init=False)
    """Words before each line, such as the seed."""

    def run(
        self, work: Callable[[Job], JobResult], jobs: Sequence[Job], describe: Callable[[JobResult], str]
    ) -> list[JobResult]:
        """Return the result of the module-level function `work` for every job, in the order of the jobs.

        `describe` returns the findings of a job in a few words, for its line."""
        done = [None if self.done_jobs is None else self.done_jobs.find(work, job) for job in jobs]
        known = {k: result for k, result in enumerate(done) if result is not None}
        missing = [k for k in range(len(jobs)) if k not in known]
        if known:
            self.report(f"{self.title}{len(known)} of {len(jobs)} were already done")
        results = run_jobs(work, [jobs[k] for k in missing], processes=self.processes)
        for count, (k, result) in enumerate(zip(missing, results, strict=True), len(known) + 1):
            if self.done_jobs is not None:
                self.done_jobs.add(work, jobs[k], result)
            known[k] = result
            self.report(f"{self.title}{count} of {len(jobs)}: {describe(result)}")
        return [known[k] for k in range(len(jobs))]

    def run_blocks(
        self,
        work: Callable[[Job], JobResult],
        blocks: Mapping[str, Sequence[Job]],
        describe: Callable[[JobResult], str],
    ) -> dict[str, list[JobResult]]:
        """Return the results of the jobs of each block, all of which run as one list."""
        results = iter(self.run(work, [job for jobs in blocks.values() for job in jobs], describe))
        return {title: list(islice(results, len(jobs))) for title, jobs in blocks.items()}
