"""Measures whether ten hours cost what a minute does: `python tests/bench/hours.py [--hours 10] [--every 30]`.

A minute of both feet with 96 cells is emulated once. Its samples are fed again and again, each time with later times.
The wearer ends the minute where it started, so the repetitions join without a jump. For the first two minutes, for one
in every `--every` and for the last it prints the processor time of a sample and the size of the session, as a snapshot
and in memory. At the end it compares the last minute with the second one, in which all parts of a session are active.
It is a soak run, not a test.
"""

from __future__ import annotations

import argparse
import gc
import json
from time import process_time

from attrs import evolve
from measure import measure_memory

from solepath import Calibration, Foot, Sample, Session, StrideTaken
from solepath.calibration import InsoleCalibration
from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.insoles import layout
from solepath.emulate.sensors.parts import LSM6DSOX
from solepath.emulate.wearers.walker import Walker

LOOP = Route().stand(1.0).walk(14.0, 1.3).turn(3.1416).walk(14.0).turn(3.1416).walk(14.0).stop(4.0)
CELLS = 96


def emulate_minute() -> list[Sample]:
    """Return the samples of both feet in order of time."""
    walker = Walker(LOOP, seed=1)
    found = [s for foot in Foot for s in walker.samples(foot, 100.0, LSM6DSOX, layout=layout(CELLS, foot))]
    return sorted(found, key=lambda sample: sample.t)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--hours", type=float, default=10.0)
    parser.add_argument("--every", type=int, default=30, help="minutes from one line to the next")
    options = parser.parse_args()
    loop = emulate_minute()
    length = loop[-1].t + 0.01
    count = max(3, round(options.hours * 3600.0 / length))
    calibration = Calibration(insoles={foot: InsoleCalibration(layout(CELLS, foot)) for foot in Foot})
    session = Session(calibration=calibration)
    measured: list[tuple[float, int, int]] = []
    print(f"{length:.1f} s of both feet with {CELLS} cells, {len(loop)} samples, {count} times")
    print(f"{'hour':>6} {'us a sample':>12} {'snapshot, B':>12} {'memory, kB':>11} {'strides':>7}")
    gc.collect()
    gc.disable()
    for k in range(count):
        samples = [evolve(sample, t=sample.t + k * length) for sample in loop]
        feed, steps = session.feed, 0
        started_at = process_time()
        for sample in samples:
            for event in feed(sample):
                steps += isinstance(event, StrideTaken)
        duration = (process_time() - started_at) / len(samples) * 1e6
        if k in (0, 1, count - 1) or k % options.every == 0:
            size = len(json.dumps(session.snapshot()))
            measured.append((duration, size, memory_of(session)))
            hour, memory = (k + 1) * length / 3600.0, measured[-1][2] / 1000
            print(f"{hour:6.2f} {duration:12.1f} {size:12} {memory:11.0f} {steps:7}", flush=True)
        gc.collect()
    time, snapshot, memory = (last / second for last, second in zip(measured[-1], measured[1], strict=True))
    print(f"the last beside the second: time {time:.2f}, snapshot {snapshot:.2f}, memory {memory:.2f}")


def memory_of(session: Session) -> int:
    """Return the bytes of memory of a session that is restored from the snapshot of `session`."""
    saved = session.snapshot()
    return measure_memory(lambda: Session.restore(saved))


if __name__ == "__main__":
    main()
