"""Compares solepath with what others offer on the same samples: `python tests/bench/peers.py`. Asserts nothing.

In one run on the samples of one foot at 100 Hz it times the yardstick (yardstick.py), the attitude alone of vqf (as
Python and compiled), and all events of solepath, a sample at a time. Needs `pip install vqf`; a line says so where it
is not installed. Times are processor times of one thread, medians of five runs after one that is not counted.
"""

from __future__ import annotations

import os

for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
    os.environ[name] = "1"

from collections.abc import Callable  # noqa: E402
from statistics import median  # noqa: E402
from time import process_time  # noqa: E402
from typing import Any  # noqa: E402

import numpy as np  # noqa: E402
from measure import RUNS, machine, no_garbage_collection  # noqa: E402
from yardstick import UsualFilter  # noqa: E402

from solepath import Foot, Sample, Session  # noqa: E402
from solepath.emulate.routes.route import Route  # noqa: E402
from solepath.emulate.sensors.parts import LSM6DSOX  # noqa: E402
from solepath.emulate.wearers.walker import Walker  # noqa: E402

RATE = 100.0
"""Sampling rate, Hz."""
ROUTE = Route().stand(2.0).walk(50.0, 1.3).stop(2.0)
"""The walk of bench.py."""


def times_of(work: Callable[[], object], count: int, runs: int) -> list[float]:
    """Return the processor time of each run, microseconds a sample."""
    found = []
    for _ in range(runs):
        with no_garbage_collection():
            started_at = process_time()
            work()
            found.append((process_time() - started_at) / count * 1e6)
    return found


def feed_all(make: Callable[[], Any], samples: list[Sample]) -> None:
    """Feed every sample to a new object."""
    feed = make().feed
    for sample in samples:
        feed(sample)


def attitudes(samples: list[Sample]) -> dict[str, Callable[[], object]]:
    """Return what vqf is timed with, by row: the attitude alone."""
    from vqf import VQF, PyVQF

    acc, gyro = np.array([sample.acc for sample in samples]), np.array([sample.gyro for sample in samples])

    def update(make: Any) -> None:
        one = make(1.0 / RATE)
        for force, rate in zip(acc, gyro, strict=True):
            one.update(rate, force)

    return {
        "PyVQF, attitude alone, a sample at a time": lambda: update(PyVQF),
        "VQF, compiled, attitude alone, a sample at a time": lambda: update(VQF),
        "VQF, compiled, attitude alone, all at once": lambda: VQF(1.0 / RATE).updateBatch(gyro, acc),
    }


def main() -> None:
    samples: list[Sample] = Walker(ROUTE, seed=1).samples(Foot.LEFT, RATE, LSM6DSOX)
    rows: dict[str, Callable[[], object]] = {
        "yardstick: numpy, nine states, SHOE, the usual way": lambda: feed_all(UsualFilter, samples),
        "solepath, all events, a sample at a time": lambda: feed_all(Session, samples),
    }
    try:
        rows |= attitudes(samples)
    except ImportError:
        print("vqf is not installed")
    print(f"{machine()}, one used; medians of {RUNS}; {len(samples)} samples of one foot")
    width, yardstick = max(map(len, rows)), 0.0
    for name, work in rows.items():
        _, *times = times_of(work, len(samples), RUNS + 1)
        yardstick = yardstick or median(times)
        print(f"{name:{width}}  {median(times):8.2f} us a sample {median(times) / yardstick:8.3f}")


if __name__ == "__main__":
    main()
