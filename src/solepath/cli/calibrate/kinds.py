"""The kinds of `solepath calibrate`: the arguments of each, and what it learns from its input."""

from __future__ import annotations

from argparse import Namespace
from math import degrees
from pathlib import Path

from ...calibration import Calibration, InsoleCalibration
from ...show.tables.table import number, table
from ...types import Foot
from ..common.failure import Failure, parse_count, parse_degrees
from ..common.inputs import check_pressure, recipe_option, source_of
from ..common.own_devices import add_own_devices, drivers_of
from ..common.parser import command, option
from ..common.tables import samples_named, source_named, table_options
from .limbs import add_limbs
from .sensor import add_sensor
from .shoe import add_shoe

LearntCalibration = tuple[Calibration, list[str]]
"""A calibration that was learnt, and the lines that report it."""


def _noise(options: Namespace, known: Calibration) -> LearntCalibration:
    from ...papers.kupt_dfpc.noise import pressure_noise

    _, samples = samples_named(options)
    learnt = pressure_noise(samples)
    rows = [
        [foot.value, str(len(insole.noise)), number(sum(insole.noise) / len(insole.noise)), number(max(insole.noise))]
        for foot, insole in learnt.insoles.items()
    ]
    return learnt, [table(["foot", "cells", "mean noise", "largest"], rows)]


def _square(options: Namespace, known: Calibration) -> LearntCalibration:
    from ...papers.pressure_contour.square import square_drift
    from ...recipes import by_name

    recipe = by_name(options.recipe)
    drivers = drivers_of(options)
    source = source_named(options, drivers)
    check_pressure(recipe, source, drivers)
    drift = square_drift(source, foot=source.foot, steps_per_lap=options.steps, recipe=recipe, calibration=known)
    x, y = drift.slope
    if drift.agreed:
        verdict = "the laps agree on it, and it is taken off later"
    elif options.whole:
        verdict = "the laps do not agree on it, and it is taken off all the same"
    else:
        verdict = "the laps do not agree on it, so that nothing is taken off (--whole does all the same)"
    return Calibration(drift={drift.foot: drift.slope if options.whole else drift.kept}), [
        f"{drift.foot} foot: {drift.visits} visits of {drift.marks} marks, drift {1000.0 * x:.2f}, "
        f"{1000.0 * y:.2f} mm/s within {1000.0 * drift.scatter:.2f}: {verdict}"
    ]


def _newton(options: Namespace, known: Calibration) -> LearntCalibration:
    from ...papers.walking_modes.newton import fit_gauge

    feet = [foot for foot in Foot if options.foot in (None, foot.value)]
    fit = fit_gauge(options.file)
    a, b, c, d = fit.newtons.coefficients
    insole = InsoleCalibration(newtons=fit.newtons)
    return Calibration(insoles={foot: insole for foot in feet}), [
        f"{' and '.join(foot.value for foot in feet)}: N = {a:.4g} + {b:.4g} c + {c:.4g} c^2 + {d:.4g} c^3, "
        f"{fit.points} points, rms error {fit.residual:.2f} N, largest {fit.worst:.2f} N",
        f"forces below {fit.newtons.threshold:g} N count as 0, and those above {fit.newtons.most:g} N, the largest of "
        f"the gauge, as {fit.newtons.most:g} N",
    ]


def _modes(options: Namespace, known: Calibration) -> LearntCalibration:
    from ...papers.walking_modes.calibrate import fit_modes
    from ...recording.decoded import decode_recording

    if len(options.files) % 2:
        raise Failure("calibrate modes takes two files for each walk: the recording, and the csv file of its marks")
    drivers = drivers_of(options)
    walks = [
        (decode_recording(source_of(walk, own=drivers)), marks)
        for walk, marks in zip(options.files[::2], options.files[1::2], strict=True)
    ]
    learnt = fit_modes(walks, known, options.heading)
    rows = [
        [foot.value, mode.value, number(100.0 * forward, 2), number(100.0 * left, 2)]
        for foot, modes in (learnt.modes or {}).items()
        for mode, (forward, left) in modes.items()
    ]
    return learnt, [table(["foot", "mode", "forward cm", "left cm"], rows)]


def _walk(options: Namespace, known: Calibration) -> LearntCalibration:
    from ...session.heading_walk import heading_calibration, heading_walk

    fits = heading_walk(source_named(options, drivers_of(options)), known)
    rows = [
        [
            fit.foot.value, str(fit.legs), number(fit.duration, 0), number(degrees(fit.heading.drift), 3),
            number(degrees(fit.heading.drift_sigma), 3), number(100.0 * fit.heading.turning, 2),
            number(100.0 * fit.heading.turning_sigma, 2), number(degrees(fit.before)), number(degrees(fit.after)),
        ]
        for fit in fits
    ]  # fmt: skip
    header = [
        "foot", "legs", "s", "degrees a stride", "+-", "of a turn %", "+-", "legs apart, degrees", "with it",
    ]  # fmt: skip
    return heading_calibration(fits), [table(header, rows)]


add_noise = command(
    "noise",
    "From some 20 s of walking: what every cell shows while the foot swings, which is taken off later.",
    "solepath calibrate noise walk.jsonl --out me.json",
    table_options("RECORDING"),
    learn=_noise,
)
add_square = command(
    "square",
    "From four to six laps of a square on whose edges every stride of one foot is marked, the same "
    "marks in every lap: how fast the positions of pressure-contour and gyroscope drift, which is taken off later.",
    "solepath calibrate square laps.jsonl --out me.json",
    table_options("RECORDING"),
    option("--steps", metavar="N", type=parse_count, default=40, help="marks around the square (default: 40)"),
    recipe_option(default="pressure-contour", help="whose positions (default: pressure-contour; or gyroscope)"),
    option("--whole", action="store_true", help="keep a drift that the laps do not agree on, as the paper"),
    learn=_square,
)
add_newton = command(
    "newton",
    "A cubic through what a gauge pressed and what the insole said: a csv file with the columns counts and newtons.",
    "solepath calibrate newton gauge.csv --foot left --out me.json",
    option("file", metavar="GAUGE", type=Path, help="the csv file"),
    option("--foot", choices=["left", "right"], help="whose insole it is (default: both are alike)"),
    learn=_newton,
)
add_modes = command(
    "modes",
    "From walks on marked points, straight on and along bends: what touchdowns are off by in each "
    "walking mode. Each recording comes with a csv file of its marks: foot, x, y (m), mode, and t (s) or step. "
    "Limbs and insoles that FILE knows already are used.",
    "solepath calibrate modes straight.jsonl straight.csv bend.jsonl bend.csv --out me.json",
    option("files", metavar="RECORDING MARKS", nargs="+", type=Path, help="two files for each walk"),
    add_own_devices,
    option(
        "--heading",
        metavar="DEGREES",
        type=parse_degrees,
        help="where the wearer looks at the start, in the world that all sensors share; x of the marks must be that "
        "direction (default: the first step says, and the marks may be in any frame)",
    ),
    learn=_modes,
)
add_walk = command(
    "walk",
    "From two minutes to and fro along one straight line of 10 m and more, for instance a corridor: by "
    "how much the track of each foot turns in every stride and for every turn, which is taken off later. Stand for "
    "fifteen seconds before and after it, walk as usual, and turn now to the left and now to the right.",
    "solepath calibrate walk corridor.jsonl --out me.json",
    table_options("RECORDING"),
    learn=_walk,
)
KINDS = {
    add_noise: "what pressure cells show in the air, from a walk",
    add_shoe: "how a shoe rolls over its forefoot, from postures measured with rulers",
    add_square: "which way positions drift, from laps of a square over marks",
    add_newton: "from an insole's counts to newtons, from what a gauge pressed",
    add_limbs: "lengths of the limbs, and whether seven body sensors stood still, from a standing pose",
    add_modes: "a wearer's own compensation of touchdowns, from walks over marks",
    add_walk: "how the heading of each foot drifts, from a walk there and back",
    add_sensor: "scale, axes and bias of a sensor, from rests and turns by hand",
}
"""Functions that add the kinds to the parser, each with its line of help, in the order of the help text."""
