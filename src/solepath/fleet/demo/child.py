"""What the processes of a demonstration have in common: when they end, how Python collects, and what they used."""

from __future__ import annotations

import gc
import os
import sys
import threading
from pathlib import Path
from typing import Any


def settle() -> None:
    """What was loaded and read by now stays, and Python's garbage collector does not look through it again. Its
    thresholds stay as they are: reading packets drops circles of objects, so that higher ones cost memory and save
    nothing."""
    gc.collect()
    gc.freeze()


def end_with_parent() -> None:
    """End when whoever started this process ends, however it ends: its end of our stdin closes then."""

    def watch() -> None:
        while os.read(0, 1):
            pass
        os._exit(1)

    if not sys.stdin.isatty():
        threading.Thread(target=watch, daemon=True).start()


def memory() -> int | None:
    """Bytes that this process holds, or held at its largest until now where the system tells only that; None on
    systems that say neither."""
    return _told("VmRSS") or most_memory()


def most_memory() -> int | None:
    """Bytes that this process held at its largest; None on systems that do not say."""
    # what getrusage says on Linux is no less than what whoever started this process held at its largest
    told = _told("VmHWM")
    if told is not None:
        return told
    resource: Any
    try:
        import resource
    except ImportError:
        return None
    unit = 1 if sys.platform == "darwin" else 1024
    return int(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss) * unit


def _told(key: str) -> int | None:
    """What Linux says of this process, bytes."""
    try:
        lines = Path("/proc/self/status").read_text(encoding="utf-8").splitlines()
    except OSError:
        return None
    return next((int(line.split()[1]) * 1024 for line in lines if line.startswith(f"{key}:")), None)
