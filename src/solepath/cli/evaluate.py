"""`solepath evaluate [DIR]`: every recipe on recorded data with a truth, as tables."""

from __future__ import annotations

import argparse
import os
from pathlib import Path
from typing import Any

from .calibrated import add_calibration, calibration_of
from .failure import Failure, known_recipe, note

ENVIRONMENT = "SOLEPATH_DATA"


def add_to(commands: Any) -> None:
    command: argparse.ArgumentParser = commands.add_parser(
        "evaluate",
        help="score recipes on recorded data with a truth",
        description="Score recipes on a directory of recorded data with a truth, and print the tables.",
    )
    command.add_argument("dir", metavar="DIR", nargs="?", type=Path, help=f"the data (default: ${ENVIRONMENT})")
    command.add_argument(
        "--only", metavar="DATASET", action="append", default=[], help="this data set only; may be given again"
    )
    command.add_argument(
        "--recipe", metavar="NAME", action="append", default=[], help="this recipe only; may be given again"
    )
    add_calibration(command)
    command.add_argument(
        "--markdown", action="store_true", help="print one table of the averages only, as the README quotes it"
    )
    command.add_argument("--json", metavar="FILE", type=Path, help="write the scores as JSON too")
    command.add_argument(
        "--processes", metavar="N", type=int, default=os.cpu_count() or 1, help="how many recordings at a time"
    )
    command.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    import json

    from .. import recipes
    from ..evaluate.jobs import evaluate
    from ..evaluate.report import as_json
    from ..recording import RecordingError
    from ..view.markdown import accuracy_table
    from ..view.progress import progress_bar
    from ..view.scores import score_table

    named = os.environ.get(ENVIRONMENT)
    folder = options.dir or (Path(named) if named else None)
    if folder is None:
        raise Failure(f"evaluate needs DIR, or the environment variable {ENVIRONMENT}")
    known = list(recipes.BY_NAME)
    chosen = [known_recipe(name, known) for name in options.recipe] or known
    calibration = calibration_of(options)
    results = []
    try:
        with progress_bar("recordings", 100) as show:

            def percent(done: int, total: int) -> None:
                show(100 * done // total)

            for result in evaluate(
                folder,
                chosen,
                only=options.only,
                calibration=calibration,
                processes=max(1, options.processes),
                progress=percent,
            ):
                results.append(result)
                if not options.markdown:
                    print(score_table(result), end="\n\n", flush=True)
    except RecordingError as error:
        raise Failure(str(error)) from None
    if options.markdown:
        print(accuracy_table(results))
        for failed in (sentence for result in results for sentence in result.failures):
            note(f"not scored: {failed}")
    if options.json:
        with options.json.open("w", encoding="utf-8") as file:
            json.dump(as_json(results), file, indent=1, allow_nan=False)
            file.write("\n")
    return 0
