"""A file with the results of jobs that are done, from which an interrupted experiment goes on.

The first line names the experiment and the code: {"experiment", "source"}, where `source` is a checksum of all modules
of solepath, because other code gives other results. Each further line is {"job", "result"}: the job's description
and its result as saving/codec.py writes it. A line that was cut off when the program was stopped is left out."""

from __future__ import annotations

import json
from binascii import crc32
from collections.abc import Callable
from functools import cache
from hashlib import sha256
from importlib.resources import files
from pathlib import Path
from typing import Any, TypeVar, get_type_hints

from attrs import define, field, make_class

from solepath.saving.codec import Json, SnapshotError, load, save

Job = TypeVar("Job")
JobResult = TypeVar("JobResult")


class DoneJobsError(ValueError):
    """Error for a file that is not of this experiment and this code, in one sentence without the file's name."""


@cache
def source_checksum() -> int:
    """Return the CRC-32 of all Python modules of solepath in the order of their paths; a process takes it once."""
    root = Path(str(files("solepath")))
    checksum = 0
    for path in sorted(root.rglob("*.py")):
        checksum = crc32(path.read_bytes(), crc32(path.relative_to(root).as_posix().encode(), checksum))
    return checksum


def describe_job(work: Callable[[Any], Any], job: object) -> str:
    """Return a text that is the same for equal jobs of the same function, in every process.

    It names the function, and has a checksum of all that the job is made of, recipes included."""
    return f"{work.__module__}.{work.__qualname__} {sha256(repr(job).encode()).hexdigest()}"


@cache
def _record_class(work: Callable[[Any], Any]) -> Any:
    """Return the class of a record with the field `result`, which has the type that the function returns."""
    return make_class("Done", {"result": field(type=get_type_hints(work)["return"])}, frozen=True)


@define
class DoneJobs:
    """The results of jobs in the file `path`. `open_file` reads it, or begins it when it is absent or empty."""

    path: Path
    experiment: str
    _results: dict[str, Json] = field(factory=dict, init=False)
    """Saved results by job."""

    def open_file(self) -> None:
        """Read the results that the file has, and remove a last line that was cut off.

        Raises DoneJobsError for a file of another experiment, other code or other content, and OSError."""
        header = json.dumps({"experiment": self.experiment, "source": source_checksum()})
        try:
            text = self.path.read_text(encoding="utf-8") if self.path.exists() else ""
            whole = text[: text.rfind("\n") + 1] or (f"{header}\n" if header.startswith(text) else text)
            first, *lines = [json.loads(line) for line in whole.splitlines()]
            experiment, is_same_code = first["experiment"], first == json.loads(header)
            self._results = {line["job"]: line["result"] for line in lines}
        except (ValueError, TypeError, KeyError, RecursionError):
            raise DoneJobsError("has no results of walks") from None
        if experiment != self.experiment:
            raise DoneJobsError(f"has walks of {experiment!r}, not of {self.experiment!r}")
        if not is_same_code:
            raise DoneJobsError("has walks that other code of solepath scored: use another file")
        if whole != text:
            self.path.write_text(whole, encoding="utf-8")

    def find(self, work: Callable[[Job], JobResult], job: Job) -> JobResult | None:
        """Return the result of the job if the file has it, else None. Raises DoneJobsError if it cannot be read."""
        saved = self._results.get(describe_job(work, job))
        try:
            result: JobResult | None = None if saved is None else load(_record_class(work), saved).result
        except SnapshotError as error:
            raise DoneJobsError(f"has a result that cannot be read: {error}") from None
        return result

    def add(self, work: Callable[[Job], JobResult], job: Job, result: JobResult) -> None:
        """Append the result of a job to the file; raises OSError when that fails."""
        line = {"job": describe_job(work, job), "result": save(_record_class(work)(result))}
        with self.path.open("a", encoding="utf-8") as file:
            file.write(json.dumps(line) + "\n")
