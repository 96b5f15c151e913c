"""Functions for the processes of a demonstration: end with the parent, garbage collection, and memory."""

from __future__ import annotations

import gc
import os
import sys
import threading
from pathlib import Path
from typing import Any


def freeze_garbage() -> None:
    """Keep all present objects for ever and exclude them from Python's garbage collection.

    The thresholds of the collection stay: reading packets makes reference cycles, so higher thresholds would cost
    memory and save no time."""
    gc.collect()
    gc.freeze()


def end_with_parent() -> None:
    """End this process when its parent ends in any way, which closes the pipe to our stdin."""

    def watch() -> None:
        while os.read(0, 1):
            pass
        os._exit(1)

    if not sys.stdin.isatty():
        threading.Thread(target=watch, daemon=True).start()


def memory() -> int | None:
    """Return the memory of this process now, bytes, or the largest so far if only that is known; None if unknown."""
    return _read_status("VmRSS") or most_memory()


def most_memory() -> int | None:
    """Return the largest memory of this process so far, bytes; None on systems that do not report it."""
    # on Linux, getrusage returns at least the largest memory of the parent process
    size = _read_status("VmHWM")
    if size is not None:
        return size
    resource: Any
    try:
        import resource
    except ImportError:
        return None
    unit = 1 if sys.platform == "darwin" else 1024
    return int(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss) * unit


def _read_status(key: str) -> int | None:
    """Return one value of this process's status in Linux, bytes; None on other systems."""
    try:
        lines = Path("/proc/self/status").read_text(encoding="utf-8").splitlines()
    except OSError:
        return None
    return next((int(line.split()[1]) * 1024 for line in lines if line.startswith(f"{key}:")), None)
