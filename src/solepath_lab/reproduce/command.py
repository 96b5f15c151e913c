"""Walk the experiment of a paper again with emulated wearers and sensors, and print its table beside the paper's."""

from __future__ import annotations

import argparse
import sys
import time
from functools import partial
from pathlib import Path

from solepath.cli.common.closest import unknown
from solepath.cli.common.failure import Failure, parse_count, parse_whole_number, require
from solepath.cli.common.files import Kind, OutputFile, add_force, check_outputs, write_json
from solepath.cli.common.parser import option
from solepath.cli.completion import complete_with
from solepath.recording import printable
from solepath.saving.files import replace_whole

from ..options import JSON, PROCESSES
from ..tables.comparison import comparison_with_paper
from . import footstep_tracker, kupt_dfpc, pressure_contour, shoe_sensing, walking_modes
from .done_jobs import DoneJobs, DoneJobsError
from .runner import Runner
from .seeds import Experiment, reproduce_seeds
from .tables import Reproduction, as_json

EXPERIMENTS: dict[str, Experiment] = {
    "kupt-dfpc": kupt_dfpc.reproduce,
    "pressure-contour": pressure_contour.reproduce,
    "walking-modes": walking_modes.reproduce,
    "footstep-tracker": footstep_tracker.reproduce,
    "shoe-sensing": shoe_sensing.reproduce,
}
"""Function that repeats the experiment of each paper."""
EXPERIMENT = Kind(rb'\A\{\n "name": "[^"\n]*",\n "emulated": true,\n "table": \{')
"""JSON of `reproduce`."""
FIGURE = Kind(
    rb"\A\x89PNG.{0,60}tEXtSoftware\0solepath|\A%!PS-Adobe[^\n]*\n(?:%%[^\n]*\n)*%%Creator: solepath\n"
    rb"|/Creator \(solepath\) /Producer \(Matplotlib |<dc:creator>\s*<cc:Agent>\s*<dc:title>solepath</dc:title>"
)
"""A figure of `reproduce` (.png, .eps, .ps, .pdf, .svg), whose metadata name the program that drew it."""
NAMES = tuple(EXPERIMENTS)
"""Names of the experiments."""
CLOCK_SEEDS = 100_000
"""Number of seeds among which the clock draws one."""


OPTIONS = (
    lambda parser: complete_with(parser.add_argument("name", metavar="NAME", help=", ".join(NAMES)), lambda: NAMES),
    option("--walks", metavar="N", type=parse_count, help="so many walks, or wearers (default: as many as the paper)"),
    option(
        "--seed",
        metavar="N",
        type=parse_whole_number,
        help="draws walks and sensors; the table names it (default: another one each time, by the clock)",
    ),
    option("--seeds", metavar="N", type=parse_count, default=1, help="so many seeds, one after the other (default: 1)"),
    option(
        "--resume",
        metavar="FILE",
        type=Path,
        help="append the result of each walk to this file, and do not walk again what it already has",
    ),
    JSON,
    option(
        "--figure",
        metavar="FILE",
        nargs="?",
        const=Path(),
        type=Path,
        help="draw the paper's main figure into this file, .png, .svg or .pdf (default: NAME.png)",
    ),
    add_force,
    PROCESSES,
)
EXAMPLE = "solepath-lab reproduce kupt-dfpc --walks 5 --figure kupt.png"


def run(options: argparse.Namespace) -> int:
    """Repeat the experiment and print its table; return the exit status."""
    if options.name not in NAMES:
        raise Failure(unknown("experiment", options.name, NAMES))
    figure = _figure(options)
    kinds = ((options.json, EXPERIMENT), (figure, FIGURE))
    outputs = [OutputFile(path, kind) for path, kind in kinds if path is not None]
    check_outputs(options, outputs)

    if options.resume is not None and options.resume.resolve() in [output.path.resolve() for output in outputs]:
        raise Failure(f"{printable(str(options.resume))}: --resume needs a file of its own")

    if options.resume is not None and options.seed is None:
        raise Failure("--resume needs the --seed of the walks with which it goes on")
    first = time.time_ns() // 10**6 % CLOCK_SEEDS if options.seed is None else options.seed
    done_jobs = None if options.resume is None else DoneJobs(options.resume, options.name)
    runner = Runner(options.processes, partial(print, file=sys.stderr, flush=True), done_jobs)
    seeds = range(first, first + options.seeds)
    try:
        if done_jobs is not None:
            done_jobs.open_file()
        experiment = reproduce_seeds(EXPERIMENTS[options.name], options.walks, seeds, runner)
    except DoneJobsError as error:
        raise Failure(f"{printable(str(options.resume))}: {error}") from None
    print(comparison_with_paper(experiment))
    for output in outputs:
        if output.kind is EXPERIMENT:
            write_json(output, as_json(experiment))
        else:
            _draw(experiment, output)
    return 0


def _draw(experiment: Reproduction, output: OutputFile) -> None:
    """Draw the figure of an experiment."""
    from ..tables.figures import draw

    form = output.path.suffix[1:].lower()
    replace_whole(output.path, lambda path: draw(experiment, path, form), lambda _: output.check_again())
    print(f"figure drawn in {printable(str(output.path))}")


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
