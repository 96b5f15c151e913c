"""`solepath emulate`: devices that are not there, over true Bluetooth protocols."""

from __future__ import annotations

import argparse
import asyncio
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .failure import Failure, positive
from .wearing import stopping

if TYPE_CHECKING:
    from ..loopback.bench import Bench
    from ..sim.device import Device

HERE = "127.0.0.1:9735"
KINDS = ("insole", "cc2650", "cc2541", "cc2541-20hz")
UNWATCHED = 600.0
"""s that it serves where there is no terminal to end it from, unless it is told how long."""
RESTED = 10.0
"""s without a connection after which the next one finds the wearer at the beginning of his walk."""
HESITATES = 1.0
"""s from the first connection to the walk's beginning; it begins with standing."""
WALKED = 300.0
"""m that the wearer walks when nothing else is said: four minutes."""


def add_to(commands: Any) -> None:
    command: argparse.ArgumentParser = commands.add_parser(
        "emulate",
        help="serve emulated sensors over a true Bluetooth link",
        description="Serve emulated sensors on the feet of an emulated wearer: virtual Bluetooth controllers with the "
        "true services of the devices, spoken to in HCI over TCP. The wearer begins to walk when the first device is "
        "connected, and anew when none was for ten seconds.",
        epilog="example: solepath emulate --listen 127.0.0.1:9735, and then in another terminal: "
        "solepath live --via tcp:127.0.0.1:9735",
    )
    command.add_argument(
        "--listen",
        metavar="HOST:PORT",
        default="127.0.0.1:9735",
        help="where to (default: 127.0.0.1:9735; port 0: any)",
    )
    command.add_argument(
        "--device", choices=KINDS, default="insole", help="what is worn on both feet (default: insole)"
    )
    command.add_argument("--distance", metavar="M", type=positive, default=WALKED, help="how far (default: 300)")
    command.add_argument("--seed", metavar="N", type=int, default=1, help="another walk of the same route (default: 1)")
    command.add_argument("--mtu", metavar="N", type=int, default=247, help="that insoles agree to (default: 247)")
    command.add_argument("--faults", metavar="FILE", type=Path, help="a script of what goes wrong")
    command.add_argument(
        "--duration",
        metavar="S",
        type=positive,
        help=f"end by itself after so long (default: at Ctrl-C; {UNWATCHED:g} s without a terminal)",
    )
    command.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    from importlib.util import find_spec

    for package in ("bleak", "bumble"):
        if find_spec(package) is None:
            raise Failure(f"emulated Bluetooth needs {package}: pip install 'solepath[loopback]'")
    return asyncio.run(_serve(options))


async def _serve(options: argparse.Namespace) -> int:
    from ..demo import straight
    from ..link.profile import CC2541, CC2541_20HZ, CC2650, INSOLE
    from ..loopback.bench import Bench
    from ..loopback.faults import parse_faults
    from ..loopback.tcp import serve
    from ..sim import insole_device, sensortags
    from ..types import Site

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
                print(
                    f"  {peripheral.address}  {peripheral.site.value.replace('_', ' ')}  {peripheral.name}", flush=True
                )
            seconds = options.duration
            if seconds is None and not (sys.stdin.isatty() or sys.stdout.isatty()):
                seconds = UNWATCHED
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
