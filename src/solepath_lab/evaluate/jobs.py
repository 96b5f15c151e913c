"""Runs every recipe on every recording that has a reference ("truth")."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from itertools import islice
from pathlib import Path

from attrs import frozen

from solepath.calibration import Calibration
from solepath.cli.common.processes import Progress, run_jobs
from solepath.recipes import Recipe
from solepath.recording import RecordingError

from ..descriptions import read_description
from ..measures.score import Scored
from .datasets import DATASETS, EMULATED, DataSet
from .learning import TrainingSource, part_for, train_parts, training_sources
from .report import Result
from .run import Meta, RunSettings


@frozen
class EvaluationJob:
    """One recipe on one recording."""

    score: Callable[[Path, Meta, RunSettings], Scored]
    settings: RunSettings
    path: Path
    meta: Meta

    def run(self) -> Scored | str:
        """Return the scores, or the reason for which the recording cannot be scored."""
        try:
            return self.score(self.path, self.meta, self.settings)
        except RecordingError as error:
            return str(error)


def find_data_sets(folder: Path, only: Sequence[str] = ()) -> list[DataSet]:
    """Return the data sets in `folder`. Raise RecordingError when it has none, or lacks a data set of `only`."""
    if not folder.is_dir():
        raise RecordingError(folder, "is not a directory of recorded data")
    known = [data_set.name for data_set in DATASETS]
    present = [d for d in DATASETS if _description_files(folder, d) and (not only or d.name in only)]
    missing = set(only) - {data_set.name for data_set in present}
    if missing or not present:
        names = ", ".join(sorted(missing)) or "any of the data sets " + ", ".join(known)
        raise RecordingError(folder, f"does not hold {names}")
    return present


def _description_files(folder: Path, data_set: DataSet) -> list[Path]:
    """Return the paths of the dataset.json files that exist in the folders of a data set."""
    files = [folder / name / "dataset.json" for name in data_set.folders or (data_set.name,)]
    return [file for file in files if file.is_file()]


def recordings(folder: Path, data_set: DataSet) -> list[tuple[Path, Meta]]:
    """Return the recordings of a data set that have a reference, with their entries in dataset.json."""
    recordings_found: list[tuple[Path, Meta]] = []
    for file in _description_files(folder, data_set):
        try:
            entries: dict[str, Meta] = read_description(file)["recordings"]
            recordings_found += [
                (file.with_name(f"{name}.npz"), entries[name])
                for name in sorted(entries)
                if data_set.has_truth(name, entries[name])
            ]
        except (OSError, ValueError, KeyError, TypeError) as error:
            raise RecordingError(file, "does not say which recordings there are") from error
    return [(path, meta) for path, meta in recordings_found if path.is_file()]


Plan = list[tuple[DataSet, Recipe, list[tuple[Path, Meta]]]]
"""Recordings to score for each pair of data set and recipe."""


def evaluate(
    folder: Path,
    recipes: Sequence[Recipe],
    *,
    only: Sequence[str] = (),
    calibration: Calibration | None = None,
    processes: int = 1,
    progress: Progress | None = None,
) -> Iterator[Result]:
    """Yield the result of each recipe on each data set of `folder` as soon as it is complete.

    `calibration` is used for every recording. `progress` is called with (number of jobs done, number of all jobs)."""
    data_sets = find_data_sets(folder, only)
    plan = [(d, recipe, recordings(folder, d)) for recipe in recipes for d in data_sets if d.suits(recipe)]
    sources = training_sources(folder, recipes) if any(data_set.folds for data_set in data_sets) else []
    return _scored(plan, sources, calibration, processes, progress)


def evaluate_emulated(
    recipes: Sequence[Recipe],
    seeds: Sequence[int],
    *,
    only: Sequence[str] = (),
    calibration: Calibration | None = None,
    processes: int = 1,
    progress: Progress | None = None,
) -> Iterator[Result]:
    """Yield the result of each recipe on the emulated walks of `seeds`: all data sets, or those named in `only`."""
    walks: list[tuple[Path, Meta]] = [(Path(f"seed {seed}"), {"seed": seed}) for seed in seeds]
    plan = [(d, recipe, walks) for recipe in recipes for d in EMULATED if not only or d.name in only]
    return _scored(plan, [], calibration, processes, progress)


def _scored(
    plan: Plan,
    sources: list[TrainingSource],
    calibration: Calibration | None,
    processes: int,
    progress: Progress | None,
) -> Iterator[Result]:
    calibration = Calibration() if calibration is None else calibration
    features = run_jobs(TrainingSource.features, sources, processes=processes, progress=progress)
    parts = train_parts(sources, list(features))
    jobs = [
        EvaluationJob(
            d.score, RunSettings(recipe, calibration, part_for(recipe, meta, parts) if d.folds else None), path, meta
        )
        for d, recipe, recorded in plan
        for path, meta in recorded
    ]
    outcomes = run_jobs(EvaluationJob.run, jobs, processes=processes, progress=progress)
    for data_set, recipe, recorded in plan:
        outcomes_of_set = list(islice(outcomes, len(recorded)))
        scores = tuple([one for one in outcomes_of_set if isinstance(one, Scored)])
        yield Result(data_set, recipe.name, scores, tuple([one for one in outcomes_of_set if isinstance(one, str)]))
