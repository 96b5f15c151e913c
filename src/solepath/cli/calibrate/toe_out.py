"""`solepath calibrate toe-out`: how far feet point beside their way, from a straight walk, recorded or walked now."""

from __future__ import annotations

import argparse
from functools import partial
from math import degrees
from pathlib import Path
from typing import Any

from ...calibration import Calibration
from ...show.tables.table import number, table
from ..bluetooth.devices import add_feet
from ..common.failure import Failure, parse_positive
from ..common.files import RECORDING, add_force
from ..common.inputs import add_foot, foot_of, source_of
from ..common.own_devices import add_own_devices, drivers_of
from ..common.view import add_view, page_address_of
from .live import check_live, reject_live_options, run_live

OF_LIVE = ("via", "left", "right", "profile", "pair", "view", "no_browser")
"""Options that only --live uses."""


def add_toe_out(kinds: Any) -> None:
    """Add the kind to the parser."""
    command: argparse.ArgumentParser = kinds.add_parser(
        "toe-out",
        help="how far feet point beside their way, from a straight walk",
        description="From a straight walk: how far each foot points outwards of its way, which the recipe "
        "footstep-tracker takes into account. With the length of the walk, the paper's angle is shown too. With "
        "--live, the command says how to walk, shows strides and angles as they come, and writes the recording.",
        epilog="example: solepath calibrate toe-out corridor.jsonl --distance 20 --out me.json",
    )
    command.set_defaults(learn=_toe_out)
    command.add_argument(
        "file",
        metavar="RECORDING",
        type=Path,
        help="packets (.jsonl) or samples (.npz, .csv); with --live, to be written",
    )
    add_foot(command)
    add_own_devices(command)
    command.add_argument("--distance", metavar="M", type=parse_positive, help="length of the walk, m")
    command.add_argument("--live", action="store_true", help="walk now, with the sensors in the shoes")
    add_feet(command)
    add_view(command, command, "with --live: show what to do, strides and angles")
    add_force(command)


def _toe_out(options: argparse.Namespace, known: Calibration) -> tuple[Calibration, list[str]]:
    from ...papers.footstep_tracker.toe_out import ERRORS, ToeOut, printed_angle, toe_out, toe_out_calibration

    if options.live and options.driver_files:
        raise Failure("--driver is for a recording here: make it with `solepath record`, and give it without --live")
    if options.live:
        _measure(options)
    else:
        reject_live_options(options, OF_LIVE)
    feet, distance = (
        toe_out(source_of(options.file, foot_of(options), own=drivers_of(options)), options.distance),
        options.distance,
    )

    def by_length(one: ToeOut) -> str:
        printed = printed_angle(one.along, distance)
        return "none" if printed is None else " +- ".join([number(degrees(angle)) for angle in printed])

    header = ["foot", "strides", "along the foot m", "toe-out degrees"] + ["by the length"] * (distance is not None)
    rows = []
    for one in feet:
        angle = f"{number(degrees(one.angle))} +- {number(degrees(one.sigma))}"
        row = [one.foot.value, str(one.strides), number(one.along, 2), angle]
        rows.append(row if distance is None else [*row, by_length(one)])
    lines = [table(header, rows)]
    unknown = [one.foot.value for one in feet if not one.is_known]
    if unknown:
        lines.append(
            f"{' and '.join(unknown)}: the angle is less than {ERRORS:g} of its errors: nothing is learnt of it"
        )
    if len(unknown) == len(feet):
        raise Failure("\n".join([*lines, "nothing is learnt"]))
    return toe_out_calibration(feet), lines


def _measure(options: argparse.Namespace) -> None:
    """Write the recording, walked by a person at the terminal; raise SystemExit when that was stopped."""
    check_live(options, RECORDING, "calibrate toe-out --live shows a person how to walk")
    address = page_address_of(options)
    from .toe_out_live import measure

    run_live(partial(measure, options, address))
