"""Does the work of `solepath emulate` after its options are read."""

from __future__ import annotations

import asyncio
from argparse import Namespace
from contextlib import AsyncExitStack, suppress

from ...emulate.controllers import serve
from ...emulate.demo import straight
from ...emulate.devices.bench import Bench
from ...emulate.devices.faults import parse_faults
from ...emulate.routes.postures import PITCHES, held_shoe, held_time
from ...emulate.routes.route import Route
from ...emulate.sensors import insole_device, sensortags
from ...emulate.sensors.device import Device
from ...link.devices import cc2541, cc2650, insole
from ...recording import printable
from ...saving.files import read_bounded
from ...types import Foot, Site
from ..common.failure import Failure, has_terminal
from ..common.os_errors import address_error_text
from .devices import SERVE_TIME

MAX_FAULTS = 1_000_000
"""Largest size of a script of faults, bytes: some 30,000 lines."""
RESTART_DELAY = 10.0
"""Time without a connection after which the next connection starts the walk again, s."""
POLL_INTERVAL = 0.01
"""Time between two checks of the connections, s."""
SLOW_DISTANCE = 500.0
"""Distance above which computing the walk takes some seconds, m."""
WALK_DELAY = 1.0
"""Time from the first connection to the start of the walk, s; the wearer stands at first."""


def prepare_bench(options: Namespace) -> Bench:
    """Return the devices on a wearer whose walk is computed; raise Failure for options that cannot be emulated."""
    kinds: dict[str, Device] = {
        insole.PROFILE.name: insole_device.Insole(),
        cc2650.PROFILE.name: sensortags.CC2650(),
        cc2541.PROFILE.name: sensortags.CC2541(),
        cc2541.PROFILE_20HZ.name: sensortags.CC2541(rate=20.0),
    }
    try:
        bench = Bench(
            straight(options.distance) if options.postures is None else Route().stand(held_time(options.postures)),
            devices=dict.fromkeys((Site.LEFT_FOOT, Site.RIGHT_FOOT), kinds[options.device]),
            seed=options.seed,
            mtu=options.mtu,
            faults=parse_faults(read_bounded(options.faults, MAX_FAULTS).decode()) if options.faults else (),
        )
    except ValueError as error:
        if options.faults is None:
            raise
        raise Failure(f"{options.faults}: {error}") from None
    if options.postures is None and options.distance > SLOW_DISTANCE:
        print(f"working out a walk of {options.distance:g} m ...", flush=True)
    if options.postures is not None:
        bench.walker.motions = dict.fromkeys(Foot, held_shoe(PITCHES, options.postures))
    bench.prepare()
    return bench


async def serve_devices(options: Namespace, bench: Bench, stop: asyncio.Event) -> int:
    """Serve the devices until `stop` is set or the time is over; return the exit status."""
    bench.walk_from(asyncio.get_running_loop().time() + 1e6)  # the wearer stands until a device is connected
    async with AsyncExitStack() as stack:
        try:
            host, port = await stack.enter_async_context(serve(bench.peripherals, *options.listen))
        except OSError as error:
            host, port = options.listen
            raise Failure(f"--listen {host}:{port}: {address_error_text(error)}") from None
        print(f"serving at tcp:{host}:{port}", flush=True)
        for peripheral in bench.peripherals:
            print(f"  {peripheral.address}  {peripheral.site.words}  {printable(peripheral.name)}", flush=True)
        seconds = options.duration
        if seconds is None and not has_terminal():
            seconds = SERVE_TIME
        walking = asyncio.create_task(_walk_when_connected(bench))
        try:
            with suppress(TimeoutError):
                await asyncio.wait_for(stop.wait(), seconds)
        finally:
            walking.cancel()
            await asyncio.gather(walking, return_exceptions=True)
    return 0


async def _walk_when_connected(bench: Bench) -> None:
    """Start the walk at each connection that follows more than RESTART_DELAY s without any connection."""
    loop = asyncio.get_running_loop()
    unconnected_since: float | None = float("-inf")
    while True:
        now = loop.time()
        if not any(peripheral.is_connected for peripheral in bench.peripherals):
            unconnected_since = now if unconnected_since is None else unconnected_since
        elif unconnected_since is not None:
            if now - unconnected_since > RESTART_DELAY:
                bench.walk_from(now + WALK_DELAY)
            unconnected_since = None
        await asyncio.sleep(POLL_INTERVAL)
