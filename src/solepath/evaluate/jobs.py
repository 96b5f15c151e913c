"""Every recipe on every recording that has a truth."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from contextlib import ExitStack
from itertools import islice
from pathlib import Path

from attrs import frozen

from ..calibration import Calibration
from ..recording import RecordingError
from .datasets import DATASETS, DataSet
from .recorded import Meta
from .report import Result
from .run import How
from .score import Scored


@frozen
class Job:
    data_set: DataSet
    how: How
    path: Path
    meta: Meta

    def run(self) -> Scored | str:
        """The scores, or the sentence that says why there are none."""
        try:
            return self.data_set.score(self.path, self.meta, self.how)
        except RecordingError as error:
            return str(error)


def find(folder: Path, only: Sequence[str] = ()) -> list[DataSet]:
    """The data sets there are in `folder`; RecordingError when there is none, or not one of those named in `only`."""
    if not folder.is_dir():
        raise RecordingError(folder, "is not a directory of recorded data")
    known = [data_set.name for data_set in DATASETS]
    for name in only:
        if name not in known:
            raise RecordingError(folder, f"{name} is not one of the data sets {', '.join(known)}")
    present = [d for d in DATASETS if (folder / d.folder / "dataset.json").is_file() and (not only or d.name in only)]
    missing = set(only) - {data_set.name for data_set in present}
    if missing or not present:
        what = ", ".join(sorted(missing)) or "any of the data sets " + ", ".join(known)
        raise RecordingError(folder, f"does not hold {what}")
    return present


def jobs(folder: Path, data_set: DataSet, how: How) -> list[Job]:
    """The recordings of a data set that have a truth."""
    about = folder / data_set.folder / "dataset.json"
    try:
        recordings: dict[str, Meta] = json.loads(about.read_text(encoding="utf-8"))["recordings"]
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise RecordingError(about, "does not say which recordings there are") from error
    paths = {name: folder / data_set.folder / f"{name}.npz" for name in sorted(recordings)}
    return [
        Job(data_set, how, path, recordings[name])
        for name, path in paths.items()
        if path.is_file() and data_set.has_truth(recordings[name])
    ]


def evaluate(
    folder: Path,
    recipes: Sequence[str],
    *,
    only: Sequence[str] = (),
    calibration: Calibration | None = None,
    processes: int = 1,
    progress: Callable[[int, int], None] | None = None,
) -> Iterator[Result]:
    """The result of each recipe on each data set of `folder`, as they are done; `calibration` is used for every
    recording, and `progress` gets (done, all)."""
    known = Calibration() if calibration is None else calibration
    plan = [(d, r, jobs(folder, d, How(r, known))) for r in recipes for d in find(folder, only) if d.suits(r)]
    everything = [job for _, _, part in plan for job in part]
    with ExitStack() as stack:
        if processes > 1:
            outcomes = stack.enter_context(ProcessPoolExecutor(processes)).map(Job.run, everything)
        else:
            outcomes = map(Job.run, everything)
        done = 0
        for data_set, recipe, part in plan:
            scores: list[Scored] = []
            failures: list[str] = []
            for outcome in islice(outcomes, len(part)):
                done += 1
                if progress is not None:
                    progress(done, len(everything))
                if isinstance(outcome, Scored):
                    scores.append(outcome)
                else:
                    failures.append(outcome)
            yield Result(data_set, recipe, tuple(scores), tuple(failures))
