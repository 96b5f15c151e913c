"""Shows on stderr how far a long computation is, when that is a terminal."""

from __future__ import annotations

import shutil
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from time import monotonic
from typing import TextIO

UPDATE_INTERVAL = 0.2
"""Time between two updates of the line, s; chosen by hand."""
FIRST_UPDATE = 1.0
"""Time for which nothing is shown, s: what is done by then needs no progress; chosen by hand."""
MIN_SHARE = 0.02
"""Least share done from which the remaining time is estimated; chosen by hand."""
ERASE = "\r\x1b[K"
"""Code that removes the line of the cursor."""
_LOCK, _FREE = threading.Lock(), threading.Semaphore()
"""Lock of the terminal, and what the one line of progress holds while it is there: an inner one shows nothing."""
_shown: list[str] = []
"""The line that is on the terminal now, if one is."""


def print_above(text: str, file: TextIO | None = None) -> None:
    """Print a text on stderr, or to a file; a line of progress comes again below it."""
    with _LOCK:
        _erase()
        print(text, file=file or sys.stderr, flush=True)


def _erase() -> None:
    if _shown:
        _write(ERASE)
    _shown.clear()


def _write(text: str) -> None:
    with suppress(OSError, ValueError):  # the terminal was closed
        sys.stderr.write(text)
        sys.stderr.flush()


def progress_text(what: str, done: int, total: int, elapsed: float) -> str:
    """Return the line of progress after `elapsed` seconds: name, percent and remaining time, or the time so far."""
    share = min(1.0, done / max(total, 1))
    if share == 0.0:
        return f"{what}: {elapsed:.0f} s"
    left = f", about {elapsed * (1.0 - share) / share:.0f} s left" if share >= MIN_SHARE else ""
    return f"{what}: {100.0 * share:.0f} %{left}"


@contextmanager
def progress_bar(what: str, total: int = 0) -> Iterator[Callable[[int], None]]:
    """Yield a function that takes how many of `total` units are done; `total` 0 shows the time so far.

    After FIRST_UPDATE a line with the name `what` appears on stderr if that is a terminal; it is removed at the end.
    Whatever is printed meanwhile goes through `print_above`."""
    if not (sys.stderr.isatty() and _FREE.acquire(blocking=False)):
        yield lambda done: None
        return
    counts, stopped, start = [0], threading.Event(), monotonic()

    def redraw() -> None:
        wait = FIRST_UPDATE
        while not stopped.wait(wait):
            wait = UPDATE_INTERVAL
            text = progress_text(what, counts[-1], total, monotonic() - start)
            with _LOCK:
                _shown[:] = [text]
                _write(ERASE + text[: shutil.get_terminal_size().columns - 1])

    thread = threading.Thread(target=redraw, daemon=True)
    thread.start()
    try:
        yield lambda done: counts.__setitem__(0, done)
    finally:
        stopped.set()
        thread.join()
        _erase()
        _FREE.release()
