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

from ...events import HeelStrike
from ...types import Foot, Phase
from ...walk.walk import GAIT_EVENTS, FootCounts, Walk
from ..findings import Concern, texts
from .plot import plot
from .summary import status

FRAME_RATE = 12.0
"""Largest number of pictures a second; chosen by hand."""
PLOT_SIZE = (72, 18)
"""Width and height of the plot of the track, characters."""
PHASE_COLOURS = {Phase.LOADING: "yellow", Phase.STATIONARY: "green", Phase.PUSH_OFF: "magenta", Phase.SWING: "cyan"}


class Screen:
    """A picture in the terminal that is redrawn while a session runs."""

    def __init__(self, live: Live) -> None:
        self._live = live
        self._drawn_at = -1.0

    def show(self, walk: Walk, title: str) -> None:
        """Draw the picture if 1 / FRAME_RATE s have passed since the last one."""
        if monotonic() - self._drawn_at > 1.0 / FRAME_RATE:
            self.draw(walk, title)

    def draw(self, walk: Walk, title: str) -> None:
        """Draw the picture now."""
        self._live.update(picture(walk, title), refresh=True)
        self._drawn_at = monotonic()


@contextmanager
def screen(console: Console) -> Iterator[Screen]:
    """Yield a screen that is cleared at the end of the context."""
    with Live(console=console, auto_refresh=False, transient=True) as live:
        yield Screen(live)


def picture(walk: Walk, title: str) -> Group:
    """Return a picture of both feet, the track and the links at this moment."""
    feet = Table.grid(expand=False, padding=(0, 3))
    for foot in Foot:
        feet.add_row(*_foot(walk, foot))
    health = status(walk) + texts(walk, Concern.WEAR, Concern.LINK)
    return Group(
        Panel(feet, title=title, width=PLOT_SIZE[0] + 4),
        Panel("\n".join(plot(walk.track, *PLOT_SIZE)), title="track", width=PLOT_SIZE[0] + 4),
        Panel(Text("\n".join(health)), title=f"link, {walk.item_count} packets", width=PLOT_SIZE[0] + 4),
    )


def _foot(walk: Walk, foot: Foot) -> tuple[str, ...]:
    counts = walk.feet.get(foot, FootCounts())
    phase = "-" if counts.phase is None else f"[bold {PHASE_COLOURS[counts.phase]}]{counts.phase:10}[/]"
    position = "" if counts.position is None else "at " + " ".join([f"{v:6.2f}" for v in counts.position]) + " m"
    way = (f"{counts.strides:3d} strides", f"{counts.distance:6.2f} m")
    return foot.value, phase, *(way if walk.has_strides(foot) else _contacts(counts)), position


def _contacts(counts: FootCounts) -> tuple[str, str]:
    """Return what is known of a foot without an inertial sensor: its contacts, and no distance."""
    return f"{counts.events[GAIT_EVENTS[HeelStrike]]:3d} heel-strikes", "- m"
