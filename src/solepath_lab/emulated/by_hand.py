"""Worth of a calibration by hand on the emulator: its errors and standard deviations, and tracks with and without it.

    solepath-lab emulated by-hand [--sensors N] [--walks N] [--seed S] [--recipe NAME]

prints tables as Markdown. The first is of `N` sensors of each kind in each hand
(emulated/handling.py): how far scale and axes are from the emulator's, and how often within one and two standard
deviations, which is 68 and 95 % for errors that are normal.

The second is of walks of 250 m along corridors (emulated/heading_walks.py) by wearers whose two sensors were calibrated
by a clumsy hand the day before. Bias and noise are other ones on the day of the walk: a tenth of the bias of the sheet
is new (assumed). The error at the end is a share of the path.

    solepath-lab emulated by-hand --record FILE [--seed S]

prints nothing and records an insole in the clumsy hand, which `solepath calibrate sensor` takes."""

from __future__ import annotations

from argparse import Namespace
from collections.abc import Sequence
from itertools import product
from pathlib import Path

import numpy as np
from attrs import evolve, frozen

from solepath import recipes
from solepath.calibration import Calibration, CalibrationError
from solepath.cli.calibrate.by_hand.fit import SYMMETRIC
from solepath.cli.calibrate.by_hand.pauses import Floats
from solepath.cli.calibrate.by_hand.sensor import fit_sensors, sensor_calibration
from solepath.cli.common.inputs import recipe_option
from solepath.cli.common.parser import option
from solepath.cli.common.processes import run_jobs
from solepath.emulate.radio import Radio
from solepath.emulate.sensors.device import device_rng
from solepath.emulate.sensors.insole_device import Insole
from solepath.emulate.sensors.parts import LSM6DSOX, MPU6050, MPU9250, Imu
from solepath.emulate.sensors.sensors import mixing, specimen_rng
from solepath.emulate.walk import sampled
from solepath.recording import PacketWriter
from solepath.session import Session
from solepath.types import SITE_OF_FOOT, Foot, Sample, Site

from ..options import seeds
from ..tables import markdown
from .handling import CLUMSY, STEADY, Clumsiness, Handling
from .heading import follow, heading_figures
from .heading_walks import G_EFFECT, OTHER_DAY, heading_route, wearer_of

FIRST_SEED, SENSORS, WALKS = 9001, 8, 4
"""First seed, number of sensors of each kind in each hand, and number of walks."""
CHIPS = {one.name: one for one in (LSM6DSOX, MPU9250, MPU6050)}
"""Chips by name."""
HANDS = {"clumsy": CLUMSY, "steady": STEADY}
"""Hands by name."""
BIAS_CHANGE = 0.1
"""Share of the bias that is new on another day (assumed: no sheet gives it)."""
KIND, LENGTH = "right_angles", 250.0
"""Kind of the routes, and their length, m."""


@frozen
class HandJob:
    """A sensor that a hand calibrates."""

    chip: str
    hand: str
    seed: int


@frozen(eq=False)
class HandErrors:
    """Errors of a calibration, and its standard deviations; None where it was rejected."""

    job: HandJob
    gyro: Floats | None = None
    """Errors of the gyroscope's correction, (3, 3)."""
    acc: Floats | None = None
    """Errors of the accelerometer's correction, (6)."""
    gyro_sigma: Floats | None = None
    """Standard deviations of the first."""
    acc_sigma: Floats | None = None
    """Standard deviations of the second."""
    why: str = ""
    """Reason of a rejection."""


def specimen(chip: Imu, number: int) -> Imu:
    """Return the chip as the specimen of a number, with the sensitivity to force that some sheets give."""
    acc = evolve(chip.acc, specimen=2 * number, bias_change=BIAS_CHANGE)
    return Imu(chip.name, acc, evolve(chip.gyro, specimen=2 * number + 1, bias_change=BIAS_CHANGE, g_effect=G_EFFECT))


def true_corrections(imu: Imu) -> tuple[Floats, Floats]:
    """Return the true corrections of accelerometer and gyroscope, (3, 3), in the frame of the calibration.

    The accelerometer's mixing is S Q with a symmetric S and a rotation Q, so that a symmetric correction is the inverse
    of S and the corrected frame is turned by Q from the case."""
    if imu.acc.specimen is None or imu.gyro.specimen is None:
        raise ValueError("a chip without the number of a specimen has other errors in every recording")
    acc, gyro = mixing(imu.acc, specimen_rng(imu.acc.specimen)), mixing(imu.gyro, specimen_rng(imu.gyro.specimen))
    u, stretch, v = np.linalg.svd(acc)
    symmetric, turn = u @ np.diag(stretch) @ u.T, u @ v
    return np.linalg.inv(symmetric), turn @ np.linalg.inv(gyro)


def handled(imu: Imu, hand: Clumsiness, seed: int, foot: Foot) -> list[Sample]:
    """Return the samples of a sensor in a hand."""
    site = SITE_OF_FOOT[foot]
    return Insole(cells=8, chip=imu).samples(Handling(seed, hand), site, device_rng(seed, site))


def record_hand(path: Path, seed: int) -> None:
    """Record the packets of an insole on the left foot's site in a clumsy hand."""
    rng = device_rng(seed, Site.LEFT_FOOT)
    sent = Insole().emit(Handling(seed, CLUMSY), Site.LEFT_FOOT, rng)
    with PacketWriter(path) as writer:
        for packet in Radio().transmit(sent, Site.LEFT_FOOT, rng):
            writer.write(packet)


def hand_errors(job: HandJob) -> HandErrors:
    """Return the errors of one calibration."""
    imu = specimen(CHIPS[job.chip], job.seed)
    try:
        (found,) = fit_sensors(handled(imu, HANDS[job.hand], job.seed, Foot.RIGHT))
    except CalibrationError as error:
        return HandErrors(job, why=str(error))
    acc, gyro = true_corrections(imu)
    triads = (found.calibration.acc, found.calibration.gyro)
    acc_found, gyro_found = (np.array(triad.matrix).reshape(3, 3) for triad in triads)
    acc_sigma, gyro_sigma = (np.array(triad.matrix_sigma).reshape(3, 3) for triad in triads)
    rows, columns = np.array(SYMMETRIC).T
    return HandErrors(job, gyro_found - gyro, (acc_found - acc)[rows, columns], gyro_sigma, acc_sigma[rows, columns])


def hand_table(results: Sequence[HandErrors]) -> list[str]:
    """Return the lines of the first table."""
    header = (
        "chip", "hand", "sensors", "rejected", "gyroscope scale, %: median, 95 %, largest", "axes, degrees",
        "accelerometer scale, %", "axes, degrees", "within 1 and 2 sigma: gyroscope", "accelerometer",
    )  # fmt: skip
    rows, apart = [], ~np.eye(3, dtype=np.bool_)
    for chip, hand in product(CHIPS, HANDS):
        every = [one for one in results if (one.job.chip, one.job.hand) == (chip, hand)]
        good = [one for one in every if one.gyro is not None]
        if not good:
            continue
        gyro, acc, gyro_sigma, acc_sigma = (
            np.array([getattr(one, name) for one in good]) for name in ("gyro", "acc", "gyro_sigma", "acc_sigma")
        )
        values = (100.0 * gyro[:, ~apart], np.degrees(gyro[:, apart]), 100.0 * acc[:, :3], np.degrees(acc[:, 3:]))
        within = [_within(np.abs(gyro / gyro_sigma)), _within(np.abs(acc / acc_sigma))]
        rows.append((chip, hand, len(every), len(every) - len(good), *map(_spread, values), *within))
    return markdown.table(header, rows, left=len(header))


def _spread(values: Floats) -> str:
    middle, high = np.percentile(np.abs(values), (50, 95))
    return f"{middle:.3f}, {high:.3f}, {np.abs(values).max():.3f}"


def _within(shares: Floats) -> str:
    return f"{100.0 * float((shares < 1.0).mean()):.0f} %, {100.0 * float((shares < 2.0).mean()):.0f} %"


@frozen
class WalkJob:
    """A walk with two sensors of a chip."""

    chip: str
    recipe: str
    seed: int


WalkErrors = tuple[WalkJob, Floats]
"""A walk, and without and with a calibration the error at its end as a share of the path, and of the heading, rad."""


def walk_errors(job: WalkJob) -> WalkErrors:
    """Return the errors of one walk."""
    imus = {foot: specimen(CHIPS[job.chip], 2 * job.seed + k) for k, foot in enumerate(Foot)}
    sensors = {
        foot: sensor_calibration(fit_sensors(handled(imu, CLUMSY, OTHER_DAY + 2 * job.seed + k, foot))).sensors[foot]
        for k, (foot, imu) in enumerate(imus.items())
    }
    insoles = {SITE_OF_FOOT[foot]: Insole(cells=24, chip=imu) for foot, imu in imus.items()}
    route = heading_route(KIND, job.seed, lambda length, seconds: length >= LENGTH)
    walk = sampled(route, wearer=wearer_of(job.seed), insoles=insoles, seed=job.seed)
    figures = [
        heading_figures(follow(Session(recipes.by_name(job.recipe), calibration=calibration), walk), walk.truth)
        for calibration in (None, Calibration(sensors=sensors))
    ]
    return job, np.array([[one.get(name) or np.nan for name in ("end_relative", "heading_end")] for one in figures])


def walk_table(results: Sequence[WalkErrors]) -> list[str]:
    """Return the lines of the second table."""
    header = (
        "chip", "recipe", "walks", "error at the end, % of the path: median, largest", "with it",
        "heading at the end, degrees", "with it", "better in",
    )  # fmt: skip
    table = []
    for chip, recipe in dict.fromkeys((job.chip, job.recipe) for job, _ in results):
        rows = np.array([errors for job, errors in results if (job.chip, job.recipe) == (chip, recipe)])
        end, heading = rows[:, :, 0], rows[:, :, 1]
        spreads = map(_both, [*(100.0 * end.T), *np.degrees(heading.T)])
        better = int((end[:, 1] < end[:, 0]).sum())
        table.append((chip, f"`{recipe}`", len(rows), *spreads, f"{better} of {len(rows)}"))
    return markdown.table(header, table, left=len(header))


def _both(values: Floats) -> str:
    return f"{float(np.median(values)):.2f}, {float(values.max()):.2f}"


OPTIONS = (
    option("--sensors", metavar="N", type=int, default=SENSORS, help="of each kind in each hand; or 0"),
    seeds(WALKS, FIRST_SEED, may_be_none=True),
    recipe_option(action="append", default=[], help="may be given again"),
    option("--record", metavar="FILE", type=Path, help="record a sensor in a hand instead"),
)


def run(options: Namespace) -> int:
    """Print the tables, or record a sensor in a hand; return the exit status."""
    if options.record is not None:
        record_hand(options.record, options.seed)
        return 0
    numbers = range(options.seed, options.seed + options.sensors)
    hands = [HandJob(chip, hand, seed) for chip in CHIPS for hand in HANDS for seed in numbers]
    results = list(run_jobs(hand_errors, hands, processes=options.processes))
    if results:
        print("\n".join(hand_table(results)))
    for one in results:
        if one.why:
            print(f"rejected: {one.job.chip}, {one.job.hand}, seed {one.job.seed}: {one.why}")
    walks = [
        WalkJob(chip, recipe, options.seed + k)
        for chip in (LSM6DSOX.name, MPU9250.name)
        for recipe in options.recipe or [recipes.DEFAULT.name]
        for k in range(options.walks)
    ]
    walked = list(run_jobs(walk_errors, walks, processes=options.processes))
    if walked:
        print("\n".join([*[""] * bool(results), *walk_table(walked)]))
    return 0
