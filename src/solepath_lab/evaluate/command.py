"""Score recipes on a directory of recorded data with a truth, on long emulated walks, or on both; print the tables."""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Iterator
from itertools import chain
from pathlib import Path
from typing import Any

from solepath.cli.common.closest import unknown
from solepath.cli.common.failure import Failure, note
from solepath.cli.common.files import Kind, OutputFile, add_force, check_outputs, write_json
from solepath.cli.common.inputs import add_calibration, calibration_of, recipe_option
from solepath.cli.common.parser import option
from solepath.recipes import DEFAULT, NAMES, by_name
from solepath.show.tables.progress import print_above, progress_bar

from ..options import JSON, ONLY, PROCESSES, seeds
from ..tables.accuracy import accuracy_table
from ..tables.scores import ablation_table, score_table, words_of
from . import ablation
from .changes import comparison_tables, read_scores
from .datasets import DATASETS, EMULATED
from .jobs import evaluate, evaluate_emulated, find_data_sets
from .report import Result, as_json

ENVIRONMENT = "SOLEPATH_DATA"
"""Environment variable that names the data directory."""


SCORES = Kind(rb'\A\{\}\n|\A\{\n "[^"\n]*": \{\n  "[^"\n]*": \{\n   "recordings": \{')
"""JSON of `evaluate`."""
OPTIONS = (
    option("dir", metavar="DIR", nargs="?", type=Path, help=f"the data (default: ${ENVIRONMENT})"),
    ONLY,
    recipe_option(action="append", default=[], help="this recipe only; may be given again"),
    add_calibration,
    option(
        "--emulated",
        action="store_true",
        help="on emulated walks too (without DIR on them alone): 500 m, 30 minutes, four floors of stairs; with the "
        "recipe default where no --recipe is named",
    ),
    seeds(3, 1),
    option(
        "--ablation",
        action="store_true",
        help="the default recipe with one part at a time switched off, and what becomes of its main figures",
    ),
    option(
        "--markdown", action="store_true", help="print one table of the averages only, as docs/accuracy.md quotes it"
    ),
    JSON,
    add_force,
    option(
        "--compare",
        metavar="OLD",
        type=Path,
        help="the JSON of an earlier evaluation: say of every figure what it was, and whether it is better or worse",
    ),
    PROCESSES,
)
EXAMPLE = "solepath-lab evaluate --emulated --walks 1"


def run(options: argparse.Namespace) -> int:
    """Evaluate and print the tables; return the exit status."""
    names = {one.name: one in EMULATED for one in (*EMULATED, *DATASETS)}
    if wrong := [name for name in options.only if name not in names]:
        raise Failure(f"--only: {unknown('data set', wrong[0], names)}")
    recorded, walked = ([name for name in options.only if names[name] is which] for which in (False, True))
    emulated = bool(walked) or options.emulated and not options.only
    needs_folder = bool(recorded) or not emulated
    folder: Path | None = options.dir
    if needs_folder and folder is None:
        if not os.environ.get(ENVIRONMENT):
            raise Failure(f"evaluate needs DIR, or the environment variable {ENVIRONMENT}, or --emulated")
        folder = Path(os.environ[ENVIRONMENT])
    scores = None if options.json is None else OutputFile(options.json, SCORES)
    if scores is not None:
        data_sets = folder.glob("*/") if folder is not None else ()
        check_outputs(options, [scores], *data_sets)
    chosen = [by_name(name) for name in options.recipe]
    if options.ablation:
        if chosen:
            raise Failure("--ablation chooses the recipes itself, so it goes without --recipe")
        chosen = list(ablation.recipes())
    results = []
    old_scores = read_scores(options.compare) if options.compare else None
    with progress_bar("recordings", 100) as show:
        common_options: dict[str, Any] = {
            "calibration": calibration_of(options),
            "processes": options.processes,
            "progress": lambda done, total: show(100 * done // total),
        }
        evaluations: list[Iterator[Result]] = []
        if options.ablation and folder is not None and not options.only:
            main_sets = {column.data_set for column in ablation.COLUMNS}
            recorded = [data_set.name for data_set in find_data_sets(folder) if data_set.name in main_sets]
        if folder is not None and (recorded or not options.only):
            evaluations.append(
                evaluate(folder, chosen or [by_name(name) for name in NAMES], only=recorded, **common_options)
            )
        if emulated:
            numbers = range(options.seed, options.seed + options.walks)
            evaluations.append(evaluate_emulated(chosen or [DEFAULT], numbers, only=walked, **common_options))
        for result in chain(*evaluations):
            results.append(result)
            if not options.markdown and not options.ablation:
                print_above(f"{score_table(result)}\n", sys.stdout)
    if options.ablation:
        print(ablation_table(results, options.markdown))
    elif options.markdown:
        print(accuracy_table(results))
    else:
        print(words_of(results))
    if options.ablation or options.markdown:
        for failure in (sentence for result in results for sentence in result.failures):
            note(f"not scored: {failure}")
    if old_scores is not None:
        print(comparison_tables(old_scores, as_json(results)))
    if scores is not None:
        write_json(scores, as_json(results))
    return 0
