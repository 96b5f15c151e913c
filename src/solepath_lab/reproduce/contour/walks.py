"""One walk of Bebek et al. 2010: laps of the calibration square on marked footprints, a halt, and the way home.

Each recipe is calibrated by its own positions in the laps ("the same ZUPT'ing and calibration techniques are applied"),
and a session of it receives only the samples after the halt. A loop-closing error is the horizontal distance between
the start and the end of a track."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise
from math import atan2, cos, sin

import numpy as np
from attrs import evolve, frozen
from numpy.typing import NDArray

from solepath.calibration import Calibration, CalibrationError, InsoleCalibration
from solepath.calibration.records import merged
from solepath.emulate.routes.path import Stand
from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.insoles import layout as sole_layout
from solepath.emulate.walk import SampledWalk, sampled
from solepath.emulate.wearers.truth import Truth
from solepath.events import StrideTaken
from solepath.foot.navigate.dedrift import LinearDedrift
from solepath.papers.pressure_contour.square import square_drift
from solepath.recipes import Recipe
from solepath.session import Session
from solepath.types import SITE_OF_FOOT, Foot, Layout, Sample
from solepath.validate.alignment import Floats

from ...emulated.laps import field_walk, square
from ..tables import PUBLISHED, DrawStyle, PictureTrack, Plot, Values, WalkResults
from ..walks import align_track, final_strides, find_halt, join_routes, matched, thin_out
from .figures import bias_curves, stance_curves
from .variants import FOOT, MAIN, PACE, PRESSURE_ROW, VARIANTS, WITHOUT_BIAS_ROW, Setup

LOOPS: list[float] = [distance for distance, _, _ in PUBLISHED["pressure-contour"]["loops"]]
"""Lengths of experiments 1 to 6 of table I, m."""
NUMBER = "(number)"
"""Name of the index in LOOPS."""
HALF_HOUR = 1800.0
"""Duration of the paper's walks, s."""
XY = tuple[float, float]


@frozen(eq=False)
class ContourRun:
    """The results of one recipe on the samples of one foot."""

    strides: tuple[StrideTaken, ...]
    """Final strides of the foot."""
    t: Floats
    """Times of the samples, s, (N)."""
    at_rest: NDArray[np.bool_]
    """True for the samples at which the velocity was set to zero, (N)."""
    bias: Floats
    """Bias that the recipe's filter has estimated after each sample, sensor frame, m/s^2, (N, 3)."""


def run_foot(recipe: Recipe, foot: Foot, samples: Sequence[Sample], calibration: Calibration) -> ContourRun:
    """Feed the samples of one foot to a session of the recipe, one at a time."""
    session = Session(recipe, calibration=calibration)
    events, at_rest, biases = [], [], []
    for sample in samples:
        events += session.feed(sample)
        corrector = session.feet[foot].corrector
        assert isinstance(corrector, LinearDedrift)
        at_rest.append(corrector.swing == 0.0)
        bias = getattr(corrector, "bias", None)
        biases.append((0.0, 0.0, 0.0) if bias is None else bias.bias)
    events += session.finish()
    strides = tuple(final_strides(events))
    t = np.array([sample.t for sample in samples])
    return ContourRun(strides, t, np.array(at_rest), np.array(biases))


def stance_velocities(run: ContourRun, truth: Truth, foot: Foot, after: float = 0.0) -> Floats:
    """Return the true velocities of the heel while a recipe took it to be at rest, in stances from `after`, s, on, m/s.

    A velocity is the length of the mean horizontal one over the samples of a stance that were taken for rest: an update
    with zero velocity makes an error of this size. It is nan for a stance without such a sample.

    A stance here lasts from the middle of one swing to the middle of the next: what is taken for rest in a swing counts
    to the nearer stance."""
    velocity = truth.pose(foot, run.t).velocity[:, :2]
    strides = truth.strides(foot)
    middles = np.array([0.5 * (one.t_toe_off + one.t_heel_strike) for one in strides])
    middles = middles[middles >= max(after, float(run.t[0]))]
    biases = []
    for start, end in pairwise(middles):
        rows = slice(*np.searchsorted(run.t, (start, end)).tolist())
        rest = run.at_rest[rows]
        biases.append(float(np.linalg.norm(velocity[rows][rest].mean(axis=0))) if rest.any() else float("nan"))
    return np.array(biases)


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
        return LOOPS[self.number] < PACE * HALF_HOUR


def route_of(job: ContourJob) -> tuple[Route, Route]:
    """Return the route of the calibration laps with a halt of half a minute, and the whole route."""
    distance = LOOPS[job.number] * job.duration / HALF_HOUR
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

    Values are NUMBER and of each recipe "ROW m" and "ROW %", the loop-closing error and its share of the way, "ROW
    mm/s", the velocity of the heel while it was taken to be at rest, "ROW stances %" and "ROW strides %", the shares
    that were found, and "ROW length m", the mean error of a stride's length. Panels are the tracks of MAIN and of the
    printed recipe without its filter or without calibration, and figs. 7 and 9."""
    laps, whole = route_of(job)
    setup = job.setup
    walked = sampled(whole, wearer=setup.wearer, insoles={SITE_OF_FOOT[FOOT]: setup.device}, seed=job.seed)
    t_halt = find_halt(walked.walker, laps)
    before = [one for one in walked.samples if one.t < t_halt]
    after = [one for one in walked.samples if one.t >= t_halt]
    cells, shoe = setup.device.cells, setup.wearer.shoe
    insole = cells if isinstance(cells, Layout) else sole_layout(cells, FOOT, shoe.length, shoe.width)
    known = Calibration(insoles={FOOT: InsoleCalibration(layout=insole)})
    true_strides = [one for one in walked.truth.strides(FOOT) if one.t_start > t_halt]
    shown: dict[str, ContourRun] = {}
    values: Values = {NUMBER: (float(job.number),)}
    panels = stance_curves(walked, insole, FOOT, t_halt)
    for name in job.variants:
        drift = _drift(VARIANTS[name], before, known, is_printed="printed" in name)
        run = run_foot(VARIANTS[name], FOOT, after, merged(known, Calibration(drift={FOOT: drift})))
        velocities = stance_velocities(run, walked.truth, FOOT, t_halt)
        found, pairs = velocities[~np.isnan(velocities)], matched(run.strides, true_strides)
        end = float(np.linalg.norm(_track(run)[-1]))
        values |= {
            f"{name} m": (end,),
            f"{name} %": (100.0 * end / (whole.length - laps.length),),
            f"{name} mm/s": (1e3 * float(found.mean()) if len(found) else 0.0,),
            f"{name} stances %": (100.0 * len(found) / len(velocities),),
            f"{name} strides %": (100.0 * len(pairs) / len(true_strides),),
            f"{name} length m": (float(np.mean([abs(one.length - true.length) for one, true in pairs] or [0.0])),),
        }
        if name in MAIN or name == WITHOUT_BIAS_ROW:
            shown[name] = run
        if name == PRESSURE_ROW:
            panels += bias_curves(run.t, run.bias)
    if job.uncalibrated:
        shown["Pressure as printed, uncalibrated"] = run_foot(VARIANTS[WITHOUT_BIAS_ROW], FOOT, after, known)
    return WalkResults(values, (Plot("", _tracks(walked, t_halt, shown), marks=(("start", 0.0, 0.0),)), *panels))


def _drift(recipe: Recipe, laps: list[Sample], known: Calibration, is_printed: bool) -> XY:
    """Return the drift of a recipe by the laps, m/s; zero if it lost strides in them, so that nobody can tell.

    As printed every slope is used; ours uses one that is larger than chance explains."""
    try:
        drift = square_drift(laps, foot=FOOT, recipe=recipe, calibration=known)
    except CalibrationError:
        return (0.0, 0.0)
    return drift.slope if is_printed else drift.kept


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
