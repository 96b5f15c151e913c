"""Compares solepath with what others offer on the same samples: `python tests/bench/peers.py`. Asserts nothing.

In one run on the samples of one foot at 100 Hz it times the yardstick (yardstick.py), the attitude alone of vqf (as
Python and compiled), gaitmap's search for strides and its two event detections on the whole recording at once, and all
events of solepath, a sample at a time. Needs `pip install vqf gaitmap gaitmap_mad`; what is not installed has a line
that says so. gaitmap_mad, which has the stride search, is under the AGPL and not used by solepath. Times are processor
times of one thread, medians of five runs; a first run of gaitmap, which compiles, is not counted, but printed.
"""

from __future__ import annotations

import os

for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "NUMBA_NUM_THREADS"):
    os.environ[name] = "1"

import warnings  # noqa: E402
from collections.abc import Callable  # noqa: E402
from math import degrees  # noqa: E402
from statistics import median  # noqa: E402
from time import process_time  # noqa: E402
from typing import Any  # noqa: E402

import numpy as np  # noqa: E402
from measure import RUNS, machine, no_garbage_collection  # noqa: E402
from yardstick import TunedFilter, UsualFilter  # noqa: E402

from solepath import Foot, Sample, Session  # noqa: E402
from solepath.emulate.routes.route import Route  # noqa: E402
from solepath.emulate.sensors.parts import LSM6DSOX  # noqa: E402
from solepath.emulate.wearers.walker import Walker  # noqa: E402

RATE = 100.0
"""Sampling rate, Hz."""
ROUTE = Route().stand(2.0).walk(50.0, 1.3).stop(2.0)
"""The walk of bench.py."""


def times_of(work: Callable[[], object], count: int, runs: int = RUNS) -> list[float]:
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


def strides_and_events(samples: list[Sample]) -> dict[str, Callable[[], object]]:
    """Return what gaitmap is timed with, by row: each needs the whole recording, and events need the strides."""
    import pandas as pd
    from gaitmap.event_detection import HerzerEventDetection, RamppEventDetection
    from gaitmap.stride_segmentation import BarthDtw
    from gaitmap.utils.coordinate_conversion import convert_left_foot_to_fbf

    rows = [(*sample.acc, *map(degrees, sample.gyro)) for sample in samples if sample.acc and sample.gyro]
    columns = [f"{sensor}_{axis}" for sensor in ("acc", "gyr") for axis in "xyz"]
    data = convert_left_foot_to_fbf(pd.DataFrame(rows, columns=columns))
    strides = BarthDtw().segment(data, sampling_rate_hz=RATE).stride_list_
    return {
        f"gaitmap BarthDtw, {len(strides)} strides": lambda: BarthDtw().segment(data, sampling_rate_hz=RATE),
        "gaitmap RamppEventDetection": lambda: RamppEventDetection().detect(data, strides, sampling_rate_hz=RATE),
        "gaitmap HerzerEventDetection": lambda: HerzerEventDetection().detect(data, strides, sampling_rate_hz=RATE),
    }


def main() -> None:
    warnings.simplefilter("ignore")
    samples: list[Sample] = Walker(ROUTE, seed=1).samples(Foot.LEFT, RATE, LSM6DSOX)
    rows: dict[str, Callable[[], object]] = {
        "yardstick: numpy, nine states, SHOE, the usual way": lambda: feed_all(UsualFilter, samples),
        "the same, tuned": lambda: feed_all(TunedFilter, samples),
        "solepath, all events, a sample at a time": lambda: feed_all(Session, samples),
    }
    missing = []
    for find in (attitudes, strides_and_events):
        try:
            rows |= find(samples)
        except ImportError as error:
            missing.append(f"not installed: {error.name or 'gaitmap_mad'}")
    print(f"{machine()}, one used; medians of {RUNS}; {len(samples)} samples of one foot")
    width, yardstick = max(map(len, rows)), 0.0
    for name, work in rows.items():
        first, *times = times_of(work, len(samples), RUNS + 1)
        yardstick = yardstick or median(times)
        compiles = f"  (first run {first:.0f} us)" if first > 5.0 * median(times) else ""
        print(f"{name:{width}}  {median(times):8.2f} us a sample {median(times) / yardstick:8.3f}{compiles}")
    print("\n".join(missing))


if __name__ == "__main__":
    main()
