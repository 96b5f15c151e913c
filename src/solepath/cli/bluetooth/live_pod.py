"""Does the work of `solepath live --pod`: prints what a sensor of running speed and cadence sends."""

from __future__ import annotations

import argparse
from functools import partial
from typing import TYPE_CHECKING

from ...recording import printable

if TYPE_CHECKING:
    import asyncio

KMH = 3.6
"""Value of 1 m/s in km/h."""


def run_pod(options: argparse.Namespace) -> int:
    """Print the measurements of the sensor; return the exit status."""
    from .backend import listen_to_end

    return listen_to_end(partial(_listen, options))


async def _listen(options: argparse.Namespace, stop: asyncio.Event) -> int:
    import asyncio

    from ...ble.running import RunningSensor
    from ...wire.running import RscMeasurement
    from ..common.loop import StoppedEarly, unless_stopped
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
            sensor = await RunningSensor(options.pod or None, backend=backend).__aenter__()
        try:
            print(f"connected to {printable(sensor.name)} ({sensor.address})", flush=True)
            start = asyncio.get_running_loop().time()
            try:
                async with asyncio.timeout(seconds), unless_stopped(stop):
                    async for t, measurement in sensor:
                        print(line(t - start, measurement), flush=True)
            except (TimeoutError, StoppedEarly):
                pass
        finally:
            await sensor.__aexit__()
    return 0
