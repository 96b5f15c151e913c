"""`solepath calibrate limbs`: lengths of the limbs for seven body sensors, and a check of the standing pose."""

from __future__ import annotations

from argparse import Namespace
from math import degrees

from ...calibration import Calibration
from ...show.tables.table import number, table
from ..common.failure import parse_positive
from ..common.parser import command, option
from ..common.tables import samples_named, table_options

STEEPEST_TILT = 35.0
"""Tilt from which a sensor is hardly strapped on as intended, degrees; between two axes of a box it is 45."""


def _limbs(options: Namespace, known: Calibration) -> tuple[Calibration, list[str]]:
    from ...papers.walking_modes.limbs.standing import check_standing, limbs_of

    _, samples = samples_named(options)
    stood = check_standing(samples)
    limbs = limbs_of(options.stature, options.spines, options.thigh, options.shank)
    rows = [
        [site.words, number(degrees(tilt), 0), "strapped on askew?" if degrees(tilt) > STEEPEST_TILT else ""]
        for site, tilt in stood.items()
    ]
    return Calibration(limbs=limbs), [
        table(["sensor", "tilt deg", ""], rows),
        f"hip joints {100.0 * limbs.hip_width:.1f} cm apart, thigh {100.0 * limbs.thigh:.1f} cm, shank "
        f"{100.0 * limbs.shank:.1f} cm, foot ahead of the ankle {100.0 * limbs.foot:.1f} cm, ankle "
        f"{100.0 * limbs.ankle_height:.1f} cm high",
    ]


add_limbs = command(
    "limbs",
    "From some seconds of standing upright, feet level and side by side, with all seven sensors worn "
    "(docs/device.md): whether a walk can begin so. Lengths are shares of the stature, or as measured.",
    "solepath calibrate limbs standing.jsonl --stature 1.72 --spines 0.235 --out me.json",
    table_options("RECORDING"),
    option("--stature", metavar="M", type=parse_positive, required=True, help="of the wearer, m"),
    *[
        option(f"--{name}", metavar="M", type=parse_positive, help=f"{what} (default: by the stature)")
        for name, what in (
            ("spines", "distance of the bony points at the front of the hips (anterior iliac spines), m"),
            ("thigh", "from the hip joint to the knee, m"),
            ("shank", "from the knee to the ankle, m"),
        )
    ],
    learn=_limbs,
)
