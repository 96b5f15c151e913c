"""`solepath scan`: lists the devices that advertise."""

from __future__ import annotations

from argparse import Namespace
from typing import TYPE_CHECKING

from ...recording import printable
from ...show.tables.table import table
from ..common.failure import parse_positive
from ..common.parser import command, option
from .devices import SCAN_TIME, add_via, need_bleak
from .live_streams import need_lsl

if TYPE_CHECKING:
    from ...ble import Advertisement


def run(options: Namespace) -> int:
    """Scan and print the devices; return the exit status."""
    if options.lsl:
        return _print_streams()
    need_bleak()
    import asyncio

    from ...ble import scan
    from ..common.loop import run_to_end, unless_stopped
    from .backend import backend_of

    async def listen(stop: asyncio.Event) -> int:
        async with unless_stopped(stop), backend_of(options.via) as backend:
            found = await scan(options.seconds, backend=backend)
        _print_devices(found, options.all)
        return 0

    return run_to_end(listen)


def _print_streams() -> int:
    need_lsl("streams of LSL need")
    from ...recording.lsl.inlet import stream_names

    print("\n".join(stream_names()) or "no stream of samples is in the network")
    return 0


def _print_devices(found: list[Advertisement], show_all: bool) -> None:
    known = [device for device in found if device.profile is not None]
    if listed := found if show_all else known:
        rows = [
            [
                device.address,
                device.profile.name if device.profile else "-",
                str(device.signal),
                printable(device.name, 40) or "-",
            ]
            for device in listed
        ]
        print(table(["address", "kind", "dBm", "name"], rows))
    else:
        print("no sensor is in range: switch it on, bring it near, and see that no other program or phone holds it")
    if not show_all and len(known) < len(found):
        print(f"{len(found) - len(known)} of other kinds (--all shows them)")


add_scan = command(
    "scan",
    "List the sensors that advertise, the nearest first.",
    "solepath scan --seconds 8",
    option(
        "--seconds",
        metavar="S",
        type=parse_positive,
        default=SCAN_TIME,
        help=f"how long to listen, s (default: {SCAN_TIME:g})",
    ),
    option("--lsl", action="store_true", help="list the streams of the lab streaming layer instead of sensors"),
    option("--all", action="store_true", help="devices of kinds that are not known here too"),
    add_via,
    run=run,
)
