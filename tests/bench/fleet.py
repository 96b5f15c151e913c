"""What a stream engine costs beside bare sessions, and many wearers beside few: `python tests/bench/fleet.py`.

Prints ratios; asserts nothing. Needs the extra `bytewax`. Every line is a run of the job of `solepath fleet-demo` in
two processes with a recovery store, and right after it sessions alone in two processes over the same packets: each
wearer by himself, Session.feed alone on the clock. `--sizes 100 1000`: wearers of the lines. `--every`: s between two
snapshots, as long as bytewax has it by itself. At each, whoever is done waits for the others, so that processes of
different speed, or on processors that others use too, do better with rarer ones.
"""

from __future__ import annotations

import argparse
import tempfile
from pathlib import Path

from attrs import evolve

from solepath.fleet.demo.stage import Stage
from solepath.fleet.demo.wearers import Plan

COLUMNS = (
    "wearers", "samples", "engine/s", "bare/s", "%", "us a sample", "bare us", "cpu us", "cpu %", "kB a wearer",
    "state kB", "largest", "session", "snapshot us", "differences",
)  # fmt: skip


MOST_ALONE = 1000
"""Beyond so many the sessions alone are those of so many: each is by himself, so they cost the same."""


def line(plan: Plan) -> list[str]:
    """One run, and the sessions alone beside it."""
    with tempfile.TemporaryDirectory(prefix="solepath-fleet-") as directory:
        stage = Stage(Path(directory), plan)
        stage.prepare()
        engine, samples = stage.uninterrupted(), sum(stage.samples)
        bare = stage.bare() if plan.wearers <= MOST_ALONE else None
        differences = str(len(stage.compare())) if bare is not None else "-"
    if bare is None:
        with tempfile.TemporaryDirectory(prefix="solepath-fleet-") as directory:
            fewer = Stage(Path(directory), evolve(plan, wearers=MOST_ALONE))
            fewer.prepare()
            bare = fewer.bare()
            alone = sum(fewer.samples)
    else:
        alone = samples
    rate = samples / engine.seconds
    memory = None if engine.full is None or engine.empty is None else (engine.full - engine.empty) / plan.wearers
    return [
        str(plan.wearers),
        str(samples),
        f"{rate:.0f}",
        f"{bare.rate:.0f}",
        f"{100.0 * rate / bare.rate:.0f}",
        f"{1e6 * plan.parts / rate:.1f}",
        f"{1e6 * plan.parts / bare.rate:.1f}",
        f"{1e6 * engine.cpu / samples:.1f}",
        f"{100.0 * bare.cpu / alone * samples / engine.cpu:.0f}",
        "-" if memory is None else f"{memory / 1e3:.0f}",
        f"{bare.state / 1e3:.1f}",
        f"{bare.largest / 1e3:.1f}",
        f"{bare.session / 1e3:.1f}",
        f"{1e6 * bare.snapshot:.0f}",
        differences,
    ]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--sizes", type=int, nargs="+", default=[100, 1000])
    parser.add_argument("--seconds", type=float, default=4.0, help="of walking")
    parser.add_argument("--processes", type=int, default=2)
    parser.add_argument("--every", type=int, default=10, help="s between two snapshots")
    parser.add_argument("--bundle", type=float, default=1.0, help="s that a phone sends at a time")
    parser.add_argument("--recipe", default="default")
    asked = parser.parse_args()
    print(f"{asked.seconds:g} s of walking, {asked.processes} processes, a snapshot every {asked.every} s")
    print("  ".join(COLUMNS))
    for wearers in asked.sizes:
        plan = Plan(
            wearers, asked.seconds, recipe=asked.recipe, parts=asked.processes, bundle=asked.bundle, every=asked.every
        )
        print("  ".join(cell.rjust(len(name)) for name, cell in zip(COLUMNS, line(plan), strict=True)), flush=True)


if __name__ == "__main__":
    main()
