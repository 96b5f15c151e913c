"""What `solepath live` and `solepath record` do once their options are read."""

from __future__ import annotations

import argparse
import asyncio
from collections.abc import AsyncIterable
from contextlib import ExitStack

from ..ble import Devices, record, scan
from ..monitor import Monitor
from ..output import TrackFiles
from ..recipes import Recipe
from ..recording import RecordingError
from ..session import Session
from ..types import Packet
from ..view.summary import summary
from .failure import Failure, note
from .loop import air, stopping, until
from .wearing import LISTENED, chosen, how_long, shown, wanted


async def listen(options: argparse.Namespace, recipe: Recipe) -> int:
    """Until it is told to stop; the exit status."""
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
