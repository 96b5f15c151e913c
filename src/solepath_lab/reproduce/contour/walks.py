"""One walk of Bebek et al. 2010: laps of the calibration square on marked footprints, a halt, and the way home.

Each recipe is calibrated by its own positions in the laps ("the same ZUPT'ing and calibration techniques are applied"),
and a session of it receives only the samples after the halt. A loop-closing error is the horizontal distance between
the start and the end of a track."""

from __future__ import annotations

from collections.abc import Mapping
from math import atan2, cos, sin

import numpy as np
from attrs import evolve, frozen

from solepath.calibration import Calibration, CalibrationError, InsoleCalibration
from solepath.calibration.records import merged
from solepath.emulate.routes.path import Stand
from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.insoles import layout as sole_layout
from solepath.emulate.walk import SampledWalk, sampled
from solepath.papers.pressure_contour.square import CornerMark, square_drift
from solepath.recipes import Recipe
from solepath.types import SITE_OF_FOOT, Layout, Sample
from solepath.validate.alignment import Floats

from ...emulated.laps import MARKS_PER_LAP, field_walk, square
from ..published import PUBLISHED
from ..tables import DrawStyle, PictureTrack, Plot, Values, WalkResults
from ..walks import align_track, find_halt, join_routes, thin_out
from .figures import bias_curves, stance_curves
from .runs import ContourRun, found_share, run_foot, stance_velocities
from .variants import FOOT, MAIN, PACE, PRESSURE_ROW, VARIANTS, WITHOUT_BIAS_ROW, Setup


@frozen
class Loop:
    """A half-hour walk of table I: its length and its loop-closing errors, m."""

    distance: float
    gyroscope: float
    pressure: float


LOOPS = tuple([Loop(*loop) for loop in PUBLISHED["pressure-contour"]["loops"]])
"""Experiments 1 to 6 of table I."""
HALF_HOUR = 1800.0
"""Duration of the paper's walks, s."""
XY = tuple[float, float]

NOT_FOUND = -1.0
"""Value in place of the velocity of the heel, m/s, for a stance in which it was never taken to be at rest."""


@frozen
class ContourJob:
    """One walk to emulate: as long as LOOPS[number], or in proportion to a `duration`, s, other than half an hour."""

    seed: int
    number: int
    duration: float
    laps: int
    setup: Setup
    variants: tuple[str, ...]
    """Recipes that walk it, keys of VARIANTS."""
    uncalibrated: bool = False
    """True if the track as printed is drawn as well without bias filter and laps: "position" in figs. 14 and 15."""

    @property
    def square(self) -> bool:
        """True for laps of the square, False for a random walk."""
        return LOOPS[self.number].distance < PACE * HALF_HOUR


def route_of(job: ContourJob) -> tuple[Route, Route]:
    """Return the route of the calibration laps with a halt of half a minute, and the whole route."""
    distance = LOOPS[job.number].distance * job.duration / HALF_HOUR
    pace = job.setup.speed
    if pace != PACE:
        distance = pace * job.duration
    laps = square(job.laps, speed=pace).stand(28.0)
    if job.square:
        lap = square(1, speed=pace)
        count = max(1, round(distance / lap.length))
        pause = max(1.0, job.duration / count - lap.length / pace)
        whole = laps
        for _ in range(count):
            whole = join_routes(whole, evolve(lap, actions=(*lap.actions[1:-1], Stand(pause))))
        return laps, whole
    after = field_walk(job.duration, distance / job.duration, job.seed)
    heading = after.end.heading
    return laps, join_routes(laps, after.turn(atan2(-sin(heading), cos(heading))).stand(2.0))


def walk(job: ContourJob) -> WalkResults:
    """Emulate one walk, calibrate each recipe on the laps and run it on the rest.

    Values are "number", the index in LOOPS, "distance", m, and of each recipe "ROW m", the loop-closing error, "ROW
    biases", the velocity of the heel in each stance while it was taken to be at rest, m/s (NOT_FOUND where it never
    was), and "ROW found", the share of the stances that were found, %. Panels are the tracks of MAIN and of the printed
    recipe without its filter or without calibration, and figs. 7 and 9."""
    laps, whole = route_of(job)
    setup = job.setup
    walked = sampled(whole, wearer=setup.wearer, insoles={SITE_OF_FOOT[FOOT]: setup.device}, seed=job.seed)
    t_halt = find_halt(walked.walker, laps)
    before = [one for one in walked.samples if one.t < t_halt]
    after = [one for one in walked.samples if one.t >= t_halt]
    cells, shoe = setup.device.cells, setup.wearer.shoe
    insole = cells if isinstance(cells, Layout) else sole_layout(cells, FOOT, shoe.length, shoe.width)
    known = Calibration(insoles={FOOT: InsoleCalibration(layout=insole)})
    marks = _marks(walked, t_halt)
    shown: dict[str, ContourRun] = {}
    values: Values = {"number": (float(job.number),), "distance": (whole.length - laps.length,)}
    panels = stance_curves(walked, insole, FOOT, t_halt)
    for name in job.variants:
        drift = _drift(VARIANTS[name], before, known, marks)
        run = run_foot(VARIANTS[name], FOOT, after, merged(known, Calibration(drift={FOOT: drift})))
        velocities = stance_velocities(run, walked.truth, FOOT, t_halt)
        values[f"{name} m"] = (float(np.linalg.norm(_track(run)[-1])),)
        values[f"{name} biases"] = tuple(np.nan_to_num(velocities, nan=NOT_FOUND).tolist())
        values[f"{name} found"] = (100.0 * found_share(velocities),)
        if name in MAIN or name == WITHOUT_BIAS_ROW:
            shown[name] = run
        if name == PRESSURE_ROW:
            panels += bias_curves(run)
    if job.uncalibrated:
        shown["Pressure as printed, uncalibrated"] = run_foot(VARIANTS[WITHOUT_BIAS_ROW], FOOT, after, known)
    return WalkResults(values, (Plot("", _tracks(walked, t_halt, shown), marks=(("start", 0.0, 0.0),)), *panels))


def _marks(walked: SampledWalk, t_halt: float) -> tuple[CornerMark, ...]:
    """Return the visits of the marks in the laps: every fortieth stride of the foot is on the same mark."""
    strides = [one for one in walked.truth.strides(FOOT) if one.t_end < t_halt]
    return tuple([CornerMark(str(k % MARKS_PER_LAP), one.t_end) for k, one in enumerate(strides)])


def _drift(recipe: Recipe, laps: list[Sample], known: Calibration, marks: tuple[CornerMark, ...]) -> XY:
    """Return the drift of a recipe by the laps, m/s; zero if it found too few strides in them to tell."""
    try:
        return square_drift(laps, foot=FOOT, marks=marks, recipe=recipe, calibration=known, lenient=True).kept
    except CalibrationError:
        return (0.0, 0.0)


def _track(run: ContourRun) -> Floats:
    return np.array([(0.0, 0.0), *((x, y) for x, y, _ in (stride.position for stride in run.strides))])


def _tracks(walked: SampledWalk, t_halt: float, runs: Mapping[str, ContourRun]) -> list[PictureTrack]:
    ends = [one.t_end for one in walked.truth.strides(FOOT) if one.t_end > t_halt]
    tracks = [PictureTrack("true path", thin_out(_true_positions(walked, [t_halt, *ends])), DrawStyle.TRUTH)]
    for name, run in runs.items():
        true = _true_positions(walked, [t_halt, *(stride.t_end for stride in run.strides)])
        tracks.append(PictureTrack(name.lower(), thin_out(align_track(_track(run), true, over=10.0))))
    return tracks


def _true_positions(walked: SampledWalk, t: list[float]) -> Floats:
    """Return the true positions (x, y) of the boot's sensor at `t`, s, relative to the first one, (n, 2), m."""
    positions: Floats = walked.truth.pose(FOOT, np.array(t)).position[:, :2]
    positions -= positions[0].copy()
    return positions
