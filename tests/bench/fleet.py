"""Measures Spark in local mode against bare sessions: `python tests/bench/fleet.py`.

It prints figures and asserts nothing. It takes some minutes, needs the extra `spark` and Linux, whose /proc has the
processor time of each process. For every column it runs the job of `solepath fleet-demo`, with its checkpoint, and
sessions without an engine ("bare") on the same packets. Before and after a column it times the yardstick of bench.py.
"""

from __future__ import annotations

import argparse
import os
import tempfile
from contextlib import suppress
from pathlib import Path
from statistics import median
from time import process_time

from measure import RUNS, machine, no_garbage_collection
from yardstick import UsualFilter

from solepath import Foot
from solepath.cli.main import form
from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.parts import LSM6DSOX
from solepath.emulate.wearers.walker import Walker
from solepath.fleet.demo.run import DemoStage, EngineRun
from solepath.fleet.demo.wearers import LARGE_INSOLES, DemoPlan
from solepath.show.tables.table import number, percent, table

ROWS = (
    "samples", "session, us a sample", "job, us a sample", "session, of the yardstick", "job, of the yardstick",
    "live wearers a core: session", "live wearers a core: job", "cores for 1000 live wearers: job", "s a batch",
    "processors busy, %",
)  # fmt: skip
SAMPLE_RATE = 2 * 100.0
"""Samples of both feet a second, Hz."""
WARM_UP = 2
"""Number of batches before the time is taken: Java compiles its code in them."""
TICK = os.sysconf("SC_CLK_TCK")
NOTE = """\
Each wearer sends {seconds} s of walking with two insoles of 96 cells, a second at a time over a poor radio; each batch
of Spark holds a second of all wearers. One in 97 sends random bytes, one in ten loses rows. us: processor time,
microseconds. Session: without an engine, one wearer after the other. Job: Java and all Python processes of Spark after
the first {warm_up} batches, with sessions, lines of JSON, states, checkpoint and files. Live wearers a core: both feet
at 100 Hz in real time, on a core that does nothing else. Busy: share of the time in which the job had a processor."""


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


def read_times(session: int) -> dict[int, float]:
    """Return the processor time of each process of a session so far, s: Java's and Python's."""
    times = {}
    for path in Path("/proc").glob("[0-9]*/stat"):
        with suppress(OSError):  # it has ended in the meantime
            words = path.read_text().rpartition(")")[2].split()
            if int(words[3]) == session:
                times[int(path.parent.name)] = (int(words[11]) + int(words[12])) / TICK
    return times


def time_job(stage: DemoStage) -> tuple[float, float, int]:
    """Run the job; return the processor time and the duration after the warm-up, s, and the number of batches in it."""
    run = EngineRun(stage.at / "uninterrupted")
    start, now = 0.0, dict[int, float]()
    with run.started() as child:
        while not run.ended(child, 0.05):
            now |= read_times(child.pid)
            if len(run.batch_times()) >= WARM_UP and not start:
                start = sum(now.values())
    times = run.batch_times()[WARM_UP - 1 :]
    return sum(now.values()) - start, times[-1] - times[0], len(times) - 1


def measure(plan: DemoPlan) -> list[str]:
    """Return the cells, in the order of ROWS, of one run of the engine and of bare sessions."""
    yardstick_times = [time_yardstick()]
    with tempfile.TemporaryDirectory(prefix="solepath-fleet-") as directory:
        stage = DemoStage(Path(directory), plan)
        stage.prepare()
        stage.run_sessions()
        cpu, duration, batches = time_job(stage)
        bundles = [bundle for wearer in stage.wearers for bundle in enumerate(wearer.sending.bundles)]
        share = sum(len(rows) for n, rows in bundles if n >= WARM_UP) / sum(len(rows) for _, rows in bundles)
    yardstick_times.append(time_yardstick())
    times = [1e6 * stage.session_seconds / stage.samples, 1e6 * cpu / (share * stage.samples)]
    return [
        str(stage.samples),
        *[number(time, 1) for time in times],
        *[number(time / median(yardstick_times), 2) for time in times],
        *[number(1e6 / SAMPLE_RATE / time, 0) for time in times],
        number(1000.0 * SAMPLE_RATE * times[-1] / 1e6, 0),
        number(duration / batches, 2),
        percent(cpu / duration / plan.processes, 0),
    ]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--sizes", type=int, nargs="+", default=[100], help="wearers of the columns")
    parser.add_argument("--seconds", type=float, default=8.0, help="of walking")
    parser.add_argument("--processes", type=int, default=1)
    parser.add_argument("--recipe", default="default")
    options = parser.parse_args()
    plans = [
        DemoPlan(n, options.seconds, 1, options.recipe, options.processes, (LARGE_INSOLES,)) for n in options.sizes
    ]
    columns = [measure(plan) for plan in plans]
    rows = [[name, *cells] for name, *cells in zip(ROWS, *columns, strict=True)]
    print(f"{machine()}, {form()} modules, Python processes of Spark: {options.processes}\n")
    print(f"{table(('wearers', *map(str, options.sizes)), rows)}\n")
    print(NOTE.format(seconds=f"{options.seconds:g}", warm_up=WARM_UP))


if __name__ == "__main__":
    main()
