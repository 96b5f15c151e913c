"""`solepath live` and `solepath record`: devices heard as they are worn."""

from __future__ import annotations

import argparse
import asyncio
from collections.abc import AsyncIterable
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .failure import Failure, known_recipe, note
from .wearing import (
    LISTENED,
    add_devices,
    air,
    chosen,
    how_long,
    need_bleak,
    run_to_end,
    shown,
    stopping,
    until,
    wanted,
)

if TYPE_CHECKING:
    from ..types import Packet


def add_to(commands: Any) -> None:
    live: argparse.ArgumentParser = commands.add_parser(
        "live",
        help="listen to sensors and show what they say",
        description="Connect to sensors on the feet and show gait, track and links as they are worn. Without "
        "--left and --right it takes the insoles that it hears, who know their feet.",
        epilog="example: solepath live --left F0:5E:00:00:00:01 --right F0:5E:00:00:00:02 --record walk.jsonl",
    )
    add_devices(live)
    live.add_argument("--recipe", metavar="NAME", default="default", help="how to compute (default: default)")
    live.add_argument("--record", metavar="FILE", type=Path, help="write the packets as a recording too")
    live.add_argument(
        "--out", metavar="DIR", type=Path, help="write events.jsonl, track.csv and steps.csv into this directory"
    )
    live.set_defaults(run=run)

    record: argparse.ArgumentParser = commands.add_parser(
        "record",
        help="write what sensors send into a file",
        description="Connect to sensors and write every packet as it arrives; a file for `solepath track`. Whatever "
        "happens to this program, what came until 200 ms before can be read.",
        epilog="example: solepath record --out walk.jsonl --duration 120",
    )
    add_devices(record)
    record.add_argument("--out", metavar="FILE", dest="record", type=Path, required=True, help="the recording")
    record.set_defaults(run=run, recipe="default", out=None)


def run(options: argparse.Namespace) -> int:
    from .. import recipes

    recipe = recipes.BY_NAME[known_recipe(options.recipe, list(recipes.BY_NAME))]
    need_bleak()
    return run_to_end(_listen(options, recipe))


async def _listen(options: argparse.Namespace, recipe: Any) -> int:
    from ..ble import Devices, record, scan
    from ..monitor import Monitor
    from ..output import TrackFiles
    from ..recording import RecordingError
    from ..session import Session
    from ..view.summary import summary

    devices = wanted(options)
    seconds = how_long(options)
    monitor = Monitor(Session(recipe, poses=True))
    failure: Failure | None = None
    with stopping() as stop, ExitStack() as stack:
        async with air(options.via) as backend:
            if not devices:
                print(f"looking for sensors for {LISTENED:g} s ...", flush=True)
                devices = chosen(await scan(LISTENED, backend=backend))
            files = stack.enter_context(TrackFiles(options.out)) if options.out else None
            async with Devices(devices, backend=backend, pair=options.pair) as heard:
                packets: AsyncIterable[Packet] = until(heard, stop, seconds)
                if options.record:
                    packets = record(packets, options.record)
                title = "Ctrl-C ends" if seconds is None else f"{seconds:g} s"
                with shown(monitor, title) as report:
                    try:
                        async for packet in packets:
                            for event in monitor.take(packet):
                                if files is not None:
                                    files.write(event)
                            report()
                    except RecordingError as error:
                        failure = Failure(str(error))
                    except asyncio.CancelledError:
                        note("interrupted")
        for event in monitor.finish():
            if files is not None:
                files.write(event)
    print(summary(monitor.tally, title=f"recipe {recipe.name}", seconds=0.0))
    if options.record:
        print(f"recorded in {options.record}")
    if options.out:
        print(f"written to {options.out}")
    if failure is not None:
        raise failure
    return 0
