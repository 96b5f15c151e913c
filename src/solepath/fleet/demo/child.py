"""What the processes of a demonstration have in common: when they end, how Python collects, and what they used."""

from __future__ import annotations

import gc
import os
import sys
import threading
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


def most_memory() -> int | None:
    """Bytes that this process held at its largest; None on systems that do not say."""
    resource: Any
    try:
        import resource
    except ImportError:
        return None
    unit = 1 if sys.platform == "darwin" else 1024
    return int(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss) * unit
