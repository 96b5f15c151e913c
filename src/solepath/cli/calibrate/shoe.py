"""`solepath calibrate shoe`: how a shoe rolls over its forefoot, from a file of postures or measured now."""

from __future__ import annotations

from argparse import Namespace
from math import degrees
from pathlib import Path

from ...calibration import Calibration
from ..common.failure import parse_count, parse_positive
from ..common.files import Kind
from ..common.parser import command, option
from .live import live_options, measure_live

TIMES = 3
"""Number of measurements of each posture, as in the paper."""
MEASUREMENTS = Kind(None)
"""A file of postures: what was measured once cannot be computed again."""


def _shoe(options: Namespace, known: Calibration) -> tuple[Calibration, list[str]]:
    from ...papers.kupt_dfpc.shoe.fit import fit_shoe

    measure_live(options, MEASUREMENTS, "calibrate shoe --live asks a person for what the rulers show")
    fit = fit_shoe(options.files[0])
    shoe = fit.calibration.shoe
    steepest = "" if shoe is None else f", flat to {degrees(shoe.steepest):.0f} degrees"
    return fit.calibration, [
        f"{fit.measurements} measurements of {fit.postures} postures{steepest}: rms error of L_r "
        f"{1000.0 * fit.residual_radius:.1f} mm, of L_p2t {1000.0 * fit.residual_to_toe:.1f} mm, largest "
        f"{1000.0 * fit.worst:.1f} mm"
    ]


add_shoe = command(
    "shoe",
    "From static postures between flat and toe-off: a csv file with the columns pitch_deg, L_r_m, "
    "L_p2t_m, and H_imu_m and heel_L_r_m where they are known. With --live, the command makes this file: it shows "
    "the pitch of the shoe by its sensor, says which posture comes next, and asks for what the rulers show.",
    "solepath calibrate shoe postures.csv --live --left F0:5E:00:00:00:01 --out me.json",
    option("files", metavar="POSTURES", nargs=1, type=Path, help="the csv file; with --live, to be written"),
    option(
        "--times", metavar="N", type=parse_count, default=TIMES, help=f"of each posture, with --live (default: {TIMES})"
    ),
    option("--height", metavar="M", type=parse_positive, help="of the sensor above the ground, m, with --live"),
    option("--heel", metavar="M", type=parse_positive, help="from the heel's end to below the sensor, m, with --live"),
    live_options("measure now, with the sensor in the shoe", "the pitch and what to do next"),
    learn=_shoe,
)
