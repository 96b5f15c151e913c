"""How a session goes, shown while it does."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from ...show.observer import Observer
from ...show.tables.status import status

REPORT_EVERY = 5.0
"""s between two lines where there is no terminal."""


@contextmanager
def shown(observer: Observer, title: str) -> Iterator[Callable[[], None]]:
    """How the session goes: a picture in a terminal that can draw one, else lines now and then."""
    from importlib.util import find_spec

    if sys.stdout.isatty() and find_spec("rich") is not None:
        from rich.console import Console

        from ...show.tables.terminal import screen

        with screen(Console()) as drawn:
            yield lambda: drawn.show(observer, title)
        return
    began: float | None = None
    due = REPORT_EVERY

    def report() -> None:
        nonlocal began, due
        began = observer.now if began is None else began
        if observer.now - began >= due:
            due += REPORT_EVERY
            print("\n".join(f"{observer.now - began:6.1f} s  {line}" for line in status(observer)), flush=True)

    yield report
