"""`solepath scan`: which devices are there."""

from __future__ import annotations

import argparse
from typing import Any

from .failure import positive
from .wearing import LISTENED, add_air, air, need_bleak, run_to_end


def add_to(commands: Any) -> None:
    command: argparse.ArgumentParser = commands.add_parser(
        "scan",
        help="list the sensors that can be heard",
        description="List the sensors that advertise, the nearest first.",
        epilog="example: solepath scan --seconds 8",
    )
    command.add_argument(
        "--seconds", metavar="S", type=positive, default=LISTENED, help=f"how long to listen (default: {LISTENED:g})"
    )
    command.add_argument("--all", action="store_true", help="devices of kinds that are not known here too")
    add_air(command)
    command.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    need_bleak()
    return run_to_end(_scan(options))


async def _scan(options: argparse.Namespace) -> int:
    from ..ble import scan
    from ..recording import printable
    from ..view.table import table

    async with air(options.via) as backend:
        found = await scan(options.seconds, backend=backend)
    rows = [
        [one.address, "-" if one.profile is None else one.profile.name, f"{one.signal}", printable(one.name, 40) or "-"]
        for one in found
        if options.all or one.profile is not None
    ]
    if rows:
        print(table(["address", "kind", "dBm", "name"], rows))
    strangers = sum(one.profile is None for one in found)
    if not rows:
        print("no sensor is heard: switch it on, bring it near, and see that no other program or phone holds it")
    if strangers and not options.all:
        print(f"{strangers} of other kinds (--all shows them)")
    return 0
