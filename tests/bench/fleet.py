"""Measures Spark in local mode against bare sessions: `python tests/bench/fleet.py`.

It prints figures and asserts nothing. It takes some minutes, needs the extra `spark` and Linux, whose /proc has the
processor time of each process. For every column it runs the job of `solepath fleet-demo`, with its checkpoint, and
sessions without an engine ("bare") on the same packets. Before and after a column it times the yardstick of bench.py.
"""

from __future__ import annotations

import argparse
import os
import tempfile
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
from solepath.fleet.demo.wearers import DEMO_WALKS, LARGE_INSOLES, DemoPlan
from solepath.show.tables.table import number, percent, table

ROWS = (
    "samples", "session, us a sample", "job, us a sample", "of that the Python processes, %",
    "session, of the yardstick", "job, of the yardstick", "live wearers a core: session", "live wearers a core: job",
    "cores for 1000 live wearers: job", "s a batch", "processors busy, %",
)  # fmt: skip
SAMPLE_RATE = 2 * 100.0
"""Samples of both feet a second, Hz."""
WARM_UP = 2
"""Number of batches before the time is taken: Java compiles its code in them."""
TICK = os.sysconf("SC_CLK_TCK")
NOTE = """\
Each wearer sends {seconds} s of {walk}, a second at a time over a poor
radio; each batch of Spark holds a second of all wearers. One in 97 sends random bytes, one in ten loses rows. us:
processor time, microseconds. Session: without an engine, one wearer after the other. Job: Java and all Python processes
of Spark after the first {warm_up} batches, with sessions, lines of JSON, states, checkpoint and files. Live wearers a
core: both feet at 100 Hz in real time, on a core that does nothing else. Busy: share of the time in which the
processes had the processors that they may use."""


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


class Clock:
    """The processor time of all processes of a job, s: Java's and Python's."""

    def __init__(self, session: int) -> None:
        self._session, self._times = session, dict[int, tuple[str, float]]()

    def read(self) -> dict[str, float]:
        """Return the time by program, with that of processes that have ended."""
        for path in Path("/proc").glob("[0-9]*/stat"):
            try:
                name, _, rest = path.read_text().rpartition(")")
            except OSError:
                continue
            words = rest.split()
            if int(words[3]) == self._session:
                self._times[int(path.parent.name)] = name.partition("(")[2], (int(words[11]) + int(words[12])) / TICK
        totals: dict[str, float] = {"java": 0.0, "python": 0.0}
        for name, seconds in self._times.values():
            totals["java" if "java" in name else "python"] += seconds
        return totals


def time_job(stage: DemoStage) -> tuple[dict[str, float], float, list[float]]:
    """Run the job; return the processor time after the warm-up by program, s, the duration of it, s, and all batches'
    times."""
    run = EngineRun(stage.at / "uninterrupted")
    start: dict[str, float] = {}
    with run.started():
        assert run.child is not None
        clock = Clock(run.child.pid)
        while not run.ended(0.05):
            now, batches = clock.read(), len(run.batch_times())
            if batches >= WARM_UP and not start:
                start = now
    times = run.batch_times()
    return {name: seconds - start[name] for name, seconds in now.items()}, times[-1] - times[WARM_UP - 1], times


def measure(plan: DemoPlan) -> list[str]:
    """Return the cells, in the order of ROWS, of one run of the engine and of bare sessions."""
    yardstick_times = [time_yardstick()]
    with tempfile.TemporaryDirectory(prefix="solepath-fleet-") as directory:
        stage = DemoStage(Path(directory), plan)
        stage.prepare()
        stage.run_sessions()
        cpu, duration, times = time_job(stage)
        bundles = [bundle for wearer in stage.wearers for bundle in enumerate(wearer.sending.bundles)]
        share = sum(len(rows) for n, rows in bundles if n >= WARM_UP) / sum(len(rows) for _, rows in bundles)
    yardstick_times.append(time_yardstick())
    session = 1e6 * stage.session_seconds / stage.samples
    job, yardstick = 1e6 * sum(cpu.values()) / (share * stage.samples), median(yardstick_times)
    is_live = list(plan.walks) == [LARGE_INSOLES]
    return [
        str(stage.samples),
        *[number(time, 1) for time in (session, job)],
        percent(cpu["python"] / sum(cpu.values()), 0),
        *[number(time / yardstick, 2) for time in (session, job)],
        *[number(1e6 / SAMPLE_RATE / time if is_live else None, 0) for time in (session, job)],
        number(1000.0 * SAMPLE_RATE * job / 1e6 if is_live else None, 0),
        number(duration / (len(times) - WARM_UP), 2),
        percent(sum(cpu.values()) / duration / plan.processes, 0),
    ]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--sizes", type=int, nargs="+", default=[100], help="wearers of the columns")
    parser.add_argument("--seconds", type=float, default=8.0, help="of walking")
    parser.add_argument("--processes", type=int, default=1)
    parser.add_argument("--recipe", default="default")
    parser.add_argument("--walks", choices=("96", "demo"), default="96", help="96 cells, or the six of fleet-demo")
    options = parser.parse_args()
    walks = (LARGE_INSOLES,) if options.walks == "96" else DEMO_WALKS
    plans = [DemoPlan(n, options.seconds, 1, options.recipe, options.processes, walks) for n in options.sizes]
    columns = [measure(plan) for plan in plans]
    rows = [[name, *cells] for name, *cells in zip(ROWS, *columns, strict=True)]
    print(f"{machine()}, {form()} modules, Python processes of Spark: {options.processes}\n")
    print(f"{table(('wearers', *map(str, options.sizes)), rows)}\n")
    walk = "walking with two insoles of 96 cells" if options.walks == "96" else "one of the six walks of the demo"
    print(NOTE.format(seconds=f"{options.seconds:g}", walk=walk, warm_up=WARM_UP))


if __name__ == "__main__":
    main()
