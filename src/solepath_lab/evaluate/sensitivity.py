"""The main figures with each number of the default recipe at half and at twice its value.

    solepath-lab sensitivity DIR [--processes N] [--only NAME] [--number NAME]

prints a table as Markdown, of which docs/accuracy.md has some rows. DIR holds recorded data with a reference. The
numbers are the settings of the detector (`CycleSettings`), the settings of the filter (`ErrorStateSettings`) and the
constants of the inertial cues (foot/cues/inertial.py). A count is rounded to a whole number of at least 1. The run
takes about 45 minutes on two processors."""

from __future__ import annotations

import ast
import inspect
from argparse import Namespace
from collections.abc import Iterator, Sequence
from itertools import islice, pairwise
from pathlib import Path
from types import ModuleType
from typing import Any

import attrs
from attrs import evolve, frozen

from solepath.calibration import Calibration
from solepath.cli.common.processes import run_jobs
from solepath.foot import settings
from solepath.foot.cues import inertial
from solepath.foot.navigate.error_state import ErrorStateFilter
from solepath.foot.settings import CycleSettings, ErrorStateSettings
from solepath.foot.stance.cycle import Cycle
from solepath.recipes import DEFAULT, Recipe

from ..measures.score import Scored
from ..tables.columns import SCALES
from .ablation import SENSITIVITY_COLUMNS, Column
from .jobs import EvaluationJob, find_data_sets, recordings
from .report import Result
from .run import RunSettings

FACTORS = (0.5, 2.0)
"""Factors by which each number is multiplied."""
PARTS: dict[str, tuple[Any, Any]] = {
    "detector": (CycleSettings, Cycle),
    "corrector": (ErrorStateSettings, ErrorStateFilter),
}
"""Settings class and class of two parts of the default recipe, by the recipe's field."""
UNCHANGED_SHARE = 0.005
"""Relative change of an error, or absolute change of F1, below which the table shows 0."""
UNCHANGED_OFFSET = 0.5
"""Change of an offset below which the table shows 0, ms."""


@frozen
class Number:
    """One number of the default recipe."""

    name: str
    value: float
    meaning: str
    """First paragraph of the number's docstring, which names its unit."""
    part: str
    """Field of the recipe that the number belongs to: "detector", "corrector" or "cues"."""

    def scale(self, factor: float) -> tuple[Recipe, dict[str, float]]:
        """Return the default recipe with this number times `factor`, and the module constants to change for it.

        A count stays a whole number of at least 1: half of 3 is rounded to 2."""
        value = max(1, round(factor * self.value)) if isinstance(self.value, int) else factor * self.value
        name = f"{self.name} x {factor:g}"
        if self.part not in PARTS:
            return evolve(DEFAULT, name=name), {self.name: value}
        settings_class, part_class = PARTS[self.part]
        change: dict[str, Any] = {self.part: part_class(settings_class(**{self.name: value}))}
        return evolve(DEFAULT, name=name, **change), {}


def _meanings(module: ModuleType, cls: type | None = None) -> dict[str, str]:
    """Return the docstrings of a module's constants, or of the fields of one of its classes, by name."""
    body: Sequence[ast.stmt] = ast.parse(inspect.getsource(module)).body
    if cls is not None:
        (body,) = [node.body for node in body if isinstance(node, ast.ClassDef) and node.name == cls.__name__]
    meanings: dict[str, str] = {}
    for assignment, node in pairwise(body):
        target = assignment.targets[0] if isinstance(assignment, ast.Assign) else getattr(assignment, "target", None)
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and isinstance(target, ast.Name):
            meanings[target.id] = " ".join(str(node.value.value).split("\n\n")[0].split())
    return meanings


def numbers() -> list[Number]:
    """Return the numbers of the default detector, filter and inertial cues, in the order of their definition."""
    numbers: list[Number] = []
    for part, (settings_class, _) in PARTS.items():
        meanings = _meanings(settings, settings_class)
        default = settings_class()
        for field in attrs.fields(settings_class):
            value = getattr(default, field.name)
            if isinstance(value, float):
                numbers.append(Number(field.name, value, meanings.get(field.name, ""), part))
    meanings = _meanings(inertial)
    for name, value in vars(inertial).items():
        if name in meanings and name.isupper() and isinstance(value, float | int):
            numbers.append(Number(name, value, meanings[name], "cues"))
    return numbers


@frozen
class SensitivityJob:
    """A recording to score with one number changed."""

    job: EvaluationJob
    constants: dict[str, float]
    """Values of the constants of foot/cues/inertial.py to change, by name."""

    def run(self) -> Scored | str:
        """Score the recording while the constants are changed in this process."""
        defaults = {name: getattr(inertial, name) for name in self.constants}
        for name, value in self.constants.items():
            setattr(inertial, name, value)
        try:
            return self.job.run()
        finally:
            for name, value in defaults.items():
                setattr(inertial, name, value)


def columns(names: Sequence[str] = ()) -> list[Column]:
    """Return the columns of the table: those of the data sets `names`, or all when `names` is empty."""
    return [column for column in SENSITIVITY_COLUMNS if not names or column.data_set in names]


def evaluate(
    folder: Path, chosen: Sequence[Number], names: Sequence[str], processes: int
) -> Iterator[tuple[Number | None, float, list[float | None]]]:
    """Yield number, factor and figures: first the default recipe with None as number, then each number and factor."""
    shown = columns(names)
    data_sets = [
        (one, recordings(folder, one)) for one in find_data_sets(folder, sorted({column.data_set for column in shown}))
    ]
    variants: list[tuple[Number | None, float]] = [(None, 1.0), *((one, k) for one in chosen for k in FACTORS)]
    jobs: list[SensitivityJob] = []
    for number, factor in variants:
        recipe, constants = (DEFAULT, {}) if number is None else number.scale(factor)
        run_settings = RunSettings(recipe, Calibration(), None)
        jobs += [
            SensitivityJob(EvaluationJob(data_set.score, run_settings, path, meta), constants)
            for data_set, recorded in data_sets
            for path, meta in recorded
        ]
    outcomes = run_jobs(SensitivityJob.run, jobs, processes=processes)
    for number, factor in variants:
        results = []
        for data_set, recorded in data_sets:
            outcomes_of_set = list(islice(outcomes, len(recorded)))
            scores = tuple([one for one in outcomes_of_set if isinstance(one, Scored)])
            results.append(Result(data_set, "", scores, ()))
        yield number, factor, [column.find_figure(results, "") for column in shown]


def _change(column: Column, value: float | None, default: float | None) -> str:
    """Format the change from the `default`: relative for errors, absolute for F1 and offsets."""
    if value is None or default is None:
        return "-"
    difference = SCALES[column.unit] * (value - default)
    if column.unit == "ms":
        return "0" if abs(difference) < UNCHANGED_OFFSET else f"{difference:+.0f} ms"
    if not column.unit:
        return "0" if abs(difference) < UNCHANGED_SHARE else f"{difference:+.2f}"
    relative = value / default - 1.0 if default else 0.0
    return "0" if abs(relative) < UNCHANGED_SHARE else f"{100.0 * relative:+.0f} %"


def table(rows: Iterator[tuple[Number | None, float, list[float | None]]], shown: Sequence[Column]) -> Iterator[str]:
    """Yield the lines of the Markdown table from the rows of `evaluate`, one line for each number."""
    _, _, default = next(rows)
    yield f"| number | default | meaning | {' | '.join(column.title for column in shown)} |"
    yield "|" + "---|" * (3 + len(shown))
    cells = " | ".join(
        "-" if value is None else f"{SCALES[column.unit] * value:.3g} {column.unit}".strip()
        for column, value in zip(shown, default, strict=True)
    )
    yield f"| (default recipe) |  |  | {cells} |"
    for (number, _, half), (_, _, double) in zip(rows, rows, strict=True):
        assert number is not None
        changes = [
            f"{_change(column, a, base)} / {_change(column, b, base)}"
            for column, a, b, base in zip(shown, half, double, default, strict=True)
        ]
        yield f"| {number.part} `{number.name}` | {number.value:g} | {number.meaning} | {' | '.join(changes)} |"


def run(options: Namespace) -> int:
    """Print the table; return the exit status."""
    selected = [one for one in numbers() if not options.number or one.name in options.number]
    for line in table(evaluate(options.dir, selected, options.only, options.processes), columns(options.only)):
        print(line, flush=True)
    return 0
