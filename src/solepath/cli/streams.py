"""`solepath lsl`: runs sensors that come as streams of the lab streaming layer, and publishes what is found."""

from __future__ import annotations

import argparse
import asyncio
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

from ..types import Site
from .bluetooth.devices import add_duration
from .common.failure import Failure, note, require
from .common.files import add_force, check_outputs, check_writable, files_of_track
from .common.inputs import add_calibration, add_recipe, calibration_of, recipe_of

LISTEN_TIME = 30.0
"""Time for which the command listens without a terminal and without --duration, s."""
POLL_INTERVAL = 0.005
"""Time between two looks into the queues of the streams, s: half of an interval at 100 Hz."""


def add_to(commands: Any) -> None:
    """Add the command to the parser."""
    command: argparse.ArgumentParser = commands.add_parser(
        "lsl",
        help="run sensors of the lab streaming layer and publish gait events",
        description="Read the samples of sensors on the feet from streams of the lab streaming layer (LSL), and "
        "publish gait events and poses as streams, on the same clock. Without --left and --right, list the streams.",
        epilog="example: solepath lsl --left 'IMU left' --right 'IMU right' --out walk",
    )
    command.add_argument("--left", metavar="STREAM", help="name of the stream of the left foot's sensor")
    command.add_argument("--right", metavar="STREAM", help="name of the stream of the right foot's sensor")
    command.add_argument(
        "--channels",
        metavar="NAMES",
        help="what the channels of these streams are, in order, where they do not say it: acc_x,acc_y,acc_z,gyro_x,... "
        "and - for one that is not used",
    )
    command.add_argument(
        "--units", metavar="ACC,GYRO", help="the units of acc and gyro, where the streams do not say them: g,deg/s"
    )
    command.add_argument(
        "--name", metavar="NAME", default="solepath", help="start of the names of the streams that are published"
    )
    add_recipe(command)
    add_calibration(command)
    command.add_argument(
        "--out",
        metavar="DIR",
        type=Path,
        help="write events.jsonl, track.csv, strides.csv and gait_cycles.csv into this directory too",
    )
    add_force(command)
    add_duration(command, LISTEN_TIME)
    command.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Run the streams, or list them; return the exit status."""
    require("the lab streaming layer needs", "lsl", "pylsl")
    from ..recording.lsl.inlet import LslError, stream_names
    from .common.loop import run_to_end

    names = {Site.LEFT_FOOT: options.left, Site.RIGHT_FOOT: options.right}
    given = {site: name for site, name in names.items() if name is not None}
    if not given:
        found = stream_names()
        print("\n".join(found) if found else "no stream is in the network")
        return 0
    outputs = files_of_track(options.out, places=False)
    check_outputs(outputs, [options.calibration], force=options.force)
    if options.out is not None:
        options.out.mkdir(parents=True, exist_ok=True)
    for output in outputs:
        check_writable(output.path)
    try:
        return run_to_end(partial(_listen, options, given))
    except LslError as error:
        raise Failure(str(error)) from None


async def _listen(options: argparse.Namespace, names: dict[Site, str], stop: asyncio.Event) -> int:
    """Run the streams until `stop` is set or the time is over; return the exit status."""
    from pylsl import local_clock

    from ..recording.lsl.inlet import LslInlet
    from ..recording.lsl.outlet import LslOutlets
    from ..recording.posed import PosedSession
    from ..session import Session
    from ..show.observer import Observer
    from ..show.output import TrackFiles
    from ..show.tables.summary import summary
    from .bluetooth.devices import listening_time
    from .bluetooth.live_run import show_state

    recipe = recipe_of(options)
    posed = PosedSession(Session(recipe, calibration=calibration_of(options), poses=True))
    channels, units = _stated(options)
    inlets = [
        await asyncio.to_thread(partial(LslInlet, site, name, channels=channels, units=units))
        for site, name in names.items()
    ]
    start = local_clock()  # times of the session count from here, when all streams are open
    for inlet in inlets:
        inlet.pull()
        inlet.offset = start
    outlets = LslOutlets(start, options.name, with_samples=False)
    files = None if options.out is None else TrackFiles(options.out)
    observer = Observer()

    def publish(feed: Callable[[], Any], item: Any) -> None:
        events = feed()
        observer.take(item, events)
        outlets.push(posed.take(), events)
        if files is not None:
            for event in events:
                files.write(event)

    seconds = listening_time(options)
    end = None if seconds is None else local_clock() + seconds
    with show_state(observer, "Ctrl-C ends" if seconds is None else f"{seconds:g} s") as report:
        while not stop.is_set() and (end is None or local_clock() < end):
            for sample in sorted([one for inlet in inlets for one in inlet.pull()], key=lambda one: one.t):
                publish(partial(posed.session.feed, sample), sample)
            if observer.item_count:
                report()
            await asyncio.sleep(POLL_INTERVAL)
    publish(posed.session.finish, None)
    if files is not None:
        files.close()
    for inlet in inlets:
        if not inlet.received:
            note(f"the stream {inlet.name!r} sent nothing")
        inlet.close()
    outlets.close()
    print(summary(observer, title=f"recipe {recipe.name}", seconds=0.0))  # 0: no line on the speed
    print(f"published: {', '.join([f'{count} in {options.name} {name}' for name, count in outlets.sent.items()])}")
    return 0


def _stated(options: argparse.Namespace) -> tuple[list[str] | None, dict[str, str] | None]:
    """Return what --channels and --units say; None for what is not given."""
    channels = None if options.channels is None else [name.strip() for name in options.channels.split(",")]
    if options.units is None:
        return channels, None
    acc, comma, gyro = options.units.partition(",")
    if not comma:
        raise Failure(f"--units {options.units}: that is not ACC,GYRO, as in g,deg/s")
    return channels, {"acc": acc.strip(), "gyro": gyro.strip()}
