"""What the processes of a demonstration have in common: when they end, how Python collects, and what they used."""

from __future__ import annotations

import gc
import os
import sys
import threading
from typing import Any

ROOM = (100_000, 20, 100)
"""Thresholds of Python's garbage collector. A session makes no circles of objects that it drops, so there is next to
nothing to find, and thousands of sessions to look through: with Python's own thresholds that is a tenth of the time."""


def settle() -> None:
    """What was loaded and read by now stays, and is not looked through again."""
    gc.collect()
    gc.freeze()
    gc.set_threshold(*ROOM)


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
