"""`solepath fleet-demo`: runs emulated wearers on Spark, which is killed, and compares the events.

The durations below were chosen by hand; other values were not tried."""

from __future__ import annotations

import os
import shutil
from argparse import Namespace
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

from attrs import asdict
from attrs.filters import exclude

from ..recording import printable
from .common.failure import Failure, parse_count, parse_number, parse_whole_number, require, tell
from .common.files import FLEET_FIGURES, OutputFile, add_force, check_outputs, write_json
from .common.inputs import recipe_option
from .common.parser import command, option

if TYPE_CHECKING:
    from ..fleet.demo.run import DemoStage

DIFFERENCE_STATUS = 1
"""Exit status when the events of two runs differ."""
DEFAULT_TOTAL_TIME, MIN_DEFAULT_TIME, MAX_DEFAULT_TIME = 1200.0, 6.0, 20.0
"""Default walking time of all wearers together, and the least and the greatest default of each wearer, s."""


def run(options: Namespace) -> int:
    """Run the demo; return the exit status."""
    result_file = None if options.json is None else OutputFile(options.json, FLEET_FIGURES)
    _check(options, result_file)
    from ..fleet.demo.run import DemoStage
    from ..fleet.demo.wearers import DemoPlan
    from .common.loop import stop_signals_raise

    seconds = options.seconds or min(max(DEFAULT_TOTAL_TIME / options.wearers, MIN_DEFAULT_TIME), MAX_DEFAULT_TIME)
    plan = DemoPlan(options.wearers, seconds, options.seed, options.recipe, options.processes)
    with stop_signals_raise(), TemporaryDirectory(prefix="solepath-fleet-") as directory:
        stage = DemoStage(Path(directory).resolve(), plan)
        differences = run_all(stage, options.kills)
        print(f"\n{result_table(stage)}")
        if result_file is not None:
            write_json(result_file, {**figures(stage), "differences": differences})
        if options.out is not None:
            _copy_events(stage, options.out)
    if differences:
        print("\n".join(["", "The events differ.", *differences]))
    return DIFFERENCE_STATUS if differences else 0


def run_all(stage: DemoStage, kills: int) -> list[str]:
    """Do all runs, print each as it ends, and return how their events differ."""
    plan = stage.plan
    stage.prepare()
    print(f"{plan.wearers} wearers, each walks {plan.seconds:g} s: {stage.samples} samples", flush=True)
    stage.run_sessions()
    print(f"sessions without an engine: {stage.session_seconds:.1f} s of processor time", flush=True)
    differences = [f"sessions without an engine: {line}" for line in stage.uninterrupted()]
    same = "other" if differences else "the same"
    print(
        f"uninterrupted: {stage.whole:.1f} s, {len(stage.times)} batches, {len(stage.events)} events: {same} events",
        flush=True,
    )
    if kills:
        killed = stage.killed(kills)
        for number, (kill, down) in enumerate(stage.kills, 1):
            rest = ", in the middle of the next, which runs again" if kill.is_in_batch else ""
            print(
                f"kill {number}: after {kill.batches} of {len(stage.times)} batches{rest}; the next batch ends "
                f"{down:.1f} s later"
            )
        print(f"killed {len(stage.kills)} times: {'other' if killed else 'the same'} events", flush=True)
        differences += [f"killed run: {line}" for line in killed]
    return differences


def _check(options: Namespace, result_file: OutputFile | None) -> None:
    """Raise Failure for options that would otherwise fail only later."""
    require("the fleet needs", "spark", "pyspark")
    from ..fleet.jvm import java_environment

    java_environment()
    if not hasattr(os, "killpg"):
        raise Failure("fleet-demo kills groups of processes, which this system does not have: use Linux or macOS")
    if options.out is not None and options.out.exists() and (not options.out.is_dir() or any(options.out.iterdir())):
        raise Failure(f"{options.out} is there already, and not an empty directory")
    if result_file is not None:
        check_outputs(options, [result_file])


def _copy_events(stage: DemoStage, out: Path) -> None:
    """Copy the events of the uninterrupted run to `out`, and print a command that shows them."""
    from shlex import quote

    from ..fleet.spark_files import committed

    events_directory = out / "events"
    events_directory.mkdir(parents=True)
    for path in committed(stage.at / "uninterrupted" / "events"):
        shutil.copy(path, events_directory)
    files = f"{events_directory}/*.parquet".replace("'", "''")
    query = f"FROM '{files}' SELECT event, count(*) AS count GROUP BY event ORDER BY count DESC"
    print()
    tell(f"The events are in {events_directory}. To look at them (pip install duckdb):")
    print(printable(f"python -c {quote(f'import duckdb; print(duckdb.sql({query!r}))')}", max_length=5000))


def result_table(stage: DemoStage) -> str:
    """Return the table of the figures of all runs, with a dash for a missing figure."""
    from ..show.tables.table import number, percent, table

    values = figures(stage)
    engine, kills = values["engine"], values["kills"]
    downs = [kill["down"] for kill in kills]
    rows = [
        ["wearers", str(values["wearers"])],
        ["samples", str(values["samples"])],
        [f"samples/s through Spark, {values['processes']} processes", number(engine["rate"], 0)],
        ["samples/s by one process of sessions without an engine", number(values["sessions"]["rate"], 0)],
        ["the one by the other, %", percent(values["ratio"], 0)],
        ["batches", str(engine["batches"])],
        ["s a batch", number(engine["batch"], 2)],
        ["events", str(engine["events"])],
        ["kills", str(len(kills))],
        ["of them in the middle of a batch", str(sum(kill["is_in_batch"] for kill in kills))],
        ["s until the next batch was done: mean", number(sum(downs) / len(downs) if downs else None, 1)],
        ["s until the next batch was done: most", number(max(downs, default=None), 1)],
    ]
    return table(["a fleet on Spark", ""], rows)


def figures(stage: DemoStage) -> dict[str, Any]:
    """Return the figures of all runs for programs, in s, bytes and samples/s."""
    rate = stage.samples / stage.session_seconds
    return {
        **asdict(stage.plan, filter=exclude("walks")),
        "samples": stage.samples,
        "engine": {
            "rate": stage.rate,
            "whole": stage.whole,
            "batches": len(stage.times),
            "batch": stage.batch,
            "events": len(stage.events),
        },
        "sessions": {"seconds": stage.session_seconds, "rate": rate},
        "ratio": stage.rate / rate,
        "kills": [{**asdict(kill), "down": down} for kill, down in stage.kills],
    }


add_fleet_demo = command(
    "fleet-demo",
    "Emulated wearers, whose packets come late, twice and out of order, walk through Spark Structured "
    "Streaming on this machine, which keeps the state of their sessions. Its processes are killed at random "
    "moments (kill -9) and started again. The events must equal those of an uninterrupted run, and those of "
    "sessions without an engine. Exit status 1 when they do not.",
    "solepath fleet-demo --wearers 40 --kills 3 --out fleet",
    option("--wearers", metavar="N", type=parse_count, default=100, help="how many wearers (default: 100)"),
    option("--kills", metavar="K", type=parse_whole_number, default=3, help="how many kills (default: 3)"),
    option(
        "--seconds",
        metavar="S",
        type=partial(parse_number, "a number of seconds from 1 to 3600", 1.0, 3600.0),
        help=f"how long each wearer walks, s (default: {MIN_DEFAULT_TIME:g} for "
        f"{DEFAULT_TOTAL_TIME / MIN_DEFAULT_TIME:.0f} wearers and more, up to {MAX_DEFAULT_TIME:g} for fewer)",
    ),
    recipe_option("recipe of the sessions"),
    option("--seed", metavar="X", type=parse_whole_number, default=1, help="other wearers, other kills (default: 1)"),
    option(
        "--processes",
        metavar="P",
        type=parse_count,
        default=min(2, os.cpu_count() or 1),
        help="Python processes of Spark (default: 2, where there are two processors)",
    ),
    option("--out", metavar="DIR", type=Path, help="leave the events there, as Parquet in DIR/events"),
    option("--json", metavar="FILE", type=Path, help="write the figures as JSON too"),
    add_force,
    run=run,
)
