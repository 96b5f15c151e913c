"""`solepath calibrate shoe`: how a shoe rolls over its forefoot, from a file of postures or measured now."""

from __future__ import annotations

import argparse
from functools import partial
from math import degrees
from pathlib import Path
from typing import Any

from ...calibration import Calibration
from ..bluetooth.devices import add_feet
from ..common.failure import parse_count, parse_positive
from ..common.files import Kind, add_force
from ..common.view import add_view, page_address_of
from .live import check_live, reject_live_options, run_live

TIMES = 3
"""Number of measurements of each posture, as in the paper."""
OF_LIVE = ("height", "heel", "via", "left", "right", "profile", "pair", "view", "no_browser")
"""Options that only --live uses."""
MEASUREMENTS = Kind(None)
"""A file of postures: what was measured once cannot be computed again."""


def add_shoe(kinds: Any) -> None:
    """Add the kind to the parser."""
    command: argparse.ArgumentParser = kinds.add_parser(
        "shoe",
        help="how a shoe rolls over its forefoot, from postures measured with rulers",
        description="From static postures between flat and toe-off: a csv file with the columns pitch_deg, L_r_m, "
        "L_p2t_m, and H_imu_m and heel_L_r_m where they are known. With --live, the command makes this file: it shows "
        "the pitch of the shoe by its sensor, says which posture comes next, and asks for what the rulers show.",
        epilog="example: solepath calibrate shoe postures.csv --live --left F0:5E:00:00:00:01 --out me.json",
    )
    command.set_defaults(learn=_shoe)
    command.add_argument("file", metavar="POSTURES", type=Path, help="the csv file; with --live, to be written")
    command.add_argument("--live", action="store_true", help="measure now, with the sensor in the shoe")
    command.add_argument(
        "--times", metavar="N", type=parse_count, default=TIMES, help=f"of each posture, with --live (default: {TIMES})"
    )
    command.add_argument(
        "--height", metavar="M", type=parse_positive, help="of the sensor above the ground, m, with --live"
    )
    command.add_argument(
        "--heel", metavar="M", type=parse_positive, help="from the heel's end to below the sensor, m, with --live"
    )
    add_feet(command)
    add_view(command, command, "with --live: show the pitch and what to do next")
    add_force(command)


def _shoe(options: argparse.Namespace, known: Calibration) -> tuple[Calibration, list[str]]:
    from ...papers.kupt_dfpc.shoe.fit import fit_shoe

    if options.live:
        _measure(options)
    else:
        reject_live_options(options, OF_LIVE)
    fit = fit_shoe(options.file)
    shoe = fit.calibration.shoe
    steepest = "" if shoe is None else f", flat to {degrees(shoe.steepest):.0f} degrees"
    return fit.calibration, [
        f"{fit.measurements} measurements of {fit.postures} postures{steepest}: rms error of L_r "
        f"{1000.0 * fit.residual_radius:.1f} mm, of L_p2t {1000.0 * fit.residual_to_toe:.1f} mm, largest "
        f"{1000.0 * fit.worst:.1f} mm"
    ]


def _measure(options: argparse.Namespace) -> None:
    """Write the file of postures, measured with a person at the terminal; raise SystemExit when that was stopped."""
    check_live(options, MEASUREMENTS, "calibrate shoe --live asks a person for what the rulers show")
    address = page_address_of(options)
    from .shoe_live import measure

    run_live(partial(measure, options, address))
