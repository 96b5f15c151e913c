"""`solepath demo`: runs an emulated wearer through the whole library, live, and compares the result with the truth."""

from __future__ import annotations

import sys
from argparse import Namespace
from pathlib import Path
from typing import TYPE_CHECKING

from ..recording import PacketWriter
from ..types import Foot
from ..types.extras import install_hint
from .common.failure import Failure, is_installed, note, parse_positive, parse_seconds, parse_share, tell
from .common.files import RECORDING, OutputFile, add_force, check_outputs
from .common.inputs import recipe_option
from .common.parser import add_seed, command, one_of, option
from .common.view import PageAddress, add_no_browser, page_address_of, play, speed_of, speed_option, view_option

if TYPE_CHECKING:
    from .demo_walk import Demo

REPORT_INTERVAL = 10.0
"""Time of the walk between two lines of progress without a terminal, s."""
TERMINAL_SPEED = 2.0
"""Speed in a terminal, in multiples of real time."""


def run(options: Namespace) -> int:
    """Run the demo; return the exit status."""
    from ..emulate.demo import radio
    from ..show.tables.gait import gait_lines
    from .demo_walk import make_demo

    if options.record is not None:
        check_outputs(options, [OutputFile(options.record, RECORDING)])
    address = _page_address(options)
    pace = 1.0 if address is None else speed_of(options, 1.0)
    emulated_radio = radio(options.loss, options.jitter)
    demo = make_demo(options, emulated_radio, pressures=address is not None)
    distance = f"{demo.walk.walker.route.length:.0f} m{' through a building' if options.building else ''}"
    print(
        f"An emulated wearer walks {distance} in {demo.walk.truth.duration:.0f} s with {demo.sensors}; "
        f"{100 * emulated_radio.loss:.3g} % of the packets get lost.",
        flush=True,
    )
    if options.record:
        _record(demo, options.record, options.force)
    if address is not None:
        _show(demo, address, pace)
    elif sys.stdout.isatty() and is_installed("rich"):
        _draw(demo, TERMINAL_SPEED if options.speed is None else options.speed)
    else:
        if sys.stdout.isatty():
            note(f"the live view needs rich: {install_hint('live')}; plain text without it")
        _print_progress(demo)
    print()
    print("\n".join([*gait_lines(demo.found), *[f"{one}\n" for one in demo.tables()]]))
    return 0


def _page_address(options: Namespace) -> PageAddress | None:
    """Return the address of the page; None for a demo without a page."""
    if options.terminal and options.no_browser:
        raise Failure("--no-browser is for the page, and --terminal shows none")
    if options.view is not None:
        return page_address_of(options)
    if options.terminal or not sys.stdout.isatty():
        return None
    if is_installed("aiohttp"):
        return PageAddress(browser=not options.no_browser)
    note(f"the page in the browser needs aiohttp: {install_hint('view')}")
    return None


def _show(demo: Demo, address: PageAddress, pace: float) -> None:
    """Show the demo on a page; when that ends, compute the rest of the walk."""
    from ..show.page.player.packed_items import PackedItems
    from ..show.page.player.player import Player
    from ..show.page.scene.scene import Scene

    scene = Scene(
        "An emulated walk", demo.session.recipe.name, "demo", plan=None if demo.plan is None else demo.plan.plan
    )
    player = Player(PackedItems(demo.walk.packets), demo.session, scene, demo.plan, on_events=demo.add_events)
    play(player, address, pace, "walk")


def _record(demo: Demo, path: Path, force: bool) -> None:
    """Write the packets of the walk as a recording."""
    with PacketWriter(path, replace=force) as writer:
        for packet in demo.walk.packets:
            writer.write(packet)
    tell(f"{len(demo.walk.packets)} packets recorded in {path}")


def _draw(demo: Demo, speed: float) -> None:
    """Play the demo in the terminal at `speed` times real time."""
    from time import monotonic, sleep

    from rich.console import Console

    from ..show.tables.terminal import FRAME_RATE, picture, screen

    def title() -> str:
        return f"{demo.found.now:5.1f} of {demo.walk.truth.duration:.1f} s, {speed:g} times real time"

    console, started = Console(), monotonic()
    with screen(console) as display:
        for packet in demo.play():
            if (wait := packet.t / speed - (monotonic() - started)) > 0.5 / FRAME_RATE:  # half a frame
                display.draw(demo.found, title())
                sleep(wait)
            else:
                display.show(demo.found, title())
    console.print(picture(demo.found, title()))


def _print_progress(demo: Demo) -> None:
    """Compute the demo as fast as possible and print lines of plain text instead of a picture."""
    from ..show.findings import Concern, texts
    from ..show.tables.plot import plot
    from ..show.tables.table import counted

    due = REPORT_INTERVAL
    for packet in demo.play():
        if packet.t >= due:
            due += REPORT_INTERVAL
            feet = (f"{foot} {counted(demo.found.foot(foot).strides, 'stride')}" for foot in Foot)
            print(f"{packet.t:6.1f} s  {', '.join(feet)}", flush=True)
    picture = [line.rstrip() for line in plot(demo.found.track, 72, 16)]
    print("\n".join(["", *picture, "", *texts(demo.found, Concern.LINK)]))


add_demo = command(
    "demo",
    "An emulated wearer walks a route with both insoles over a lossy radio. In a terminal it is shown "
    "live, on a page in the browser where aiohttp is installed; without a terminal it is computed as fast as it "
    "can be.",
    "solepath demo\nsolepath demo --building --record walk.jsonl",
    recipe_option("compute with it; the wearer wears the sensors of its paper, whose figure stands beside"),
    add_seed,
    one_of(
        option(
            "--distance",
            metavar="M",
            type=parse_positive,
            help="walk so many metres straight on instead of the scripted route",
        ),
        option(
            "--building",
            action="store_true",
            help="walk through an emulated building, with its floor plan: a lift, corridors, stairs",
        ),
    ),
    option("--loss", metavar="SHARE", type=parse_share, help="share of packets lost, 0 to 1 (default: 0.03)"),
    option(
        "--jitter", metavar="S", type=parse_seconds, help="by how many seconds a packet may be late (default: 0.03)"
    ),
    one_of(
        view_option("show it"),
        option("--terminal", action="store_true", help="show it in the terminal, not in the browser"),
    ),
    add_no_browser,
    speed_option(f"1 on the page, {TERMINAL_SPEED:g} in the terminal"),
    option("--record", metavar="FILE", type=Path, help="write the packets as a recording for `track`"),
    add_force,
    run=run,
)
