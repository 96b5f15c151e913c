"""Shows on stderr how far a long computation is, when that is a terminal."""

from __future__ import annotations

import shutil
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from time import monotonic
from typing import Any, TextIO, cast

UPDATE_INTERVAL = 0.2
"""Time between two updates of the line, s; chosen by hand."""
FIRST_UPDATE = 1.0
"""Time for which nothing is shown, s: what is done by then needs no progress; chosen by hand."""
MIN_SHARE = 0.02
"""Least share done from which the remaining time is estimated; chosen by hand."""
ERASE = "\r\x1b[K"
"""Code that removes the line of the cursor."""


class _ProgressLine:
    """The line of progress at the bottom of a terminal, which a thread of its own redraws."""

    def __init__(self, terminal: TextIO, what: str, total: int) -> None:
        self.done, self._what, self._total = 0, what, total
        self._terminal, self._start = terminal, monotonic()
        self._is_drawn, self._is_at_margin = False, True
        self._lock, self._stopped = threading.Lock(), threading.Event()
        self._thread = threading.Thread(target=self._redraw, daemon=True)
        self._thread.start()

    def _redraw(self) -> None:
        wait = FIRST_UPDATE
        while not self._stopped.wait(wait):
            wait = UPDATE_INTERVAL
            with self._lock:
                if self._is_at_margin and not self._stopped.is_set():
                    text = progress_text(self._what, self.done, self._total, monotonic() - self._start)
                    self._write(ERASE + text[: shutil.get_terminal_size().columns - 1])
                    self._is_drawn = True

    def _write(self, text: str) -> None:
        with suppress(OSError, ValueError):  # the terminal was closed
            self._terminal.write(text)
            self._terminal.flush()

    def print_above(self, stream: TextIO, text: str) -> int:
        """Write text of the program to a stream, so that the line is below it."""
        with self._lock:
            self._erase()
            count = stream.write(text)
            stream.flush()
            self._is_at_margin = text.endswith("\n") if text else self._is_at_margin
        return count

    def _erase(self) -> None:
        if self._is_drawn:
            self._write(ERASE)
        self._is_drawn = False

    def stop(self) -> None:
        """Remove the line."""
        self._stopped.set()
        self._thread.join()
        self._erase()


class _Above:
    """A stream of text whose output appears above the line of progress."""

    def __init__(self, line: _ProgressLine, stream: TextIO) -> None:
        self._line, self._stream = line, stream

    def write(self, text: str) -> int:
        return self._line.print_above(self._stream, text)

    def __getattr__(self, name: str) -> Any:
        return getattr(self._stream, name)


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

    After FIRST_UPDATE a line with the name `what` appears on stderr if that is a terminal; it is removed at the end."""
    stdout, stderr = sys.stdout, sys.stderr
    if not stderr.isatty() or isinstance(stderr, _Above):
        yield lambda done: None
        return
    line = _ProgressLine(stderr, what, total)
    try:
        # text for a file stays as it is; text for a terminal appears above the line
        if stdout.isatty():
            sys.stdout = cast(TextIO, _Above(line, stdout))
        sys.stderr = cast(TextIO, _Above(line, stderr))
        yield lambda done: setattr(line, "done", done)
    finally:
        sys.stdout, sys.stderr = stdout, stderr
        line.stop()
