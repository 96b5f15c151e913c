"""Compares solepath with what others offer on the same samples: `python tests/bench/peers.py`. Asserts nothing.

In one run on the samples of one foot at 100 Hz it times the yardstick (yardstick.py), its tuned form in numpy, the same
arithmetic in C, the attitude alone of vqf (as Python and compiled), and all events of solepath, a sample at a time. The
three forms of the filter end at the same place, or it stops. Needs `pip install vqf` and a C compiler `cc`; a line says
which is absent. Times are processor times of one thread, medians of five runs after one that is not counted.
With `--gaitmap DIR`, gaitmap's whole pipeline is timed too, on the same samples at once. It runs in an environment
that lab/gaitmap_walks.py makes in DIR.
"""

from __future__ import annotations

import os

for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
    os.environ[name] = "1"

import ctypes  # noqa: E402
import json  # noqa: E402
import shutil  # noqa: E402
import subprocess  # noqa: E402
import sys  # noqa: E402
from argparse import ArgumentParser  # noqa: E402
from collections.abc import Callable  # noqa: E402
from pathlib import Path  # noqa: E402
from statistics import median  # noqa: E402
from tempfile import TemporaryDirectory  # noqa: E402
from time import process_time  # noqa: E402
from typing import Any  # noqa: E402

import numpy as np  # noqa: E402
from measure import RUNS, machine, no_garbage_collection  # noqa: E402
from yardstick import (  # noqa: E402
    ACC_NOISE,
    GYRO_NOISE,
    SIGMA_ACC,
    SIGMA_GYRO,
    STATISTIC_LIMIT,
    WINDOW_SIZE,
    ZERO_VELOCITY,
    Array,
    UsualFilter,
    cross_matrix,
    matrix_of,
)

from solepath import Foot, Sample, Session  # noqa: E402
from solepath.emulate.routes.route import Route  # noqa: E402
from solepath.emulate.sensors.parts import LSM6DSOX  # noqa: E402
from solepath.emulate.wearers.walker import Walker  # noqa: E402
from solepath.types.vector import GRAVITY  # noqa: E402

RATE = 100.0
"""Sampling rate, Hz."""
ROUTE = Route().stand(2.0).walk(50.0, 1.3).stop(2.0)
"""The walk of bench.py."""


DOWN = np.array([0.0, 0.0, -GRAVITY])
SAME = 1e-9
"""Largest distance between the ends of two forms of the filter, m: they round differently."""


class TunedFilter:
    """The yardstick as somebody would write it who wants it fast, still in numpy.

    Constant matrices are made once, the attitude is a rotation matrix, SHOE one expression, and the gain a solution."""

    def __init__(self) -> None:
        self.first = UsualFilter()
        """Levels the attitude, and has the initial covariance."""
        self.velocity, self.position, self.t = np.zeros(3), np.zeros(3), 0.0
        self.turn: Array = np.eye(3)
        self.covariance = self.first.covariance
        self.step = np.eye(9)
        self.noise = np.repeat([0.0, ACC_NOISE**2, GYRO_NOISE**2], 3)
        self.measured = ZERO_VELOCITY**2 * np.eye(3)
        self.window = np.zeros((WINDOW_SIZE, 6))
        self.count = 0

    def feed(self, sample: Sample) -> None:
        motion = self.window[self.count % WINDOW_SIZE]
        motion[:3], motion[3:] = sample.acc, sample.gyro
        dt, self.t = sample.t - self.t, sample.t
        self.count += 1
        if self.count == 1:
            self.first.feed(sample)
            assert self.first.attitude is not None
            self.turn = matrix_of(self.first.attitude)
            return
        self.turn = self.turn @ rotation(motion[3:] * dt)
        force = self.turn @ motion[:3]
        acceleration = force + DOWN
        self.position += (self.velocity + 0.5 * dt * acceleration) * dt
        self.velocity += acceleration * dt
        self.step[0, 3] = self.step[1, 4] = self.step[2, 5] = dt
        self.step[3:6, 6:] = -dt * cross_matrix(force)
        self.covariance = self.step @ self.covariance @ self.step.T
        self.covariance.flat[::10] += dt * dt * self.noise
        if self.count >= WINDOW_SIZE and self.is_still():
            self.correct()

    def is_still(self) -> bool:
        acc, gyro = self.window[:, :3], self.window[:, 3:].ravel()
        mean = acc.sum(axis=0)
        residual = (acc - GRAVITY / (mean @ mean) ** 0.5 * mean).ravel()
        statistic = (residual @ residual) / SIGMA_ACC**2 + (gyro @ gyro) / SIGMA_GYRO**2
        return bool(statistic < STATISTIC_LIMIT * WINDOW_SIZE)

    def correct(self) -> None:
        rows = self.covariance[3:6]
        gain = np.linalg.solve(rows[:, 3:6] + self.measured, rows).T
        error = -(gain @ self.velocity)
        self.covariance = self.covariance - gain @ rows
        self.position += error[:3]
        self.velocity += error[3:6]
        self.turn = rotation(error[6:]) @ self.turn


def rotation(r: Array) -> Array:
    """Return the matrix of the rotation by |r| rad about r (Rodrigues)."""
    square = float(r @ r)
    angle, k = square**0.5, cross_matrix(r)
    if angle == 0.0:
        return np.eye(3)
    return np.eye(3) + np.sin(angle) / angle * k + (1.0 - np.cos(angle)) / square * (k @ k)


def filter_in_c(samples: list[Sample], folder: str) -> Callable[[], Array]:
    """Return what runs foot_filter.c, which is compiled into the folder; it returns the last position, m."""
    library = Path(folder, "foot_filter.so")
    flags = ["-O2", "-ffp-contract=off", "-shared", "-fPIC"]
    subprocess.run(["cc", *flags, Path(__file__).with_name("foot_filter.c"), "-o", library, "-lm"], check=True)
    feed_rows = ctypes.CDLL(str(library)).feed_all
    rows = np.array([[sample.t, *sample.acc, *sample.gyro] for sample in samples])
    position = np.zeros(3)

    def run() -> Array:
        feed_rows(ctypes.c_void_p(rows.ctypes.data), ctypes.c_long(len(rows)), ctypes.c_void_p(position.ctypes.data))
        return position

    return run


def times_of(work: Callable[[], object], count: int, runs: int) -> list[float]:
    """Return the processor time of each run, microseconds a sample."""
    found = []
    for _ in range(runs):
        with no_garbage_collection():
            started_at = process_time()
            work()
            found.append((process_time() - started_at) / count * 1e6)
    return found


def feed_all(make: Callable[[], Any], samples: list[Sample]) -> Any:
    """Feed every sample to a new object; return it."""
    one = make()
    feed = one.feed
    for sample in samples:
        feed(sample)
    return one


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


def rows_of(samples: list[Sample], folder: str) -> dict[str, Callable[[], object]]:
    """Return what is timed, by row; what is not installed is printed."""
    end = feed_all(UsualFilter, samples).position
    ends = {"numpy": feed_all(TunedFilter, samples).position}
    rows: dict[str, Callable[[], object]] = {
        "yardstick: numpy, nine states, SHOE, the usual way": lambda: feed_all(UsualFilter, samples),
        "the same, tuned": lambda: feed_all(TunedFilter, samples),
    }
    if shutil.which("cc"):
        run = rows["the same in C, all at once"] = filter_in_c(samples, folder)
        ends["C"] = run()
    else:
        print("no C compiler")
    for name, position in ends.items():
        assert np.linalg.norm(position - end) < SAME, f"the filter in {name} ends elsewhere"
    try:
        rows |= attitudes(samples)
    except ImportError:
        print("vqf is not installed: pip install vqf")
    return rows | {"solepath, all events, a sample at a time": lambda: feed_all(Session, samples)}


def time_gaitmap(environment: Path, samples: list[Sample], folder: str) -> float:
    """Return the median processor time of gaitmap's pipeline on the samples of a left foot, us a sample."""
    sys.path.append(str(Path(__file__).parent / "lab"))
    from gaitmap_walks import run_in

    path = Path(folder, "foot.npz")
    gyro = np.degrees([sample.gyro for sample in samples])
    np.savez(path, rate=RATE, left=np.hstack([[sample.acc for sample in samples], gyro]))
    done = run_in(environment.resolve(), "--time", path, stdout=subprocess.PIPE)
    return median(json.loads(done.stdout.splitlines()[-1]))


def main() -> None:
    parser = ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--gaitmap", type=Path, metavar="DIR", help="time gaitmap too, in an environment there")
    environment = parser.parse_args().gaitmap
    samples: list[Sample] = Walker(ROUTE, seed=1).samples(Foot.LEFT, RATE, LSM6DSOX)
    with TemporaryDirectory() as folder:
        rows = rows_of(samples, folder)
        print(f"{machine()}, one used; medians of {RUNS}; {len(samples)} samples of one foot")
        found = {name: median(times_of(work, len(samples), RUNS + 1)[1:]) for name, work in rows.items()}
        if environment:
            found["gaitmap, whole pipeline, all at once"] = time_gaitmap(environment, samples, folder)
        else:
            print("no gaitmap: --gaitmap DIR makes an environment there, with pip install gaitmap gaitmap_mad")
    width, (yardstick, *_) = max(map(len, found)), found.values()
    for name, time in found.items():
        print(f"{name:{width}}  {time:8.2f} us a sample {time / yardstick:8.3f}")


if __name__ == "__main__":
    main()
