"""Shows a progress bar on stderr when that is a terminal."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from time import monotonic

UPDATE_INTERVAL = 0.1
"""Time between two updates of the bar, s."""


@contextmanager
def progress_bar(what: str, total: int, *, enabled: bool = True) -> Iterator[Callable[[int], None]]:
    """Yield a function that shows how many of `total` units are done, on a bar with the name `what`.

    Nothing is shown if `enabled` is false, stderr is not a terminal, or rich (the `live` extra) is not installed."""
    if not enabled or not sys.stderr.isatty():
        yield _ignore
        return
    try:
        from rich.console import Console
        from rich.progress import Progress
    except ImportError:
        yield _ignore
        return
    # rich prints text for a terminal above the bar; text for a file must stay as it is
    redirect_stdout = sys.stdout.isatty()
    with Progress(console=Console(stderr=True), transient=True, redirect_stdout=redirect_stdout) as bar:
        task = bar.add_task(what, total=total)
        updated_at = 0.0

        def show(done: int) -> None:
            nonlocal updated_at
            if (now := monotonic()) - updated_at > UPDATE_INTERVAL:
                updated_at = now
                bar.update(task, completed=done)

        yield show


def _ignore(done: int) -> None:
    """Do nothing, since no bar is shown."""
