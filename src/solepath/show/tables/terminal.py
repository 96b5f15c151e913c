"""Draws live pictures in a terminal with rich (the `live` extra)."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from time import monotonic

from rich.console import Console, Group
from rich.live import Live
from rich.panel import Panel
from rich.table import Table
from rich.text import Text

from ...types import Foot, Phase
from ..observer import FootCounts, Observer
from .plot import plot
from .summary import link_health, status, wear_lines
from .table import number

FRAMES = 12.0
"""Pictures a second."""
PLOT = (72, 18)
"""Width and height of the plot of the track, characters."""
COLOURS = {Phase.LOADING: "yellow", Phase.STATIONARY: "green", Phase.PUSH_OFF: "magenta", Phase.SWING: "cyan"}


class Screen:
    """A picture that is redrawn as a session goes on; `show` is cheap as long as no new one is due."""

    def __init__(self, live: Live) -> None:
        self._live = live
        self._drawn = -1.0

    def show(self, observer: Observer, title: str) -> None:
        """Draw the picture when 1 / FRAMES s have passed since the last one."""
        if monotonic() - self._drawn > 1.0 / FRAMES:
            self.draw(observer, title)

    def draw(self, observer: Observer, title: str) -> None:
        """Draw the picture now."""
        self._live.update(picture(observer, title), refresh=True)
        self._drawn = monotonic()


@contextmanager
def screen(console: Console) -> Iterator[Screen]:
    """Yield a screen that is wiped at the end of the context."""
    with Live(console=console, auto_refresh=False, transient=True) as live:
        yield Screen(live)


def picture(observer: Observer, title: str) -> Group:
    """Return a picture of both feet, the track and the links at this moment."""
    feet = Table.grid(expand=False, padding=(0, 3))
    for foot in Foot:
        feet.add_row(*_foot(observer, foot))
    lines = plot(observer.track.points, *PLOT)
    health = status(observer) + wear_lines(observer) + link_health(observer)
    return Group(
        Panel(feet, title=title, width=PLOT[0] + 4),
        Panel(Text("\n".join(lines)), title="track", width=PLOT[0] + 4),
        Panel(Text("\n".join(health)), title=f"link, {observer.item_count} packets", width=PLOT[0] + 4),
    )


def _foot(observer: Observer, foot: Foot) -> tuple[Text, ...]:
    one = observer.feet.get(foot, FootCounts())
    phase = Text("-" if one.phase is None else f"{one.phase:10}")
    if one.phase is not None:
        phase.stylize(f"bold {COLOURS[one.phase]}")
    where = "" if one.position is None else "at " + " ".join(number(v).rjust(6) for v in one.position) + " m"
    return (Text(f"{foot}"), phase, Text(f"{one.strides:3d} steps"), Text(f"{one.distance:6.2f} m"), Text(where))
