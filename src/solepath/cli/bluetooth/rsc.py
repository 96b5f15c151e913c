"""`solepath rsc`: prints what a sensor of running speed and cadence sends."""

from __future__ import annotations

import argparse
import asyncio
from functools import partial
from typing import Any

from ...recording import printable
from ..common.failure import Failure, parse_offset
from .devices import LISTEN_TIME, add_duration, add_via, need_bleak

KMH = 3.6
"""Value of 1 m/s in km/h."""


def add_to(commands: Any) -> None:
    """Add the command to the parser."""
    command: argparse.ArgumentParser = commands.add_parser(
        "rsc",
        help="read a sensor of running speed and cadence",
        description="Connect to a sensor with the Bluetooth Running Speed and Cadence Service (0x1814), of any maker, "
        "and print a line for each measurement.",
        epilog="example: solepath rsc --device 'Foot pod' --duration 60",
    )
    command.add_argument("--device", metavar="DEVICE", help="its address or name (default: the nearest one)")
    command.add_argument(
        "--distance", metavar="M", type=parse_offset, help="set its total distance first, for instance 0"
    )
    add_via(command)
    add_duration(command, LISTEN_TIME)
    command.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Print the measurements; return the exit status."""
    need_bleak()
    from .backend import listen_to_end

    if options.distance is not None and options.distance < 0.0:
        raise Failure("--distance: a distance is not negative")
    return listen_to_end(partial(_listen, options))


async def _listen(options: argparse.Namespace, stop: asyncio.Event) -> int:
    from ...ble.running import RunningSensor
    from ...wire.running import RscMeasurement
    from ..common.loop import unless_stopped
    from .backend import backend_of
    from .devices import listening_time

    def line(t: float, one: RscMeasurement) -> str:
        parts = [f"{t:6.1f} s  {one.speed:5.2f} m/s {KMH * one.speed:5.1f} km/h  {one.cadence:3d} steps/min"]
        parts += [] if one.stride_length is None else [f"stride {one.stride_length:.2f} m"]
        parts += [] if one.distance is None else [f"distance {one.distance:.1f} m"]
        return "  ".join([*parts, "running" if one.running else "walking" if one.speed else "standing"])

    seconds = listening_time(options)
    async with backend_of(options.via) as backend:
        async with unless_stopped(stop):
            sensor = await RunningSensor(options.device, backend=backend).__aenter__()
        try:
            if options.distance is not None:
                await sensor.set_distance(options.distance)
            print(f"connected to {printable(sensor.name)} ({sensor.address})", flush=True)
            start = asyncio.get_running_loop().time()
            try:
                async with asyncio.timeout(seconds):
                    async for t, measurement in sensor:
                        print(line(t - start, measurement), flush=True)
                        if stop.is_set():
                            break
            except TimeoutError:
                pass
        finally:
            await sensor.__aexit__()
    return 0
