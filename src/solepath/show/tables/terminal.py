"""Live pictures in a terminal, drawn with rich (the `live` extra)."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from time import monotonic, sleep

from rich.console import Console, Group
from rich.live import Live
from rich.panel import Panel
from rich.table import Table
from rich.text import Text

from ...lab.emulated.demo import Demo
from ...types import Foot, Phase
from ..monitor import Monitor
from .plot import plot
from .status import status
from .summary import link_health, worn
from .table import number

FRAMES = 12.0
"""Pictures a second."""
PLOT = (72, 18)
COLOURS = {Phase.LOADING: "yellow", Phase.STATIONARY: "green", Phase.PUSH_OFF: "magenta", Phase.SWING: "cyan"}


class Screen:
    """A picture that is redrawn as a session goes on; `show` is cheap as long as no new one is due."""

    def __init__(self, live: Live) -> None:
        self._live = live
        self._drawn = -1.0

    def show(self, monitor: Monitor, title: str) -> None:
        if monotonic() - self._drawn > 1.0 / FRAMES:
            self.draw(monitor, title)

    def draw(self, monitor: Monitor, title: str) -> None:
        self._live.update(picture(monitor, title), refresh=True)
        self._drawn = monotonic()


@contextmanager
def screen(console: Console) -> Iterator[Screen]:
    """A screen that is wiped when this ends."""
    with Live(console=console, auto_refresh=False, transient=True) as live:
        yield Screen(live)


def play(demo: Demo, speed: float) -> None:
    """Play the walk at `speed` times real time, redrawn as it goes."""
    console = Console()
    began = monotonic()
    with screen(console) as shown:
        for packet in demo.play():
            if (ahead := packet.t / speed - (monotonic() - began)) > 0.5 / FRAMES:
                shown.draw(demo.monitor, _title(demo, speed))
                sleep(ahead)
            else:
                shown.show(demo.monitor, _title(demo, speed))
    console.print(picture(demo.monitor, _title(demo, speed)))


def _title(demo: Demo, speed: float) -> str:
    return f"{demo.monitor.now:5.1f} of {demo.duration:.1f} s, {speed:g} times real time"


def picture(monitor: Monitor, title: str) -> Group:
    """Both feet, the track and the links at this moment."""
    feet = Table.grid(expand=False, padding=(0, 3))
    for foot in Foot:
        feet.add_row(*_foot(monitor, foot))
    lines = plot(monitor.track, *PLOT)
    health = status(monitor) + worn(monitor.tally) + link_health(monitor.tally)
    return Group(
        Panel(feet, title=title, width=PLOT[0] + 4),
        Panel(Text("\n".join(lines)), title="track", width=PLOT[0] + 4),
        Panel(Text("\n".join(health)), title=f"link, {monitor.tally.packets} packets", width=PLOT[0] + 4),
    )


def _foot(monitor: Monitor, foot: Foot) -> tuple[Text, ...]:
    one = monitor.tally.foot(foot)
    phase = Text("-" if one.phase is None else one.phase.value.ljust(10))
    if one.phase is not None:
        phase.stylize(f"bold {COLOURS[one.phase]}")
    where = "" if one.position is None else "at " + " ".join(number(v).rjust(6) for v in one.position) + " m"
    return (Text(foot.value), phase, Text(f"{one.steps:3d} steps"), Text(f"{one.distance:6.2f} m"), Text(where))
