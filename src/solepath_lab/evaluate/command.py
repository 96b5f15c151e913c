"""`solepath-lab evaluate [DIR]`: scores recipes on recorded data with a truth, on emulated walks, or on both."""

from __future__ import annotations

import argparse
import os
from collections.abc import Iterator
from itertools import chain
from pathlib import Path
from typing import Any

from solepath.cli.common.closest import unknown
from solepath.cli.common.failure import Failure, note
from solepath.cli.common.files import SCORES, OutputFile, add_force, check_outputs, write_json
from solepath.cli.common.inputs import add_calibration, add_recipe_name, calibration_of
from solepath.recipes import DEFAULT, NAMES, by_name
from solepath.show.tables.progress import progress_bar

from ..options import add_json, add_only, add_processes, add_seeds
from ..tables.markdown import accuracy_table
from ..tables.scores import ablation_table, comparison_tables, score_table
from . import ablation
from .changes import read_scores
from .datasets import DATASETS, EMULATED
from .jobs import evaluate, evaluate_emulated, find_data_sets
from .report import Result, as_json

ENVIRONMENT = "SOLEPATH_DATA"
"""Environment variable that names the data directory."""


def add_to(commands: Any) -> None:
    """Add the command to the parser."""
    command: argparse.ArgumentParser = commands.add_parser(
        "evaluate",
        help="score recipes on recorded data with a truth, and on emulated walks",
        description="Score recipes on a directory of recorded data with a truth, on long emulated walks, or on both, "
        "and print the tables.",
        example="solepath-lab evaluate --emulated --walks 1",
    )
    command.add_argument("dir", metavar="DIR", nargs="?", type=Path, help=f"the data (default: ${ENVIRONMENT})")
    add_only(command)
    add_recipe_name(command, action="append", default=[], help="this recipe only; may be given again")
    add_calibration(command)
    command.add_argument(
        "--emulated",
        action="store_true",
        help="on emulated walks too (without DIR on them alone): 500 m, 30 minutes, four floors of stairs; with the "
        "recipe default where no --recipe is named",
    )
    add_seeds(command, 3, 1)
    command.add_argument(
        "--ablation",
        action="store_true",
        help="the default recipe with one part at a time switched off, and what becomes of its main figures",
    )
    command.add_argument(
        "--markdown", action="store_true", help="print one table of the averages only, as docs/accuracy.md quotes it"
    )
    add_json(command)
    add_force(command)
    command.add_argument(
        "--compare",
        metavar="OLD",
        type=Path,
        help="the JSON of an earlier evaluation: say of every figure what it was, and whether it is better or worse",
    )
    add_processes(command)
    command.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Evaluate and print the tables; return the exit status."""
    emulated_names = [data_set.name for data_set in EMULATED]
    known_names = [*emulated_names, *(data_set.name for data_set in DATASETS)]
    if wrong := [name for name in options.only if name not in known_names]:
        raise Failure(f"--only: {unknown('data set', wrong[0], known_names)}")
    recorded, walked = (
        [name for name in options.only if (name in emulated_names) is is_emulated] for is_emulated in (False, True)
    )
    emulated = bool(walked) or options.emulated and not options.only
    default_folder = os.environ.get(ENVIRONMENT)
    folder = options.dir or (Path(default_folder) if default_folder and (recorded or not emulated) else None)
    if folder is None and (recorded or not emulated):
        raise Failure(f"evaluate needs DIR, or the environment variable {ENVIRONMENT}, or --emulated")
    scores = None if options.json is None else OutputFile(options.json, SCORES)
    if scores is not None:
        data_sets = folder.glob("*/") if folder is not None else ()
        check_outputs(options, [scores], *data_sets)
    all_recipes = [by_name(name) for name in NAMES]
    chosen = [by_name(name) for name in options.recipe]
    if options.ablation:
        if chosen:
            raise Failure("--ablation chooses the recipes itself, so it goes without --recipe")
        chosen = list(ablation.recipes())
    results = []
    old_scores = read_scores(options.compare) if options.compare else None
    with progress_bar("recordings", 100) as show:

        def percent(done: int, total: int) -> None:
            show(100 * done // total)

        common_options: dict[str, Any] = {
            "calibration": calibration_of(options), "processes": options.processes, "progress": percent,
        }  # fmt: skip
        evaluations: list[Iterator[Result]] = []
        if options.ablation and folder is not None and not options.only:
            main_sets = {column.data_set for column in ablation.COLUMNS}
            recorded = [data_set.name for data_set in find_data_sets(folder) if data_set.name in main_sets]
        if folder is not None and (recorded or not options.only):
            evaluations.append(evaluate(folder, chosen or all_recipes, only=recorded, **common_options))
        if emulated:
            seeds = range(options.seed, options.seed + options.walks)
            evaluations.append(evaluate_emulated(chosen or [DEFAULT], seeds, only=walked, **common_options))
        for result in chain(*evaluations):
            results.append(result)
            if not options.markdown and not options.ablation:
                print(score_table(result), end="\n\n", flush=True)
    if options.ablation:
        print(ablation_table(results, options.markdown))
    elif options.markdown:
        print(accuracy_table(results))
    if options.ablation or options.markdown:
        for failure in (sentence for result in results for sentence in result.failures):
            note(f"not scored: {failure}")
    if old_scores is not None:
        print(comparison_tables(old_scores, as_json(results)))
    if scores is not None:
        write_json(scores, as_json(results))
    return 0
