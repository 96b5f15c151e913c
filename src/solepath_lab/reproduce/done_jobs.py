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

from attrs import AttrsInstance, define, field, fields_dict, make_class

from solepath.saving.codec import Json, SnapshotError, load, save
from solepath.saving.schema import is_record

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


def named_values(job: AttrsInstance) -> str:
    """Return the values of a job's fields, for its `key`; a setting counts by its `name`, which no other one has."""
    values = {one: getattr(job, one) for one in fields_dict(type(job))}
    return str({one: getattr(value, "name", value) for one, value in values.items()})


def describe_job(work: Callable[[Any], Any], job: object) -> str:
    """Return a text that is the same for equal jobs of the same function, in every process.

    It names the function, and has a checksum of all that the job is made of, recipes included; of its `key` if it has
    one, a string or number that is another for each other job of the experiment."""
    key = getattr(job, "key", None)
    content = json.dumps(key or (save(job) if is_record(type(job)) else job), sort_keys=True)
    return f"{work.__module__}.{work.__qualname__} {sha256(content.encode()).hexdigest()}"


def _reject_constant(name: str) -> float:
    """Raise ValueError for NaN and infinity, which no result has."""
    raise ValueError(f"{name} is no result")


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
            text = self.path.read_text(encoding="utf-8")
        except FileNotFoundError:
            text = ""
        except UnicodeDecodeError:
            raise DoneJobsError("has no results of walks") from None
        whole = text[: text.rfind("\n") + 1]
        if not whole:
            if text and not header.startswith(text):
                raise DoneJobsError("has no results of walks")
            self.path.write_text(header + "\n", encoding="utf-8")
            return
        first, *lines = whole.splitlines()
        if first != header:
            self._reject(first)
        try:
            for line in lines:
                entry = json.loads(line, parse_constant=_reject_constant)
                self._results[entry["job"]] = {"result": entry["result"]["result"]}
        except (ValueError, TypeError, KeyError, RecursionError):
            raise DoneJobsError(f"line {len(self._results) + 2} is no result of a walk") from None
        if whole != text:
            self.path.write_text(whole, encoding="utf-8")

    def _reject(self, header: str) -> None:
        """Raise the DoneJobsError that says what the file is instead."""
        try:
            found = json.loads(header)
            experiment = found["experiment"]
        except (ValueError, TypeError, KeyError, RecursionError):
            raise DoneJobsError("has no results of walks") from None
        if experiment != self.experiment:
            raise DoneJobsError(f"has walks of {experiment!r}, not of {self.experiment!r}")
        raise DoneJobsError("has walks that other code of solepath scored: use another file")

    def find(self, work: Callable[[Job], JobResult], job: Job) -> JobResult | None:
        """Return the result of the job if the file has it, else None. Raises DoneJobsError if it cannot be read."""
        saved = self._results.get(describe_job(work, job))
        if saved is None:
            return None
        try:
            result: JobResult = load(_record_class(work), saved).result
        except SnapshotError as error:
            raise DoneJobsError(f"has a result that cannot be read: {error}") from None
        return result

    def add(self, work: Callable[[Job], JobResult], job: Job, result: JobResult) -> None:
        """Append the result of a job to the file; raises OSError when that fails."""
        saved = save(_record_class(work)(result))
        name = describe_job(work, job)
        with self.path.open("a", encoding="utf-8") as file:
            file.write(json.dumps({"job": name, "result": saved}) + "\n")
        self._results[name] = saved
