"""Measures a stream engine against bare sessions, for few and many wearers: `python tests/bench/fleet.py`.

It prints figures and asserts nothing. It takes four minutes on two idle processors, or half an hour and 4 GB of memory
with `--sizes 100 1000 10000`. It needs the extra `bytewax`. For every column it runs the job of
`solepath fleet-demo` with a recovery store. Then it runs sessions without an engine ("bare") on the same packets, in
as many processes. Before and after a column it times the yardstick of bench.py in one process.
"""

from __future__ import annotations

import argparse
import tempfile
from pathlib import Path
from statistics import median
from time import process_time

from attrs import evolve
from measure import RUNS, machine, no_garbage_collection
from yardstick import UsualFilter

from solepath import Foot
from solepath.cli.main import form
from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.parts import LSM6DSOX
from solepath.emulate.wearers.walker import Walker
from solepath.fleet import Sent, read_lines, sent_line
from solepath.fleet.demo.sending import count_samples
from solepath.fleet.demo.stage import Bare, DemoStage
from solepath.fleet.demo.wearers import DEMO_WALKS, LARGE_INSOLES, DemoPlan, Wearers
from solepath.show.tables.table import number, percent, table

ROWS = (
    "samples", "session, us a sample", "job, us a sample", "reading of lines, us a sample", "session, of the yardstick",
    "job, of the yardstick", "job and lines, of the yardstick", "live wearers a core: session",
    "live wearers a core: job", "live wearers a core: job and lines", "cores for 1000 live wearers: job and lines",
    "processors busy, %", "memory of a wearer, kB", "snapshots",
)  # fmt: skip
MAX_BARE_SESSIONS = 100
"""Largest number of bare sessions that are run; sessions are independent, so each costs the same in a larger number."""
SAMPLE_RATE = 2 * 100.0
"""Samples of both feet a second, Hz."""
TIMED_WEARERS = 20
"""Number of wearers whose lines are read to time that."""
NOTE = """\
Each wearer sends {seconds} s of {walk}, a second at a time over a poor
radio, as fast as the engine reads. One in 97 sends random bytes, one in ten loses rows. Snapshots: one every {every} s,
one more at the end. us: processor time, microseconds. Session: without an engine, one wearer after the other. Job: all
processes of the engine, with their sessions. Reading of lines: from JSON to rows, which this job does not do. Live
wearers a core: both feet at 100 Hz in real time, on a core that does nothing else. Busy: share of the run in which
the processes had a processor. Memory: growth, with rows in transit; "-" for few wearers (the engine's own is more)."""


def time_yardstick() -> float:
    """Return the median processor time of the yardstick, us a sample."""
    samples = Walker(Route().stand(2.0).walk(20.0, 1.3), seed=1).samples(Foot.LEFT, 100.0, LSM6DSOX)
    times = []
    for _ in range(RUNS):
        yardstick = UsualFilter()
        with no_garbage_collection():
            t_start = process_time()
            for sample in samples:
                yardstick.feed(sample)
            times.append(process_time() - t_start)
    return 1e6 * median(times) / len(samples)


def time_lines(stage: DemoStage) -> float:
    """Return the processor time to read the rows of a second of a wearer from lines, us a sample."""
    wearers = Wearers.read(stage.at)
    some = wearers.all[:TIMED_WEARERS]
    bundles = [wearer.bundle(n) for wearer in some for n in range(wearers.bundles)]
    texts = [[sent_line(one) for one in bundle if isinstance(one, Sent)] for bundle in bundles]
    t_start = process_time()
    for lines in texts:
        read_lines(lines)
    return 1e6 * (process_time() - t_start) / sum(count_samples(wearer.sending) for wearer in some)


def measure(plan: DemoPlan) -> list[str]:
    """Return the cells, in the order of ROWS, of one run of the engine and of bare sessions."""
    yardstick_times = [time_yardstick()]
    with tempfile.TemporaryDirectory(prefix="solepath-fleet-") as directory:
        stage = DemoStage(Path(directory), plan)
        stage.prepare()
        samples = sum(stage.samples)
        engine = stage.uninterrupted()
        lines = time_lines(stage)
        bare, n_bare_samples = (stage.run_sessions(), samples) if plan.wearers <= MAX_BARE_SESSIONS else _run_bare(plan)
    yardstick_times.append(time_yardstick())
    session, job = 1e6 * bare.cpu / n_bare_samples, 1e6 * engine.cpu / samples
    times, yardstick = (session, job, job + lines), median(yardstick_times)
    is_live = list(plan.walks) == [LARGE_INSOLES]
    wearers = [1e6 / SAMPLE_RATE / time if is_live else None for time in times]
    return [
        str(samples),
        *[number(time, 1) for time in (session, job, lines)],
        *[number(time / yardstick, 2) for time in times],
        *[number(count, 0) for count in wearers],
        number(1000.0 * SAMPLE_RATE * times[-1] / 1e6 if is_live else None, 0),
        percent(engine.cpu / engine.seconds / plan.parts, 0),
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
    parser.add_argument("--sizes", type=int, nargs="+", default=[100, 1000], help="wearers of the columns")
    parser.add_argument("--seconds", type=float, default=4.0, help="of walking")
    parser.add_argument("--processes", type=int, default=1)
    parser.add_argument("--every", type=float, default=10.0, help="s between two snapshots")
    parser.add_argument("--recipe", default="default")
    parser.add_argument("--walks", choices=("96", "demo"), default="96", help="96 cells, or the six of fleet-demo")
    options = parser.parse_args()
    walks = (LARGE_INSOLES,) if options.walks == "96" else DEMO_WALKS
    plans = [
        DemoPlan(n, options.seconds, 1, options.recipe, options.processes, every=options.every, walks=walks)
        for n in options.sizes
    ]
    columns = [measure(plan) for plan in plans]
    rows = [[name, *cells] for name, *cells in zip(ROWS, *columns, strict=True)]
    print(f"{machine()}, {form()} modules, processes of bytewax: {options.processes}\n")
    print(f"{table(('wearers', *map(str, options.sizes)), rows)}\n")
    walk = "walking with two insoles of 96 cells" if options.walks == "96" else "one of the six walks of the demo"
    print(NOTE.format(every=f"{options.every:g}", seconds=f"{options.seconds:g}", walk=walk))


if __name__ == "__main__":
    main()
