"""`solepath-lab reproduce NAME`: repeats a paper's experiment on the emulator, beside the paper's table."""

from __future__ import annotations

import argparse
import sys
from functools import partial
from pathlib import Path
from typing import Any

from solepath.cli.common.closest import unknown
from solepath.cli.common.failure import Failure, parse_count, parse_whole_number, require
from solepath.cli.common.files import EXPERIMENT, FIGURE, OutputFile, add_force, check_outputs, write_json
from solepath.cli.completion import complete_with
from solepath.recording import printable
from solepath.saving.files import replace_whole

from ..options import add_json, add_processes
from ..tables.comparison import comparison_with_paper
from . import footstep_tracker, kupt_dfpc, pressure_contour, shoe_sensing, walking_modes
from .done_jobs import DoneJobs, DoneJobsError
from .runner import Runner
from .seeds import Experiment, reproduce_seeds
from .tables import as_json

EXPERIMENTS: dict[str, Experiment] = {
    "kupt-dfpc": kupt_dfpc.reproduce,
    "pressure-contour": pressure_contour.reproduce,
    "walking-modes": walking_modes.reproduce,
    "footstep-tracker": footstep_tracker.reproduce,
    "shoe-sensing": shoe_sensing.reproduce,
}
"""Function that repeats the experiment of each paper."""
NAMES = tuple(EXPERIMENTS)
"""Names of the experiments."""


def add_to(commands: Any) -> None:
    """Add the command to the parser."""
    command: argparse.ArgumentParser = commands.add_parser(
        "reproduce",
        help="walk a paper's experiment again on the emulator",
        description="Walk the experiment of a paper again with emulated wearers and emulated sensors, and print its "
        "table beside the paper's.",
        example="solepath-lab reproduce kupt-dfpc --walks 5 --figure kupt.png",
    )
    complete_with(command.add_argument("name", metavar="NAME", help=", ".join(NAMES)), lambda: NAMES)
    command.add_argument(
        "--walks", metavar="N", type=parse_count, help="so many walks, or wearers (default: as many as the paper)"
    )
    command.add_argument(
        "--seed", metavar="N", type=parse_whole_number, default=1, help="other walks and other sensors (default: 1)"
    )
    command.add_argument(
        "--seeds", metavar="N", type=parse_count, default=1, help="so many seeds, from --seed on (default: 1)"
    )
    command.add_argument(
        "--resume",
        metavar="FILE",
        type=Path,
        help="append the result of each walk to this file, and do not walk again what it already has",
    )
    add_json(command)
    command.add_argument(
        "--figure",
        metavar="FILE",
        nargs="?",
        const=Path(),
        type=Path,
        help="draw the paper's main figure into this file, .png, .svg or .pdf (default: NAME.png)",
    )
    add_force(command)
    add_processes(command)
    command.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Repeat the experiment and print its table; return the exit status."""
    if options.name not in NAMES:
        raise Failure(unknown("experiment", options.name, NAMES))
    figure = _figure(options)
    table = None if options.json is None else OutputFile(options.json, EXPERIMENT)
    picture = None if figure is None else OutputFile(figure, FIGURE)
    outputs = [output for output in (table, picture) if output is not None]
    check_outputs(options, outputs)

    if options.resume is not None and options.resume.resolve() in [output.path.resolve() for output in outputs]:
        raise Failure(f"{printable(str(options.resume))}: --resume needs a file of its own")

    done_jobs = None if options.resume is None else DoneJobs(options.resume, options.name)
    runner = Runner(options.processes, partial(print, file=sys.stderr, flush=True), done_jobs)
    seeds = range(options.seed, options.seed + options.seeds)
    try:
        if done_jobs is not None:
            done_jobs.open_file()
        experiment = reproduce_seeds(EXPERIMENTS[options.name], options.walks, seeds, runner)
    except DoneJobsError as error:
        raise Failure(f"{printable(str(options.resume))}: {error}") from None
    print(comparison_with_paper(experiment))
    if table is not None:
        write_json(table, as_json(experiment))
    if picture is not None:
        from ..tables.figures import draw

        file = picture.path
        replace_whole(
            file, lambda path: draw(experiment, path, file.suffix[1:].lower()), lambda _: picture.check_again()
        )
        print(f"figure drawn in {printable(str(file))}")
    return 0


def _figure(options: argparse.Namespace) -> Path | None:
    """Return the path of the figure, None without one; raise Failure when it could not be drawn."""
    path: Path | None = options.figure
    if path is None:
        return None
    require("figures need", "figures", "matplotlib")
    if path == Path():
        path = Path(f"{options.name}.png")
    from ..tables.figures import formats

    if path.suffix[1:].lower() not in formats():
        raise Failure(f"{printable(str(path))}: ends in none of {', '.join(formats())}, which says what to draw")
    return path
