"""Shows a progress bar on stderr when that is a terminal."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from time import monotonic

EVERY = 0.1
"""Time between two updates of the bar, s."""


@contextmanager
def progress_bar(what: str, total: int, *, enabled: bool = True) -> Iterator[Callable[[int], None]]:
    """Yield a function that takes how much of `total` is done.

    It shows nothing when stderr is no terminal, when rich (the `live` extra) is not installed, or when it is not
    `enabled`."""
    if not enabled or not sys.stderr.isatty():
        yield _ignore
        return
    try:
        from rich.console import Console
        from rich.progress import Progress
    except ImportError:
        yield _ignore
        return
    # text that is printed meanwhile goes above the bar, unless stdout is a file
    lifted = sys.stdout.isatty()
    with Progress(console=Console(stderr=True), transient=True, redirect_stdout=lifted) as bar:
        task = bar.add_task(what, total=total)
        shown = 0.0

        def show(done: int) -> None:
            nonlocal shown
            if (now := monotonic()) - shown > EVERY:
                shown = now
                bar.update(task, completed=done)

        yield show


def _ignore(done: int) -> None:
    """Do nothing, where no bar is shown."""
