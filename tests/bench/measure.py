"""Shared tools of the benchmarks: a clock without the garbage collector, memory, and a line about the machine."""

from __future__ import annotations

import gc
import os
import platform
import tracemalloc
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from statistics import median
from time import perf_counter

RUNS = 5


def machine() -> str:
    return f"Python {platform.python_version()}, {platform.machine()}, {os.cpu_count()} cores"


@contextmanager
def uncollected() -> Iterator[None]:
    """Run the garbage collector and then switch it off in the block, as timeit does."""
    gc.collect()
    gc.disable()
    yield
    gc.enable()


def seconds(work: Callable[[], object]) -> float:
    """Return the median time of RUNS runs, s."""
    found = []
    for _ in range(RUNS):
        with uncollected():
            started_at = perf_counter()
            work()
            found.append(perf_counter() - started_at)
    return median(found)


def held(make: Callable[[], object]) -> int:
    """Return the bytes of memory that the made object holds."""
    gc.collect()
    tracemalloc.start()
    before = tracemalloc.get_traced_memory()[0]
    made = make()
    gc.collect()
    found = tracemalloc.get_traced_memory()[0] - before
    tracemalloc.stop()
    del made
    return found
