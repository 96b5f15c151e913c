"""Shared tools of the benchmarks: a clock without the garbage collector, memory, and a line about the machine."""

from __future__ import annotations

import gc
import os
import platform
import tracemalloc
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from statistics import median
from time import process_time

RUNS = 5


def machine() -> str:
    return f"Python {platform.python_version()}, {platform.machine()}, {os.cpu_count()} cores"


@contextmanager
def no_garbage_collection() -> Iterator[None]:
    """Run the garbage collector and then switch it off in the block, as timeit does."""
    gc.collect()
    gc.disable()
    yield
    gc.enable()


def seconds(work: Callable[[], object]) -> float:
    """Return the median processor time of RUNS runs, s."""
    times = []
    for _ in range(RUNS):
        with no_garbage_collection():
            started_at = process_time()
            work()
            times.append(process_time() - started_at)
    return median(times)


def measure_memory(make: Callable[[], object]) -> int:
    """Return the bytes of memory that the object made by `make` holds."""
    gc.collect()
    tracemalloc.start()
    before = tracemalloc.get_traced_memory()[0]
    made = make()
    gc.collect()
    size = tracemalloc.get_traced_memory()[0] - before
    tracemalloc.stop()
    del made
    return size
