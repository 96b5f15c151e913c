"""What `solepath emulate` does once its options are read."""

from __future__ import annotations

import argparse
import asyncio
import sys

from ..demo import straight
from ..link.profile import CC2541, CC2541_20HZ, CC2650, INSOLE
from ..loopback.bench import Bench
from ..loopback.faults import parse_faults
from ..loopback.tcp import serve
from ..sim import insole_device, sensortags
from ..sim.device import Device
from ..types import Site
from .failure import Failure
from .loop import stopping
from .wearing import UNATTENDED

RESTED = 10.0
"""s without a connection after which the next one finds the wearer at the beginning of his walk."""
HESITATES = 1.0
"""s from the first connection to the walk's beginning; it begins with standing."""


async def serve_devices(options: argparse.Namespace) -> int:
    """Until it is told to stop; the exit status."""
    host, colon, port = options.listen.rpartition(":")
    if not colon or not host or not port.isdecimal() or int(port) > 65535:
        raise Failure(f"--listen {options.listen}: that is not HOST:PORT")
    if not 23 <= options.mtu <= 517:
        raise Failure(f"--mtu {options.mtu}: an MTU is from 23 to 517")
    try:
        faults = parse_faults(options.faults.read_text("utf-8")) if options.faults else ()
    except ValueError as error:
        raise Failure(f"{options.faults}: {error}") from None
    kinds: dict[str, Device] = {
        INSOLE.name: insole_device.Insole(),
        CC2650.name: sensortags.CC2650(),
        CC2541.name: sensortags.CC2541(),
        CC2541_20HZ.name: sensortags.CC2541(rate=20.0),
    }
    feet = (Site.LEFT_FOOT, Site.RIGHT_FOOT)
    bench = Bench(
        straight(options.distance),
        devices=dict.fromkeys(feet, kinds[options.device]),
        seed=abs(options.seed),
        mtu=options.mtu,
        faults=faults,
    )
    with stopping() as stop:
        loop = asyncio.get_running_loop()
        bench.began = loop.time() + 1e6  # until somebody is connected the wearer stands
        bench.prepare()
        async with serve(bench.peripherals, host.strip("[]"), int(port)) as (at, number):
            print(f"serving at tcp:{at}:{number}", flush=True)
            for peripheral in bench.peripherals:
                print(f"  {peripheral.address}  {peripheral.site.words}  {peripheral.name}", flush=True)
            seconds = options.duration
            if seconds is None and not (sys.stdin.isatty() or sys.stdout.isatty()):
                seconds = UNATTENDED
            pacing = asyncio.create_task(_walk_when_connected(bench))
            try:
                async with asyncio.timeout(seconds):
                    await stop.wait()
            except TimeoutError:
                pass
            finally:
                pacing.cancel()
                await asyncio.gather(pacing, return_exceptions=True)
    return 0


async def _walk_when_connected(bench: Bench) -> None:
    """The walk begins when the first device is connected; anew when none was for RESTED s."""
    loop = asyncio.get_running_loop()
    alone_since: float | None = float("-inf")
    while True:
        now = loop.time()
        if not any(peripheral.is_connected for peripheral in bench.peripherals):
            alone_since = now if alone_since is None else alone_since
        elif alone_since is not None:
            if now - alone_since > RESTED:
                bench.began = now + HESITATES
            alone_since = None
        await asyncio.sleep(0.01)
