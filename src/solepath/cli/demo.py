"""`solepath demo`: an emulated wearer through the whole path, live, and a table against the truth at the end."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .failure import Failure, note, positive, seconds, seed, share

if TYPE_CHECKING:
    from ..demo import Demo

REPORT_EVERY = 10.0
"""s of the walk between two lines where there is no terminal."""


def add_to(commands: Any) -> None:
    command: argparse.ArgumentParser = commands.add_parser(
        "demo",
        help="walk an emulated route and compare with the truth",
        description="An emulated wearer walks a route with both insoles over a lossy radio; shown live in a "
        "terminal, and as fast as it can be computed where there is none.",
    )
    command.add_argument("--seed", metavar="N", type=seed, default=1, help="another walk of this route (default: 1)")
    command.add_argument(
        "--distance", metavar="M", type=positive, help="walk so many metres straight on instead of the scripted route"
    )
    command.add_argument("--loss", metavar="SHARE", type=share, help="share of packets lost, 0 to 1 (default: 0.03)")
    command.add_argument(
        "--jitter", metavar="S", type=seconds, help="how much later than others a packet may come (default: 0.03)"
    )
    command.add_argument(
        "--speed", metavar="X", type=positive, default=2.0, help="times real time in a terminal (default: 2)"
    )
    command.add_argument("--record", metavar="FILE", type=Path, help="write the packets as a recording for `track`")
    command.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    from ..demo import ROUTE, make_demo, radio, straight
    from ..view.comparison import comparison_table
    from ..view.gait import gait_lines
    from ..view.summary import latency

    route = ROUTE if options.distance is None else straight(options.distance)
    air = radio(options.loss, options.jitter)
    demo = make_demo(options.seed, route, air)
    print(
        f"An emulated wearer walks {route.length:.0f} m in {demo.duration:.0f} s with an insole in each shoe; "
        f"{100 * air.loss:.3g} % of the packets get lost.",
        flush=True,
    )
    if options.record:
        _record(demo, options.record)
    if sys.stdout.isatty() and _rich_is_there():
        from ..view.terminal import play

        play(demo, options.speed)
    else:
        _tell(demo)
    print()
    tally = demo.monitor.tally
    print("\n".join([*gait_lines(tally.gait), comparison_table(demo.comparison()), "", *latency(tally)]))
    return 0


def _record(demo: Demo, path: Path) -> None:
    from ..recording import PacketWriter, RecordingError

    try:
        with PacketWriter(path) as writer:
            for packet in demo.walk.packets:
                writer.write(packet)
    except RecordingError as error:
        raise Failure(str(error)) from None
    print(f"{len(demo.walk.packets)} packets recorded in {path}", flush=True)


def _rich_is_there() -> bool:
    from importlib.util import find_spec

    if find_spec("rich") is not None:
        return True
    note("the live view needs rich (pip install rich); plain text without it")
    return False


def _tell(demo: Demo) -> None:
    """Lines of plain text instead of a picture, as fast as it goes."""
    from ..types import Foot
    from ..view.plot import plot
    from ..view.summary import link_health

    due = REPORT_EVERY
    for packet in demo.play():
        if packet.t >= due:
            due += REPORT_EVERY
            feet = (f"{foot.value} {demo.monitor.tally.foot(foot).steps} steps" for foot in Foot)
            print(f"{packet.t:6.1f} s  {', '.join(feet)}", flush=True)
    print(
        "\n".join(
            ["", *(line.rstrip() for line in plot(demo.monitor.track, 72, 16)), "", *link_health(demo.monitor.tally)]
        )
    )
