"""How a session goes, shown while it does."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from ...show.monitor import Monitor
from ...show.tables.status import status
from ..common.failure import is_there

REPORT_EVERY = 5.0
"""s between two lines where there is no terminal."""


@contextmanager
def shown(monitor: Monitor, title: str) -> Iterator[Callable[[], None]]:
    """How the session goes: a picture in a terminal that can draw one, else lines now and then."""
    if sys.stdout.isatty() and is_there("rich"):
        from rich.console import Console

        from ...show.tables.terminal import screen

        with screen(Console()) as drawn:
            yield lambda: drawn.show(monitor, title)
        return
    began: float | None = None
    due = REPORT_EVERY

    def report() -> None:
        nonlocal began, due
        began = monitor.now if began is None else began
        if monitor.now - began >= due:
            due += REPORT_EVERY
            print("\n".join(f"{monitor.now - began:6.1f} s  {line}" for line in status(monitor)), flush=True)

    yield report
