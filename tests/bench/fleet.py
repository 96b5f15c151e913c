"""Measures a stream engine against bare sessions, for few and many wearers: `python tests/bench/fleet.py`.

It prints ratios and asserts nothing. It takes two minutes on two idle processors, or half an hour and 4 GB of memory
with `--sizes 100 1000 5000 20000`. It needs the extra `bytewax`. For every line it runs the job of `solepath
fleet-demo` with a recovery store. Then it runs sessions without an engine ("bare") on the same packets in as many
processes. All wearers walk for the same time, so that lines can be compared: a sample of standing or of the first
strides takes another time.
"""

from __future__ import annotations

import argparse
import tempfile
from pathlib import Path

from attrs import evolve
from measure import machine

from solepath.fleet.demo.stage import Bare, DemoStage
from solepath.fleet.demo.wearers import DemoPlan
from solepath.show.tables.table import number, percent, table

COLUMNS = (
    "wearers", "samples", "us a sample: engine", "us: bare session", "share, %", "wearers a core", "kB a wearer",
    "snapshots",
)  # fmt: skip
MAX_BARE_SESSIONS = 1000
"""Largest number of bare sessions that are run; sessions are independent, so each costs the same in a larger number."""
SAMPLE_RATE = 2 * 100.0
"""Samples of both feet a second, Hz."""
NOTE = """\
Each wearer sends {seconds} s of one of the six walks of `solepath fleet-demo`, a second at a time, as fast as the
engine reads. A snapshot every {every} s (bytewax's default: 10 s) and one at the end.
us: processor time, microseconds. Bare: without an engine, one wearer after the other. Share: samples/s with the engine
divided by samples/s of bare sessions in as many processes. Wearers a core: both feet at 100 Hz, in real time, with the
engine. kB a wearer: growth of memory, with rows in transit; "-" for few wearers, as the engine's own would dominate."""


def measure_row(plan: DemoPlan) -> list[str]:
    """Return the row of one run of the engine and of bare sessions."""
    with tempfile.TemporaryDirectory(prefix="solepath-fleet-") as directory:
        stage = DemoStage(Path(directory), plan)
        stage.prepare()
        samples = sum(stage.samples)
        engine = stage.uninterrupted()
        bare, n_bare_samples = (stage.run_sessions(), samples) if plan.wearers <= MAX_BARE_SESSIONS else _run_bare(plan)
    rate = samples / engine.seconds
    return [
        str(plan.wearers),
        str(samples),
        number(1e6 * engine.cpu / samples, 1),
        number(1e6 * bare.cpu / n_bare_samples, 1),
        percent(rate / bare.rate, 0),
        number(rate / plan.parts / SAMPLE_RATE, 0),
        number(None if stage.memory is None else stage.memory / 1e3, 0),
        str(engine.snapshots),
    ]


def _run_bare(plan: DemoPlan) -> tuple[Bare, int]:
    with tempfile.TemporaryDirectory(prefix="solepath-fleet-") as directory:
        fewer = DemoStage(Path(directory), evolve(plan, wearers=MAX_BARE_SESSIONS))
        fewer.prepare()
        return fewer.run_sessions(), sum(fewer.samples)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--sizes", type=int, nargs="+", default=[100, 1000], help="wearers of the lines")
    parser.add_argument("--seconds", type=float, default=4.0, help="of walking")
    parser.add_argument("--processes", type=int, default=2)
    parser.add_argument("--every", type=float, default=10.0, help="s between two snapshots")
    parser.add_argument("--recipe", default="default")
    options = parser.parse_args()
    plans = [
        DemoPlan(n, options.seconds, recipe=options.recipe, parts=options.processes, every=options.every)
        for n in options.sizes
    ]
    rows = [measure_row(plan) for plan in plans]
    print(f"{machine()}, {options.processes} processes of bytewax\n\n{table(COLUMNS, rows)}\n")
    print(NOTE.format(every=f"{options.every:g}", seconds=f"{options.seconds:g}"))


if __name__ == "__main__":
    main()
