"""Does the work of `solepath live` for sensors that come as streams of the lab streaming layer."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any

from ...recording import printable
from ...types import Site
from ..common.failure import Failure, note, require

if TYPE_CHECKING:
    import asyncio

    from ...calibration import Calibration
    from ...recipes import Recipe

PREFIX = "lsl:"
"""Start of the name of a device that stands for a stream."""
POLL_INTERVAL = 0.005
"""Time between two looks into the queues of the streams, s: half of an interval at 100 Hz."""


def stream_names_of(options: argparse.Namespace) -> dict[Site, str]:
    """Return the names of the streams of --left and --right, by site; raise Failure for a stream beside a device."""
    given = {Site.LEFT_FOOT: options.left, Site.RIGHT_FOOT: options.right}
    names = {site: text.removeprefix(PREFIX) for site, text in given.items() if text and text.startswith(PREFIX)}
    if names and len(names) < len([text for text in (*given.values(), *options.at) if text]):
        raise Failure("streams of LSL and devices cannot be mixed: sensors of both feet come the same way")
    if "" in names.values():
        raise Failure(f"{PREFIX} names no stream: `solepath scan --lsl` lists those in the network")
    return names


def need_lsl(what: str) -> None:
    """Raise Failure when the lab streaming layer cannot be used; `what` starts the sentence, such as "--lsl needs"."""
    require(what, "lsl", "pylsl")
    try:
        import pylsl  # noqa: F401
    except (RuntimeError, OSError):  # the wheels for some machines have no liblsl
        raise Failure(f"{what} liblsl, which pylsl does not find: install it, or name its file in PYLSL_LIB") from None


def run_streams(options: argparse.Namespace, recipe: Recipe, calibration: Calibration | None) -> int:
    """Run the streams that --left and --right name; return the exit status."""
    need_lsl("streams of LSL need")
    from ...recording.lsl.inlet import LslError
    from ..common.loop import run_to_end

    if options.view is not None or options.record is not None or options.floorplan is not None:
        raise Failure("streams of LSL: --view, --record and --floorplan are for sensors over Bluetooth")
    try:
        return run_to_end(partial(_listen, options, recipe, calibration))
    except LslError as error:
        raise Failure(str(error)) from None


async def _listen(
    options: argparse.Namespace, recipe: Recipe, calibration: Calibration | None, stop: asyncio.Event
) -> int:
    """Run the streams until `stop` is set or the time is over; return the exit status."""
    import asyncio

    from pylsl import local_clock

    from ...recording.lsl.inlet import LslInlet
    from ...recording.lsl.outlet import LslOutlets
    from ...recording.posed import PosedSession
    from ...session import Session
    from ...show.output import TrackFiles
    from ...show.tables.summary import summary
    from ...walk.walk import Walk
    from .devices import listening_time
    from .live_run import show_state

    posed = PosedSession(Session(recipe, calibration=calibration, poses=True))
    channels, units = _stated(options)
    inlets = [
        await asyncio.to_thread(partial(LslInlet, site, name, channels=channels, units=units))
        for site, name in stream_names_of(options).items()
    ]
    start = local_clock()  # times of the session count from here, when all streams are open
    for inlet in inlets:
        inlet.pull()
        inlet.offset = start
    outlets = None if options.lsl is None else LslOutlets(start, options.lsl, with_samples=False)
    files = None if options.out is None else TrackFiles(options.out)
    walk = Walk()

    def publish(feed: Callable[[], Any], item: Any) -> None:
        events = feed()
        walk.take(item, events)
        samples = posed.take()
        if outlets is not None:
            outlets.push(samples, events)
        if files is not None:
            for event in events:
                files.write(event)

    seconds = listening_time(options)
    end = None if seconds is None else local_clock() + seconds
    with show_state(walk, "Ctrl-C ends" if seconds is None else f"{seconds:g} s") as report:
        while not stop.is_set() and (end is None or local_clock() < end):
            for sample in sorted([one for inlet in inlets for one in inlet.pull()], key=lambda one: one.t):
                publish(partial(posed.session.feed, sample), sample)
            if walk.item_count:
                report()
            await asyncio.sleep(POLL_INTERVAL)
    publish(posed.session.finish, None)
    if files is not None:
        files.close()
    for inlet in inlets:
        if not inlet.received:
            note(f"the stream {inlet.name!r} sent nothing")
        inlet.close()
    print(summary(walk, title=f"recipe {recipe.name}", seconds=0.0))  # 0: no line on the speed
    if outlets is not None:
        print("published: " + ", ".join([f"{count} in {options.lsl} {name}" for name, count in outlets.sent.items()]))
        outlets.close()
    if options.out:
        print(f"written to {printable(str(options.out))}")
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
