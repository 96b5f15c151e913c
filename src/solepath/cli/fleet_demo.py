"""`solepath fleet-demo`: runs emulated wearers in a stream engine that is killed, and measures the cost of both.

The durations below were chosen by hand; other values were not tried."""

from __future__ import annotations

import argparse
import os
import shutil
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..recording import printable
from ..types.extras import install_hint
from .common.failure import Failure, is_installed, parse_count, parse_positive, parse_whole_number, recipe_named
from .common.files import FLEET_FIGURES, OutputFile, add_force, check_outputs, check_writable, write_json
from .common.inputs import add_recipe_name

if TYPE_CHECKING:
    from ..fleet.demo.stage import DemoStage

DIFFERENCE_STATUS = 1
"""Exit status when the events of two runs differ."""
MAX_WALK_TIME = 3600.0
"""Longest walk that an option may request, s."""
DEFAULT_TOTAL_TIME, MIN_DEFAULT_TIME, MAX_DEFAULT_TIME = 1200.0, 4.0, 20.0
"""Default walking time of all wearers together, and the least and the greatest default of each wearer, s."""


def add_to(commands: Any) -> None:
    """Add the command to the parser."""
    command: argparse.ArgumentParser = commands.add_parser(
        "fleet-demo",
        help="many emulated wearers through a stream engine that is killed",
        description="Emulated wearers, whose packets come late, twice and out of order, walk through the stream engine "
        "bytewax, which keeps the state of their sessions. Its processes are killed at random moments (kill -9) and "
        "started again, and each time the events must equal those of an uninterrupted run, and those of sessions "
        "without an engine. Exit status 1 when they do not.",
        epilog="example: solepath fleet-demo --wearers 1000 --kills 10 --out fleet",
    )
    command.add_argument(
        "--wearers", metavar="N", type=parse_count, default=100, help="how many wearers (default: 100)"
    )
    command.add_argument("--kills", metavar="K", type=parse_whole_number, default=3, help="how many kills (default: 3)")
    command.add_argument(
        "--seconds",
        metavar="S",
        type=parse_positive,
        help=f"how long each wearer walks, s (default: {MIN_DEFAULT_TIME:g} for "
        f"{DEFAULT_TOTAL_TIME / MIN_DEFAULT_TIME:.0f} wearers and more, up to {MAX_DEFAULT_TIME:g} for fewer)",
    )
    add_recipe_name(command, "recipe of the sessions")
    command.add_argument(
        "--seed", metavar="X", type=parse_whole_number, default=1, help="other wearers, other kills (default: 1)"
    )
    command.add_argument(
        "--processes",
        metavar="P",
        type=parse_count,
        default=min(2, os.cpu_count() or 1),
        help="processes of the engine (default: 2, where there are two processors)",
    )
    command.add_argument("--out", metavar="DIR", type=Path, help="leave the events there, as Parquet in DIR/events")
    command.add_argument("--json", metavar="FILE", type=Path, help="write the figures as JSON too")
    add_force(command)
    command.add_argument(
        "--keep", action="store_true", help="keep all that the runs wrote: recovery stores, logs, events"
    )
    command.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Run the demo; return the exit status."""
    result_file = None if options.json is None else OutputFile(options.json, FLEET_FIGURES)
    _check(options, result_file)
    from ..fleet.demo.compare import UnreadableEvents
    from ..fleet.demo.run import RunFailed
    from ..fleet.demo.stage import DemoStage
    from ..fleet.demo.wearers import DemoPlan
    from .common.loop import stop_signals_raise
    from .fleet_table import figures, result_table

    seconds = options.seconds or min(max(DEFAULT_TOTAL_TIME / options.wearers, MIN_DEFAULT_TIME), MAX_DEFAULT_TIME)
    plan = DemoPlan(options.wearers, seconds, options.seed, options.recipe, options.processes)
    with stop_signals_raise(), _directory(options) as directory:
        stage = DemoStage(directory, plan)
        try:
            differences = run_all(stage, options.kills, keep=options.keep)
        except (RunFailed, UnreadableEvents) as error:
            raise Failure(str(error)) from None
        print(f"\n{result_table(stage)}")
        if result_file is not None:
            write_json(result_file, {**figures(stage), "differences": differences})
        if options.out is not None:
            _copy_events(stage, options.out)
        return verdict(differences, [outcome.differences for outcome in stage.outcomes])


def run_all(stage: DemoStage, kills: int, *, keep: bool) -> list[str]:
    """Do all runs, print each as it ends, and return how the uninterrupted run differs from one without an engine."""
    from .fleet_table import kill_lines, recovery_line

    plan = stage.plan
    stage.prepare()
    print(
        f"{_counted(plan.wearers, 'wearer walks', 'wearers walk')} {plan.seconds:g} s: {sum(stage.samples)} samples; "
        f"{_counted(stage.gapped, 'loses', 'lose')} some rows for ever, "
        f"{_counted(stage.poisoned, 'sends', 'send')} random bytes"
    )
    stage.run_sessions()
    engine = stage.uninterrupted()
    print(
        f"uninterrupted: {engine.total_duration:.1f} s, {engine.events} events in {engine.files} files, a snapshot "
        f"every {engine.snapshot_interval:.2g} s",
        flush=True,
    )
    differences = stage.compare()
    print(f"sessions without an engine: {'other' if differences else 'the same'} events", flush=True)
    for number, outcome in enumerate(stage.killed(kills, keep=keep), 1):
        for line in kill_lines(engine, number, outcome):
            print(line, flush=True)
    print(recovery_line(stage.outcomes))
    return differences


def _counted(count: int, singular: str, plural: str) -> str:
    return f"{count} {singular if count == 1 else plural}"


def verdict(without_engine: list[str], killed: list[list[str]]) -> int:
    """Return the exit status, and print the differences if it is not 0.

    `without_engine` are the differences of sessions without an engine, `killed` those of each killed run, all from
    the uninterrupted run."""
    lines = [f"sessions without an engine: {line}" for line in without_engine]
    lines += [f"killed run {number}: {line}" for number, run_lines in enumerate(killed, 1) for line in run_lines]
    if lines:
        print("\n".join(["", "The events differ from those of the uninterrupted run.", *lines]))
    return DIFFERENCE_STATUS if lines else 0


def _check(options: argparse.Namespace, result_file: OutputFile | None) -> None:
    """Raise Failure for options that would otherwise fail only later."""
    recipe_named(options.recipe)
    if options.seconds is not None and options.seconds > MAX_WALK_TIME:
        raise Failure(f"--seconds {options.seconds:g}: {MAX_WALK_TIME:g} is the most")
    if options.seconds is not None and options.seconds < 1.0:
        raise Failure(f"--seconds {options.seconds:g}: a walk takes at least 1")
    if options.processes > options.wearers:
        raise Failure(f"--processes {options.processes}: more than there are wearers, {options.wearers}")
    if not (is_installed("bytewax") and is_installed("pyarrow")):
        where = "" if sys.version_info < (3, 13) else " on Python 3.11 or 3.12, the last that bytewax has a release for"
        raise Failure(f"the fleet needs bytewax and pyarrow: {install_hint('bytewax')}{where}")
    if options.out is not None and options.out.exists() and (not options.out.is_dir() or any(options.out.iterdir())):
        raise Failure(f"{options.out} is there already, and not an empty directory")
    if result_file is not None:
        check_outputs([result_file], [], force=options.force)
        check_writable(result_file.path, made=options.out)


@contextmanager
def _directory(options: argparse.Namespace) -> Iterator[Path]:
    """Yield the directory of the runs, DIR/runs or a temporary one; without --keep it is removed at the end."""
    is_new = options.out is not None and not options.out.exists()
    if options.out is not None:
        options.out.mkdir(parents=True, exist_ok=True)
        directory = options.out.resolve() / "runs"
        directory.mkdir()
    else:
        directory = Path(tempfile.mkdtemp(prefix="solepath-fleet-")).resolve()
    try:
        yield directory
    finally:
        if options.keep:
            print(f"what the runs wrote is in {directory}")
        else:
            shutil.rmtree(directory, ignore_errors=True)
            if is_new:
                with suppress(OSError):  # a directory that is not empty stays
                    directory.parent.rmdir()


def _copy_events(stage: DemoStage, out: Path) -> None:
    """Copy the events of the uninterrupted run to `out`, and print a command that shows them."""
    from shlex import quote

    events_directory = out / "events"
    shutil.copytree(stage.events, events_directory)
    files = f"{events_directory}/*.parquet".replace("'", "''")
    query = f"FROM '{files}' SELECT event, count(*) AS count GROUP BY event ORDER BY count DESC"
    print(f"\nThe events are in {printable(str(events_directory))}. To look at them (pip install duckdb):")
    print(printable(f"python -c {quote(f'import duckdb; print(duckdb.sql({query!r}))')}", max_length=5000))
