"""What the benchmarks measure with: the clock without the garbage collector, memory, and the machine's own line."""

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
    """Without the garbage collector, after it has run, as timeit has it."""
    gc.collect()
    gc.disable()
    yield
    gc.enable()


def seconds(work: Callable[[], object]) -> float:
    """The median time of RUNS runs."""
    found = []
    for _ in range(RUNS):
        with uncollected():
            started_at = perf_counter()
            work()
            found.append(perf_counter() - started_at)
    return median(found)


def held(make: Callable[[], object]) -> int:
    """Bytes that what is made holds."""
    gc.collect()
    tracemalloc.start()
    before = tracemalloc.get_traced_memory()[0]
    made = make()
    gc.collect()
    found = tracemalloc.get_traced_memory()[0] - before
    tracemalloc.stop()
    del made
    return found
