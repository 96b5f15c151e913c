"""`solepath scan`: which devices are there."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING, Any

from ..recording import printable
from ..view.table import table
from .failure import positive
from .wearing import LISTENED, add_air, need_bleak

if TYPE_CHECKING:
    from ..ble import Found


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
    from ..ble import scan
    from .loop import air, run_to_end

    async def heard() -> list[Found]:
        async with air(options.via) as backend:
            return await scan(options.seconds, backend=backend)

    found = run_to_end(heard())
    known = [one for one in found if one.profile is not None]
    if shown := found if options.all else known:
        print(table(["address", "kind", "dBm", "name"], [_row(one) for one in shown]))
    else:
        print("no sensor is heard: switch it on, bring it near, and see that no other program or phone holds it")
    if not options.all and len(known) < len(found):
        print(f"{len(found) - len(known)} of other kinds (--all shows them)")
    return 0


def _row(one: Found) -> list[str]:
    kind = "-" if one.profile is None else one.profile.name
    return [one.address, kind, str(one.signal), printable(one.name, 40) or "-"]
