"""The demonstration in a terminal, drawn with rich (the `live` extra)."""

from __future__ import annotations

from time import monotonic, sleep

from rich.console import Console, Group
from rich.live import Live
from rich.panel import Panel
from rich.table import Table
from rich.text import Text

from ..demo import Demo
from ..types import Foot, Phase
from .plot import plot
from .summary import link_health
from .table import number

FRAMES = 12.0
"""Pictures a second."""
PLOT = (72, 18)
COLOURS = {Phase.LOADING: "yellow", Phase.STATIONARY: "green", Phase.PUSH_OFF: "magenta", Phase.SWING: "cyan"}


def show(demo: Demo, speed: float) -> None:
    """Play the walk at `speed` times real time, redrawn as it goes."""
    console = Console()
    began = monotonic()
    with Live(console=console, auto_refresh=False, transient=True) as live:
        drawn = 0.0
        for packet in demo.play():
            if (ahead := packet.t / speed - (monotonic() - began)) > 0.5 / FRAMES:
                live.update(picture(demo, speed), refresh=True)
                drawn = monotonic()
                sleep(ahead)
            elif monotonic() - drawn > 1.0 / FRAMES:
                live.update(picture(demo, speed), refresh=True)
                drawn = monotonic()
    console.print(picture(demo, speed))


def picture(demo: Demo, speed: float) -> Group:
    """Both feet, the track and the links at this moment."""
    feet = Table.grid(expand=False, padding=(0, 3))
    for foot in Foot:
        feet.add_row(*_foot(demo, foot))
    lines = plot(demo.track, *PLOT)
    health = link_health(demo.tally) or ["every packet arrived"]
    title = f"{demo.now:5.1f} of {demo.duration:.1f} s, {speed:g} times real time"
    return Group(
        Panel(feet, title=title, width=PLOT[0] + 4),
        Panel(Text("\n".join(lines)), title="track", width=PLOT[0] + 4),
        Panel(Text("\n".join(health)), title=f"link, {demo.tally.packets} packets", width=PLOT[0] + 4),
    )


def _foot(demo: Demo, foot: Foot) -> tuple[Text, ...]:
    one = demo.tally.foot(foot)
    phase = Text("-" if one.phase is None else one.phase.value.ljust(10))
    if one.phase is not None:
        phase.stylize(f"bold {COLOURS[one.phase]}")
    where = "" if one.position is None else "at " + " ".join(number(v).rjust(6) for v in one.position) + " m"
    return (Text(foot.value), phase, Text(f"{one.steps:3d} steps"), Text(f"{one.distance:6.2f} m"), Text(where))
